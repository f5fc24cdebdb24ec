"""How a robot moves: maps, paths, smoothing, velocity profiles, collision avoidance, kinematics, frames."""
