"""The worlds in which plans are carried out, by name, those of installed packages included."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from muster.mission.errors import ParameterError
from muster.mission.plugins import Registry

if TYPE_CHECKING:
    from muster.simulation import SimulatedWorld

MakeWorld = Callable[..., "SimulatedWorld"]
"""Makes a world of a mission: `make(mission, seed=, dt_s=, avoidance=, noise=, observer=, observe_s=)`, with
`law=` where it is not `profile`, and `wind=`, `batteries=`, `drain=`, `rotor_level=` where they are asked for."""


def _checked(name: str, found: object) -> MakeWorld:
    if not callable(found):
        raise ParameterError(f"it is a {type(found).__name__}; expected a class or function that makes a world")
    return found


WORLDS: Registry[MakeWorld] = Registry(
    "world",
    "muster.worlds",
    {"kinematic": "muster.simulation:KinematicWorld", "physics": "muster.simulation.physics:PhysicsWorld"},
    _checked,
)


def world_named(name: str) -> MakeWorld:
    """What makes a world of that name for a mission.

    Raises
    ------
    ParameterError
        if there is none.
    MissingExtraError
        if it needs an extra that is not installed.
    PluginError
        if its package cannot be loaded.
    """
    return WORLDS.named(name)
