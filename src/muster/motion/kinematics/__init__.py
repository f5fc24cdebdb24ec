"""How kinds of robot move: state, inputs, limits, and the control laws from a wanted velocity to inputs."""
