"""A world with masses, forces and contacts (MuJoCo); needs the extra `physics`."""

from muster.simulation.physics.physics_world import PhysicsWorld

__all__ = ["PhysicsWorld"]
