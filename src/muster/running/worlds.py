"""The worlds in which plans are carried out, by name, those of installed packages included."""

from __future__ import annotations

from collections.abc import Callable
from inspect import Parameter, signature
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.system.plugins import Registry, function_expected

if TYPE_CHECKING:
    from muster.mission.model import Mission
    from muster.perception.camera import Intrinsics
    from muster.simulation import SimulatedWorld
    from muster.simulation.declaration import MakePlacedCamera, PlacedCamera

MakeWorld = Callable[..., "SimulatedWorld"]
"""Makes a world of a mission: `make(mission, seed=, dt_s=, avoidance=, noise=, observer=, observe_s=)`, with
`law=` where it is not `profile`, and others of `muster.simulation.declaration.SETTINGS` where they are asked for. What
it takes and can do it states by `declares` there."""


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
    MissingExtraError, PluginError
        if its package cannot be loaded.
    """
    return WORLDS.named(name)


def takes_setting(make: MakeWorld, setting: str) -> bool:
    """Whether a world takes one of `declaration.SETTINGS`: as declared, else by the signature of what makes it."""
    settings = _declared(make, "settings")
    if settings is not None:
        return setting in settings
    taken = signature(make).parameters
    return setting in taken or any(parameter.kind is Parameter.VAR_KEYWORD for parameter in taken.values())


def has_ability(make: MakeWorld, ability: str) -> bool:
    """Whether a world declares one of `declaration.ABILITIES`."""
    return ability in (_declared(make, "abilities") or ())


def placed_camera_of(make: MakeWorld) -> MakePlacedCamera | None:
    """What makes cameras that are put anywhere in a world, as it declares; None: its cameras have no pictures."""
    found: MakePlacedCamera | None = _declared(make, "placed_camera")
    return found


def _declared(make: MakeWorld, name: str) -> Any:
    """What a world declares of itself; None without a declaration. A class does not inherit that of its base."""
    return getattr(make, "__dict__", {}).get(name)


def placed_camera(mission: Mission, intrinsics: Intrinsics) -> PlacedCamera:
    """Return a camera in a mission's world, of the first kind of world that has pictures.

    Raises
    ------
    ParameterError
        if no installed world has pictures.
    MissingExtraError
        if it needs an extra that is not installed.
    """
    for make in WORLDS.usable().values():
        if (make_camera := placed_camera_of(make)) is not None:
            return make_camera(mission, intrinsics)
    raise ParameterError("camera: no installed world draws what it sees; expected one that does")


def worlds_that(has: Callable[[MakeWorld], bool]) -> str:
    """The names of the worlds of which something holds, for messages: `a or b`; empty where there are none."""
    return " or ".join(name for name, make in WORLDS.usable().items() if has(make))
