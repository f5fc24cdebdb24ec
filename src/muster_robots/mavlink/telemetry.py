"""The telemetry of a drone: messages to position, velocity, heading, mode and battery."""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster.execution.final_state import UP_M
from muster.motion.frames import enu_to_ned, yaw_enu_to_ned
from muster.motion.port import Place
from muster_robots.mavlink.dialect import Message, mavlink, name_of
from muster_robots.mavlink.frames import GlobalFrame, LocalFrame

_STILL_MPS = 0.2  # slower is noise, and no way
_TEXTS = 3  # so many status texts are kept


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
    breach: str = ""  # of the fence of the autopilot, in words
    texts: tuple[str, ...] = ()  # its last status texts, the latest at the end
    local: LocalFrame | None = None
    _ned: Place | None = None

    @property
    def text(self) -> str:
        """The last status text; empty if there is none."""
        return self.texts[-1] if self.texts else ""

    @property
    def mode(self) -> int:
        """`custom_mode` of the last heartbeat; -1 before."""
        return -1 if self.heartbeat is None else int(self.heartbeat.custom_mode)

    @property
    def armed(self) -> bool:
        return self.heartbeat is not None and bool(self.heartbeat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    @property
    def up(self) -> bool:
        """Whether it is in the air, armed."""
        return self.armed and self.place is not None and self.place[2] > self.start[2] + UP_M

    def hear(self, message: Message, now: float) -> None:
        """Take in one message."""
        take = getattr(self, f"_hear_{message.get_type().lower()}", None)
        if take is not None:
            take(message, now)

    def _hear_heartbeat(self, message: Message, now: float) -> None:
        self.heartbeat, self.heartbeat_s = message, now

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

    def _hear_battery_status(self, message: Message, now: float) -> None:
        if message.id == 0:  # others feed cameras, or motors of their own
            self._has_left(message.battery_remaining)

    def _hear_fence_status(self, message: Message, now: float) -> None:
        if message.breach_status:
            self.breach = name_of("FENCE_BREACH", message.breach_type)

    def _hear_statustext(self, message: Message, now: float) -> None:
        text = "".join(letter for letter in message.text if letter.isprintable())
        if message.chunk_seq and self.texts:  # a long text comes in pieces
            self.texts = (*self.texts[:-1], self.text + text)
        else:
            self.texts = (*(known for known in self.texts if known != text), text)[-_TEXTS:]
        words = self.text.lower()
        if "fence" in words and "breach" in words:
            self.breach = "" if "clear" in words else self.text

    def _has_left(self, percent: int) -> None:
        if percent >= 0:  # -1: not known
            self.battery = percent / 100

    def _is_at(self, place: Place, velocity: Place, now: float) -> None:
        self.velocity = velocity
        if self.place is not None and self.armed and math.hypot(*self.velocity) > _STILL_MPS:
            self.odometry_m += math.dist(self.place, place)
        self.place, self.place_s = place, now
        self.was_up = self.was_up or self.up
