"""The telemetry of a drone: messages to position, velocity, heading, mode and battery."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from muster.execution.final_state import UP_M
from muster.motion.frames import enu_to_ned, yaw_enu_to_ned
from muster.motion.port import Place
from muster_robots.mavlink.dialect import Message, mavlink, name_of
from muster_robots.mavlink.doubles import Doubles
from muster_robots.mavlink.faults import StatusText
from muster_robots.mavlink.frames import GlobalFrame, LocalFrame

_STILL_MPS = 0.2  # slower is noise, and no way
_TEXTS = 30  # so many status texts are kept
_STEADY_MPS = 0.5  # slower than that upwards or downwards, it does not fall
_TOUCHED = 10  # so often the autopilot has said that the drone is on the ground, a second long, before it is disarmed
_LANDS_BELOW_M = 2.0  # above its start; a drone that is disarmed higher, and has not touched down, falls
_STALE_S = 2.0  # a position that is older, when something else arrives, is not where the drone is
_BREACH_S = 10.0  # for so long a breach counts that was said by a text alone


@dataclass
class DroneTelemetry:
    """Working state of one drone.

    Parameters
    ----------
    start
        where it stands in the map frame when it is switched on; without `earth` its local frame begins there.
    earth
        the map frame on Earth; None in a mission without an origin.
    """

    start: Place
    earth: GlobalFrame | None
    heartbeat: Message | None = None  # the last
    heartbeat_s: float = -math.inf
    place: Place | None = None
    place_s: float = -math.inf  # when that was said
    velocity: Place = (0.0, 0.0, 0.0)
    heading: float = 0.0
    odometry_m: float = 0.0
    was_up: bool = False  # whether it was seen in the air, armed
    battery: float | None = None  # share that remains
    sticks: bool = False  # whether a pilot's input device works
    breach: str = ""  # of the fence of the autopilot, in words
    texts: tuple[StatusText, ...] = ()  # its last status texts, the latest at the end
    texts_heard: int = 0
    heard_s: float = -math.inf  # when anything arrived last
    heard_since_s: float = -math.inf  # since when there was no gap
    motors_off_m: float | None = None  # metres above its start at which its motors stopped, if that was in the air
    _breach_until_s: float = math.inf
    _in_air_m: float | None = None  # metres above its start when it last said that it is in the air
    _touched: int = 0  # how often it has said since that it is on the ground, and was armed and steady
    local: LocalFrame | None = None
    doubles: Doubles = field(default_factory=Doubles)
    _ned: Place | None = None

    def texts_since(self, since_s: float) -> tuple[StatusText, ...]:
        """The status texts that have arrived since a time."""
        return tuple(text for text in self.texts if text.at_s >= since_s)

    def texts_after(self, count: int) -> tuple[StatusText, ...]:
        """The status texts that have arrived after so many."""
        return self.texts[max(0, len(self.texts) - (self.texts_heard - count)) :]

    @property
    def mode(self) -> int:
        """`custom_mode` of the last heartbeat; -1 before."""
        return -1 if self.heartbeat is None else int(self.heartbeat.custom_mode)

    @property
    def armed(self) -> bool:
        return self.heartbeat is not None and bool(self.heartbeat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    @property
    def critical(self) -> bool:
        """Whether its autopilot says that a failsafe is on."""
        return self.heartbeat is not None and self.heartbeat.system_status >= mavlink.MAV_STATE_CRITICAL

    @property
    def is_located(self) -> bool:
        """Whether its last position is as new as what it said last."""
        return self.place is not None and self.heard_s <= self.place_s + _STALE_S

    @property
    def up(self) -> bool:
        """Whether it is in the air, armed."""
        return self.armed and self.place is not None and self.place[2] > self.start[2] + UP_M

    def note_heard(self, now: float) -> None:
        """Note that something has arrived, whatever it is."""
        self.heard_since_s = now if now > self.heard_s + _STALE_S else self.heard_since_s
        self.heard_s = now

    def hear(self, message: Message, now: float) -> None:
        """Take in one message."""
        self.doubles.hear(message)
        if now > self._breach_until_s:
            self.breach, self._breach_until_s = "", math.inf
        take = getattr(self, f"_hear_{message.get_type().lower()}", None)
        if take is not None:
            take(message, now)

    def _hear_heartbeat(self, message: Message, now: float) -> None:
        was_armed, self.heartbeat, self.heartbeat_s = self.armed, message, now
        if self.armed:
            self.motors_off_m = None
        elif was_armed and self.was_up:
            self._stop_motors()

    def _stop_motors(self) -> None:
        """Note the height at which a drone was disarmed that has not touched down."""
        above_m = self._in_air_m if self._in_air_m is not None else self._above_m
        if self._touched < _TOUCHED and above_m is not None and above_m > _LANDS_BELOW_M:
            self.motors_off_m = above_m

    @property
    def _above_m(self) -> float | None:
        """Its height above its start, metres; None where its position is not known."""
        return self.place[2] - self.start[2] if self.place is not None and self.is_located else None

    def _hear_extended_sys_state(self, message: Message, now: float) -> None:
        steady = abs(self.velocity[2]) < _STEADY_MPS or not self.is_located
        if message.landed_state not in (mavlink.MAV_LANDED_STATE_ON_GROUND, mavlink.MAV_LANDED_STATE_UNDEFINED):
            self._touched, self._in_air_m = 0, self._above_m
        elif steady and self.armed:
            self._touched += 1

    def _hear_global_position_int(self, message: Message, now: float) -> None:
        """Degrees times 1e7, mm above home, cm/s north, east, down."""
        if self.earth is None or (message.lat == 0 and message.lon == 0):  # it does not know where it is
            return
        place = self.earth.to_map(message.lat, message.lon, message.relative_alt / 1000)
        east, north, up = enu_to_ned((message.vx / 100, message.vy / 100, message.vz / 100)).tolist()
        self._is_at(place, (east, north, up), now)
        if self._ned is not None and (self.local is None or not self.armed):
            self.local = LocalFrame.matched(place, self._ned)

    def _hear_local_position_ned(self, message: Message, now: float) -> None:
        ned, velocity = (message.x, message.y, message.z), (message.vx, message.vy, message.vz)
        if not all(map(math.isfinite, (*ned, *velocity))):  # it does not know where it is
            return
        self._ned = ned
        if self.earth is None:
            self.local = self.local or LocalFrame(self.start)
            self._is_at(self.local.to_map(ned), self.local.velocity_to_map(velocity), now)

    def _hear_attitude(self, message: Message, now: float) -> None:
        if math.isfinite(message.yaw):
            local = self.local if self.earth is None else None
            self.heading = float(yaw_enu_to_ned(message.yaw)) if local is None else local.heading_to_map(message.yaw)

    def _hear_sys_status(self, message: Message, now: float) -> None:
        self._has_left(message.battery_remaining)
        self.sticks = bool(message.onboard_control_sensors_health & mavlink.MAV_SYS_STATUS_SENSOR_RC_RECEIVER)

    def _hear_battery_status(self, message: Message, now: float) -> None:
        if message.id == 0:  # others feed cameras, or motors of their own
            self._has_left(message.battery_remaining)

    def _hear_fence_status(self, message: Message, now: float) -> None:
        if message.breach_status:
            self.breach, self._breach_until_s = name_of("FENCE_BREACH", message.breach_type), math.inf
        elif self._breach_until_s == math.inf:  # a text is believed on its own
            self.breach = ""

    def _hear_statustext(self, message: Message, now: float) -> None:
        text = "".join(letter for letter in message.text if letter.isprintable())
        if message.chunk_seq and self.texts:  # a long text comes in pieces
            last = self.texts[-1]
            self.texts = (*self.texts[:-1], replace(last, text=last.text + text))
        else:
            self.texts = (*self.texts, StatusText(now, message.severity, text))[-_TEXTS:]
            self.texts_heard += 1
        words = self.texts[-1].text.lower()
        if "fence" in words and "breach" in words:
            cleared = "clear" in words
            self.breach = "" if cleared else self.texts[-1].text
            self._breach_until_s = math.inf if cleared else now + _BREACH_S

    def _has_left(self, percent: int) -> None:
        if percent >= 0:  # -1: not known
            self.battery = percent / 100

    def _is_at(self, place: Place, velocity: Place, now: float) -> None:
        self.velocity = velocity
        if self.place is not None and self.armed and math.hypot(*self.velocity) > _STILL_MPS:
            self.odometry_m += math.dist(self.place, place)
        self.place, self.place_s = place, now
        self.was_up = self.was_up or self.up
