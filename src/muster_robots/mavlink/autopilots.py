"""The two supported autopilots and their differences: modes, and the first items of a mission.

Modes: PX4's `px4_custom_mode` (main mode << 16 | sub mode << 24), ArduCopter's flight mode numbers. ArduPilot
holds in BRAKE, not in LOITER, which obeys the sticks of a remote control that may not be there; and is armed in GUIDED.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from muster.mission.errors import ParameterError
from muster_robots.mavlink.dialect import Message, mavlink, name_of

AtEnd = Literal["hold", "return", "land"]
"""What a drone does at the end: it hovers, returns to where it was armed and lands there, or lands where it is."""


@dataclass(frozen=True)
class Autopilot:
    """One kind of autopilot.

    Parameters
    ----------
    name
        what it is called.
    hold, ready, mission, guided, back, land
        its modes, as `custom_mode` of a heartbeat has them; `ready` is that in which it is armed.
    home_first
        whether item 0 of a mission is the place of home, which the autopilot sets itself.
    streams
        whether way points outside a mission must be said again at 2 Hz and more, and before the mode that follows them.
    stick_modes
        the modes in which a pilot flies it by sticks.
    names
        its modes by name.
    """

    name: str
    hold: int
    ready: int
    mission: int
    guided: int
    back: int
    land: int
    home_first: bool
    streams: bool
    stick_modes: tuple[int, ...]
    names: Mapping[int, str]

    def final_mode(self, at_end: AtEnd) -> int:
        """The mode in which a drone ends its flight."""
        return {"hold": self.hold, "return": self.back, "land": self.land}[at_end]

    @property
    def own_modes(self) -> tuple[int, ...]:
        """Those in which Muster flies it; in any other somebody else does."""
        return self.hold, self.ready, self.mission, self.guided

    def name_of_mode(self, mode: int) -> str:
        """The name of a mode, as the autopilot's documents have it; its number where it has none."""
        return self.names.get(mode, f"mode {mode:#x}")

    def mode_parameters(self, mode: int) -> tuple[float, float]:
        """The second and third parameter of DO_SET_MODE."""
        return (float(mode), 0.0) if mode <= 0xFFFF else (float(mode >> 16 & 0xFF), float(mode >> 24))


def _px4(main: int, sub: int = 0) -> int:
    return main << 16 | sub << 24


_PX4_STICKS = {"MANUAL": 1, "POSCTL": 3, "ALTCTL": 2, "ACRO": 5, "STABILIZED": 7, "RATTITUDE": 8}
_PX4_AUTO = ("READY", "TAKEOFF", "HOLD", "MISSION", "RTL", "LAND", "RTGS", "FOLLOW ME", "PRECLAND")
_PX4_NAMES = {
    **{_px4(main): name for name, main in _PX4_STICKS.items()},
    **{_px4(4, sub): name for sub, name in enumerate(_PX4_AUTO, 1)},
    _px4(6): "OFFBOARD",
}
_PX4_HOLD = _px4(4, 3)
PX4 = Autopilot(
    "PX4",
    _PX4_HOLD,
    _PX4_HOLD,
    _px4(4, 4),
    _px4(6),
    _px4(4, 5),
    _px4(4, 6),
    home_first=False,
    streams=True,
    stick_modes=tuple(map(_px4, _PX4_STICKS.values())),
    names=_PX4_NAMES,
)
_COPTER_NAMES = {mode: entry.name.removeprefix("COPTER_MODE_") for mode, entry in mavlink.enums["COPTER_MODE"].items()}
ARDUPILOT = Autopilot(
    "ArduPilot",
    17,
    4,
    3,
    4,
    6,
    9,
    home_first=True,
    streams=False,
    stick_modes=(0, 2, 1, 5, 7, 11, 13, 14, 15, 16, 18, 24, 26, 28),
    names=_COPTER_NAMES,
)

_KNOWN = {mavlink.MAV_AUTOPILOT_PX4: PX4, mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA: ARDUPILOT}

_COPTERS = (
    mavlink.MAV_TYPE_QUADROTOR,
    mavlink.MAV_TYPE_HEXAROTOR,
    mavlink.MAV_TYPE_OCTOROTOR,
    mavlink.MAV_TYPE_TRICOPTER,
    mavlink.MAV_TYPE_COAXIAL,
    mavlink.MAV_TYPE_HELICOPTER,
)


def autopilot_of(heartbeat: Message, who: str) -> Autopilot:
    """Which one sends this heartbeat.

    Raises
    ------
    ParameterError
        if it is none that Muster flies, or no multicopter or helicopter; `who` is named.
    """
    if heartbeat.autopilot not in _KNOWN:
        name = name_of("MAV_AUTOPILOT", heartbeat.autopilot)
        raise ParameterError(f"{who}: autopilot {name}; expected PX4 or ArduPilot")
    if heartbeat.type not in _COPTERS:
        raise ParameterError(
            f"{who}: vehicle {name_of('MAV_TYPE', heartbeat.type)}; expected a multicopter or helicopter"
        )
    return _KNOWN[heartbeat.autopilot]
