"""The commands of MAVLink missions (MAV_CMD): their names, which are read, and which change nothing about the motion.

A command that is neither may move the vehicle, change its speed, its height or its fence, so it is refused by name.
"""

from __future__ import annotations

from collections.abc import Mapping

from muster.mission.texts.packaged_files import packaged_data
from muster_files.qgc import plan_format as qgc

NAMES: Mapping[int, str] = packaged_data("muster_files.qgc", "mav_commands.yaml")
"""By number the names of the commands, without `MAV_CMD_`."""

TAKEOFFS = (qgc.NAV_TAKEOFF, qgc.NAV_VTOL_TAKEOFF)
LANDINGS = (qgc.NAV_LAND, qgc.NAV_VTOL_LAND)
STOPS = (qgc.NAV_WAYPOINT, qgc.NAV_LOITER_TIME)
READ = (
    *(*STOPS, *TAKEOFFS, *LANDINGS, qgc.NAV_RETURN_TO_LAUNCH, qgc.NAV_DELAY),
    *(qgc.DO_CHANGE_SPEED, qgc.DO_JUMP),
)
"""The commands that are read."""

_CAMERA = "is for a camera or a gimbal: Muster has actions for that"
_PAYLOAD = "works a payload or a switch"
_HEADING = "turns the vehicle: Muster plans headings anew"
_WAITS = "waits before a command, and not before the next way point"
_LOG = "is for logs and messages"
PASSED_OVER = {
    **dict.fromkeys(
        (
            *(80, 195, 196, 197, 198, 200, 201, 202, 203, 204, 205, 206, 214, 220, 260),
            *range(521, 535),
            *(1000, 1001, *range(2000, 2011), *range(2500, 2506), 2800),
        ),
        _CAMERA,
    ),
    **dict.fromkeys((181, 182, 183, 184, 187, 211, 216, 405, 406, 42600), _PAYLOAD),
    115: _HEADING,
    **dict.fromkeys((112, 114), _WAITS),
    **dict.fromkeys((217, 510, 511, 512, 2510, 2511), _LOG),
}
"""The commands that are passed over, with the reason: none changes where, how fast or how high a vehicle moves."""

_PARAMS = {
    qgc.NAV_WAYPOINT: ("hold", "acceptance radius", "pass radius", "yaw"),
    qgc.NAV_LOITER_TIME: ("hold", "heading required", "radius", "exit"),
    qgc.NAV_TAKEOFF: ("pitch", "2", "3", "yaw"),
    qgc.NAV_LAND: ("abort height", "precision", "3", "yaw"),
    qgc.DO_CHANGE_SPEED: ("kind of speed", "speed", "throttle", "relative"),
    qgc.DO_JUMP: ("item", "repetitions", "3", "4"),
}


def name_of(command: int) -> str:
    """Return the name of a command, without `MAV_CMD_`; its number where it has none."""
    return NAMES.get(command, f"command {command}")


def told(command: int) -> str:
    """Return a command as errors name it: `MAV_CMD_NAV_LAND (21)`."""
    return f"MAV_CMD_{NAMES[command]} ({command})" if command in NAMES else f"{command}, a MAV_CMD without a name here"


def param_of(command: int, k: int) -> str:
    """Return what the parameter of a command at index `k` is."""
    names = (*_PARAMS.get(command, ("1", "2", "3", "4")), "latitude", "longitude", "height")
    return names[k]
