"""MuJoCo, imported here alone: the extra `physics` is required, and how MuJoCo draws is chosen, before it is loaded."""

from muster.perception.optional_parts import require_physics
from muster_physics.optional_parts import choose_backend

require_physics("the physics world", "mujoco")
choose_backend()

import mujoco  # noqa: E402 (after the choice)

__all__ = ["mujoco"]
