"""The physics world as an entry of `muster.worlds`; MuJoCo is imported when the world is made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from muster.mission.model import Mission
from muster.perception.camera import Intrinsics
from muster.perception.optional_parts import require_physics
from muster.simulation.declaration import BODIES, declares

if TYPE_CHECKING:
    from muster_physics.physics_world import PhysicsWorld
    from muster_physics.placed_camera import PlacedCamera


def placed_camera(mission: Mission, intrinsics: Intrinsics) -> PlacedCamera:
    """Return a camera that draws what it would see of a mission's places.

    Raises
    ------
    MissingExtraError
        if MuJoCo is not installed.
    """
    require_physics("rendering images", "mujoco")
    from muster_physics.placed_camera import PlacedCamera

    return PlacedCamera(mission, intrinsics)


@declares(
    settings=("law", "wind", "batteries", "drain", "rotor_level", "snapshot"),
    abilities=(BODIES,),
    placed_camera=placed_camera,
)
def make_world(mission: Mission, **how: Any) -> PhysicsWorld:
    """Return the physics world of a mission; see `PhysicsWorld`.

    Raises
    ------
    MissingExtraError
        if MuJoCo is not installed.
    """
    from muster_physics.physics_world import PhysicsWorld

    return PhysicsWorld(mission, **how)
