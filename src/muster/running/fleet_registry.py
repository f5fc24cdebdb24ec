"""The registry of fleets of real robots, those of installed packages included; none is loaded before it is named."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

from muster.mission.records import Settings
from muster.mission.system.plugins import Registry, instance_expected
from muster.running.fleet_type import FleetType, Opened

if TYPE_CHECKING:
    from muster.mission.model import Mission


FLEETS: Registry[FleetType] = Registry(
    "fleet", "muster.fleets", instance_expected(FleetType, "a muster.running.fleet_type.FleetType")
)


def settings_class(fleet: str) -> type[Settings]:
    """Return the class of the settings that a fleet declares.

    Raises
    ------
    ParameterError, PluginError
        If there is no such fleet, or its package cannot be loaded.
    """
    return FLEETS.named(fleet).settings


def fleet_ready(world: str, mission: Mission, settings: Any, halt: threading.Event, *, again: bool) -> Opened:
    """Return the robots of a mission, ready to go, and the function to call when all is done.

    Parameters
    ----------
    world : str
        The name of the fleet.
    mission : Mission
        Whose robots they are.
    settings : Settings or mapping
        As the fleet declares them, or plain data of them.
    halt : threading.Event
        Ends waiting for robots.
    again : bool
        Whether the mission is under way already.

    Raises
    ------
    MusterError
        If there is no such fleet, a setting is wrong, the fleet cannot do what the mission needs, the bridge lacks
        something, or robots do not answer.
    """
    fleet = FLEETS.named(world)
    fleet.require_able(mission, resumes=again)
    checked = fleet.checked_settings(settings)
    fleet.require_installed()
    return fleet.open(mission, checked, halt, again)
