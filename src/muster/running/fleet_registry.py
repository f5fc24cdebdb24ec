"""The registry of fleets of real robots, those of installed packages included; none is loaded before it is named."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError, PluginError
from muster.mission.records import Record, Settings, key_of, specified
from muster.mission.system.plugins import Registry, declaring, function_expected, require_words
from muster.mission.value_types import Fault, shown
from muster.mission.values.keywords import require_known

if TYPE_CHECKING:
    from muster.execution.fleet import Fleet
    from muster.mission.model import Mission

Opened = tuple["Fleet", Callable[[], None]]
"""Robots that are ready, and what to call when all is done."""
OpenFleet = Callable[["Mission", Any, threading.Event, bool], Opened]
"""Opens a fleet: the mission, the settings of the run, an event that ends waiting, whether the run goes on."""
Claims = Callable[[Any], Iterable[str]]
"""Returns what a run with some settings claims: words for robots, the same for the same robots."""
GROUND, AIR, JOINS = ABILITIES = ("ground", "air", "joins")
"""What a fleet may be able to do: carry robots of a kind, and let robots join that the mission does not name."""

FLEETS: Registry[OpenFleet] = Registry(
    "fleet",
    "muster.fleets",
    function_expected("a function that opens a fleet"),
)


def declares(
    *,
    settings: type[Settings] | None = None,
    claims: Claims | None = None,
    abilities: Collection[str] = ABILITIES,
    require_installed: Callable[[], None] | None = None,
) -> Callable[[OpenFleet], OpenFleet]:
    """Declare what a function that opens a fleet takes, claims, can do and needs.

    Parameters
    ----------
    settings : type, optional
        A class made with `muster.mission.records.record` from `Settings`: the function gets an instance, which is
        checked. Without one the function gets a mapping as it was given, unchecked.
    claims : callable, optional
        Returns the claims of a run by its settings, such as `[settings.url]`: two runs that claim the same never
        command robots at the same time. It is called before the fleet is opened, in another process. Without it the
        fleet is claimed as a whole: one run at a time.
    abilities : collection of str
        Which of `ABILITIES` the fleet has; by default all.
    require_installed : callable, optional
        Raises `MissingExtraError` if this machine lacks a package that the fleet needs. It is called before the fleet
        is opened, and when mission control starts that serves the fleet.
    """
    require_words("abilities", abilities, ABILITIES)
    return declaring(
        settings=settings, claims=claims, abilities=frozenset(abilities), require_installed=require_installed
    )


def settings_class(fleet: str) -> type[Settings] | None:
    """Return the class of the settings that a fleet declares; None if it declares none.

    Raises
    ------
    ParameterError, PluginError
        if there is no such fleet, its package cannot be loaded, or what it declares is no such class.
    """
    found = getattr(FLEETS.named(fleet), "settings", None)
    if found is not None and not (isinstance(found, type) and issubclass(found, Settings)):
        raise PluginError(f"fleet {fleet}: its settings: {shown(found)}; expected a class made from Settings")
    return found


def setting_names(fleet: str) -> tuple[str, ...]:
    """Return the names of the settings that a fleet declares."""
    of = settings_class(fleet)
    return () if of is None else tuple(map(key_of, specified(of)))


def checked_settings(fleet: str, given: object) -> Any:
    """Return the settings of a fleet as it declares them; as they are if it declares none.

    Raises
    ------
    ParameterError, PluginError
        if a setting is unknown, missing or wrong; as `settings_class`.
    """
    of = settings_class(fleet)
    if of is None or isinstance(given, of):
        return given
    if isinstance(given, Mapping):
        require_known(given, setting_names(fleet))
    faults: list[Fault] = []
    read = Record(of, "settings").read(given, (), faults)
    if faults:
        raise of.refusal(faults)
    return read


def require_able(fleet: str, mission: Mission) -> None:
    """Raise `ParameterError` if a mission has robots, or lets robots join, that a fleet does not carry."""
    able = getattr(FLEETS.named(fleet), "abilities", ABILITIES)
    for robot in mission.robots:
        if robot.kind not in able:
            kinds = " or ".join(kind for kind in (GROUND, AIR) if kind in able)
            raise ParameterError(
                f"robot {shown(robot.id)}: kind {robot.kind}; expected {kinds}: fleet {fleet} has no others"
            )
    if mission.newcomers and JOINS not in able:
        raise ParameterError(
            f"robot {shown(mission.newcomers[0].id)}: joins; expected none: no robot joins fleet {fleet}"
        )


def require_installed(fleet: str) -> None:
    """Raise `MissingExtraError` if this machine lacks a package that a fleet declares to need."""
    check = getattr(FLEETS.named(fleet), "require_installed", None)
    if check is not None:
        check()


def fleet_ready(world: str, mission: Mission, settings: Any, halt: threading.Event, *, again: bool) -> Opened:
    """The robots of a mission, ready to go; and the function to call when all is done.

    Parameters
    ----------
    world
        the name of the fleet.
    settings
        as the fleet declares them, or plain data of them.
    halt
        ends waiting for robots.
    again
        whether the mission is under way already.

    Raises
    ------
    MusterError
        if there is no such fleet, a setting is wrong, the bridge lacks something, or robots do not answer.
    """
    require_able(world, mission)
    checked = checked_settings(world, settings)
    require_installed(world)
    return FLEETS.named(world)(mission, checked, halt, again)
