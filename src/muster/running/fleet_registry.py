"""The registry of fleets of real robots, those of installed packages included; none is loaded before it is named."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.records import Settings
from muster.mission.system.plugins import Registry, require_own_name
from muster.running.fleet_type import FleetType, Opened

if TYPE_CHECKING:
    from muster.mission.model import Mission


def _checked(name: str, found: object) -> FleetType:
    if not isinstance(found, FleetType):
        raise ParameterError(f"it is a {type(found).__name__}; expected a muster.running.fleet_type.FleetType")
    require_own_name(name, found.name)
    return found


FLEETS: Registry[FleetType] = Registry("fleet", "muster.fleets", _checked)


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
