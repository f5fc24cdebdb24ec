"""The worlds in which plans are carried out, by name, those of installed packages included."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from muster.mission.plugins import Registry, function_expected

if TYPE_CHECKING:
    from muster.simulation import SimulatedWorld

MakeWorld = Callable[..., "SimulatedWorld"]
"""Makes a world of a mission: `make(mission, seed=, dt_s=, avoidance=, noise=, observer=, observe_s=)`, with
`law=` where it is not `profile`, and `wind=`, `batteries=`, `drain=`, `rotor_level=` where they are asked for."""


WORLDS: Registry[MakeWorld] = Registry(
    "world",
    "muster.worlds",
    function_expected("a class or function that makes a world"),
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
