"""The optional part of the installation that moves robots by physics: MuJoCo is large."""

from __future__ import annotations

from importlib.util import find_spec

from muster.mission.errors import MissingExtraError


def require_physics_extra() -> None:
    """Raise MissingExtraError where MuJoCo is not installed."""
    if find_spec("mujoco") is None:
        raise MissingExtraError("physics", "the physics world")
