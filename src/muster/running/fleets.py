"""Fleets of real robots by name, those of installed packages included; each is ready when it is returned."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

from muster.bridges.fleet import Fleet
from muster.mission.errors import ParameterError, PluginError
from muster.mission.model import Mission
from muster.mission.plugins import Registry, function_expected
from muster.mission.value_types import shown
from muster.running.live import wait_for_robots

_WAIT_S = 10.0
_ANYWHERE_M = 1e6
"""After a crash drones are where they are, in the air maybe."""


Opened = tuple[Fleet, Callable[[], None]]
"""Robots that are ready, and what to call when all is done."""
OpenFleet = Callable[[Mission, Mapping[str, Any], threading.Event, bool], Opened]
"""Opens a fleet: the mission, the settings of the run, an event that ends waiting, whether the run goes on."""


Claims = Callable[[Mapping[str, Any]], Iterable[str]]
"""Returns what a run with some settings claims: words for robots, the same for the same robots."""


def claims(of: Claims) -> Callable[[OpenFleet], OpenFleet]:
    """Declare what runs with a fleet claim: two runs that claim the same never command robots at the same time.

    A fleet without a declaration is claimed as a whole: one run at a time.

    Parameters
    ----------
    of : callable
        Returns the claims of a run by its settings, such as `[settings["url"]]`; it is called before the fleet is
        opened, in another process.
    """

    def declared(open_fleet: OpenFleet) -> OpenFleet:
        open_fleet.claims = of  # type: ignore[attr-defined]
        return open_fleet

    return declared


def declared_claims(world: str, settings: Mapping[str, Any]) -> frozenset[str] | None:
    """Return what a run claims by its fleet's declaration; None where the fleet declares nothing.

    Raises
    ------
    ParameterError, PluginError
        if there is no such fleet, its package cannot be loaded, or the declaration is no list of texts.
    """
    of = getattr(FLEETS.named(world), "claims", None)
    if of is None:
        return None
    try:
        found = list(of(settings))
    except Exception as error:  # the code of another package may raise anything
        raise PluginError(f"fleet {world}: its claims: {type(error).__name__}: {error}") from error
    if not all(isinstance(claim, str) for claim in found):
        raise PluginError(f"fleet {world}: its claims: {shown(found)}; expected texts")
    return frozenset(found)


FLEETS: Registry[OpenFleet] = Registry(
    "fleet",
    "muster.fleets",
    {name: f"{__name__}:open_{name}" for name in ("ros1", "ros2", "mavlink")},
    function_expected("a function that opens a fleet"),
)


def fleet_ready(
    world: str, mission: Mission, settings: Mapping[str, Any], halt: threading.Event, *, again: bool
) -> Opened:
    """The robots of a mission, ready to go; and the function to call when all is done.

    Parameters
    ----------
    world
        the name of the fleet.
    halt
        ends waiting for robots.
    again
        whether the mission is under way already.

    Raises
    ------
    MusterError
        if there is no such fleet, the bridge lacks something, or robots do not answer.
    """
    return FLEETS.named(world)(mission, settings, halt, again)


def open_ros1(mission: Mission, settings: Mapping[str, Any], halt: threading.Event, _again: bool) -> Opened:
    from muster.bridges.ros1.extra import require_rospy

    require_rospy()
    from muster.bridges.ros1.fleet import Ros1Fleet
    from muster.bridges.ros1.node import become_node

    become_node("muster", settings.get("master"))
    own = _some(settings, "drive", "namespace", "frame", "arrival_m", "rate_hz", "avoidance", "odometry", "poses")
    fleet = Ros1Fleet(mission, joins=not settings.get("known_only", False), **own)
    return _heard(fleet, settings, halt), _nothing


def open_ros2(mission: Mission, settings: Mapping[str, Any], halt: threading.Event, _again: bool) -> Opened:
    from muster.bridges.ros2.fleet import Ros2Fleet
    from muster.bridges.ros2.open_middleware import open_middleware
    from muster.bridges.ros2.port import Arrival

    fleet = Ros2Fleet(
        mission,
        middleware=open_middleware(settings.get("by"), settings.get("domain")),
        arrival=Arrival(near_m=settings.get("arrival_m", 0.25)),
        joins=not settings.get("known_only", False),
        **_some(settings, "give", "namespace"),
    )
    return _heard(fleet, settings, halt), _nothing


def open_mavlink(mission: Mission, settings: Mapping[str, Any], _halt: threading.Event, again: bool) -> Opened:
    from muster.bridges.mavlink import MavlinkFleet
    from muster.bridges.mavlink.settings import Settings

    endpoints = settings.get("endpoints")
    if not isinstance(endpoints, Mapping):
        raise ParameterError("endpoints: missing; expected for each robot how it is reached")
    if not settings.get("arm", False):
        raise ParameterError("arm: missing; expected true: without it nothing flies")
    own = _some(settings, "offboard", "local_frame", "low_battery") | ({"far_m": _ANYWHERE_M} if again else {})
    fleet = MavlinkFleet(mission, endpoints, Settings(arm=True, **own), height_m=settings.get("height_m"))
    try:
        fleet.connect(settings.get("wait_s", _WAIT_S))
    except BaseException:
        fleet.close()
        raise
    at_end = settings.get("at_end", "hold")
    return fleet, _nothing if at_end == "hold" else partial(fleet.end, at_end)


def _heard(fleet: Any, settings: Mapping[str, Any], halt: threading.Event) -> Fleet:
    try:
        wait_for_robots(fleet, halt, settings.get("wait_s", _WAIT_S))
    except BaseException:
        fleet.close()
        raise
    return fleet  # type: ignore[no-any-return]


def _some(settings: Mapping[str, Any], *names: str) -> dict[str, Any]:
    return {name: settings[name] for name in names if name in settings}


def _nothing() -> None:
    """They stay where they are."""
