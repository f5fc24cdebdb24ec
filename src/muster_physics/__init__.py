"""A world with masses, forces and contacts (MuJoCo). `PhysicsWorld` needs the extra `physics`."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from muster_physics.physics_world import PhysicsWorld

__all__ = ["PhysicsWorld"]


def __getattr__(name: str) -> object:
    """Import `PhysicsWorld` when it is first used: options and declarations of this package need no MuJoCo."""
    if name != "PhysicsWorld":
        raise AttributeError(f"module {__name__} has no attribute {name}")
    from muster_physics.physics_world import PhysicsWorld

    return PhysicsWorld
