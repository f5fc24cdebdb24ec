"""A world with masses, forces and contacts (MuJoCo). Importing it without the extra `physics`: MissingExtraError."""

from muster.perception.optional_parts import require_physics
from muster.simulation.physics.optional_parts import choose_backend

require_physics("the physics world", "mujoco")
choose_backend()

from muster.simulation.physics.physics_world import PhysicsWorld  # noqa: E402 (MuJoCo comes with it)

__all__ = ["PhysicsWorld"]
