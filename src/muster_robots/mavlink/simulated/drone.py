"""A simulated autopilot, PX4-like or ArduPilot-like, with configurable faults. Sans-I/O.

It speaks the protocol as the real ones do (missions, commands, modes, telemetry, way points one by one) and flies as a
point. It is no proof that a real one behaves so: docs/mavlink.md says what was tested against what.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

from muster.mission.model import Origin
from muster.motion.port import Place
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4, Autopilot
from muster_robots.mavlink.dialect import Codec, Message, mavlink
from muster_robots.mavlink.simulated.earth import degrees_of, ned_of
from muster_robots.mavlink.simulated.failsafes import OwnModes
from muster_robots.mavlink.simulated.faults import Faults
from muster_robots.mavlink.simulated.flight import Flight
from muster_robots.mavlink.simulated.geofence import Geofence

_OFFBOARD_LOST_S = 1.0
_DISARMS_AFTER_S = 2.0
"""Seconds on the ground after which a drone that has landed disarms itself (PX4: COM_DISARM_LAND)."""
_LANDS_MPS = 1.5
_STICKS = mavlink.MAV_SYS_STATUS_SENSOR_RC_RECEIVER


@dataclass
class SimulatedAutopilot:
    """One drone, sans-I/O.

    Parameters
    ----------
    kind
        PX4 or ARDUPILOT.
    origin
        where on Earth it is switched on.
    faults, seed
        what goes wrong, and the seed of what is lost.
    system
        its number.
    fence
        its polygons and circles.
    """

    kind: Autopilot
    origin: Origin
    faults: Faults = field(default_factory=Faults)
    system: int = 1
    seed: int = 0
    autopilot_field: int | None = None  # in heartbeats; of the kind by default
    flight: Flight = field(default_factory=Flight)
    fence: Geofence = field(default_factory=Geofence)
    mode: int = 0
    armed: bool = False
    battery: float = 0.9
    heard: list[Message] = field(default_factory=list)  # every message that came in, for tests
    items: list[Message] = field(default_factory=list)
    current: int = 0
    complete: bool = False

    def __post_init__(self) -> None:
        self._codec, self._random = Codec(self.system, 1), random.Random(self.seed)
        self._out: list[Message] = []
        self._late: list[Message] = []  # heartbeats that are held back
        self._arriving: list[Message | None] = []  # a mission that is uploaded
        self._setpoint: Place | None = None
        self._yaw: float | None = None  # that it was told, from north, clockwise; None: it looks where it flies
        self._setpoint_s = self._armed_s = self._held_s = -1e9
        self._now = self._said_s = self._telemetry_s = -1e9
        self._arms_s: float | None = None  # when it will be armed
        self._landed_s: float | None = None
        self._fence_asked = 0  # requests of its fence
        self._queue: list[bytes] = []  # what has arrived while the process stood still

    def receive(self, data: bytes) -> None:
        """Take in a packet."""
        if self._is_on("frozen"):
            self._queue.append(data)
            return
        for message in self._codec.parse(data):
            if not self._is_on("silent") and self._random.random() >= self.faults.loss:
                self.heard.append(message)
                handler = getattr(self, f"_on_{message.get_type().lower()}", None)
                mute = self.faults.mute or self._is_on("mute")
                if handler is not None and not mute and self._is_for_me(message):
                    handler(message)

    def advance(self, now: float) -> list[bytes]:
        """Fly until a time; returns the packets to be sent."""
        frozen = self._is_on("frozen")
        by_s = 0.0 if self._now < -1e8 or frozen else now - self._now
        self._now = now
        if self._is_on("frozen"):
            return []
        queued, self._queue = self._queue, []
        for data in queued:
            self.receive(data)
        if self._arms_s is not None and now >= self._arms_s:
            self.armed, self._arms_s = True, None
            self._armed_s = now if self._armed_s < -1e8 else self._armed_s
        self._let_faults_happen()
        if self.armed:
            self._fly(by_s)
        else:
            self.flight.fall(by_s)
        self._report(now)
        self._hold_heartbeats_back()
        out, self._out = self._out, []
        silent = self._is_on("silent")
        return [self._codec.pack(m) for m in out if not silent and self._random.random() >= self.faults.loss]

    @property
    def critical(self) -> bool:
        """Whether a failsafe is on."""
        return bool(self._own.on)

    @cached_property
    def _own(self) -> OwnModes:
        return OwnModes(self.kind, self.faults, self._tell, self.fence.action)

    def _is_on(self, what: str) -> bool:
        return self._armed_s > -1e8 and self._own.is_on(what, self._now - self._armed_s)

    def _tell(self, severity: int, text: str) -> None:
        self._say("statustext", severity, text.encode())

    def _hold_heartbeats_back(self) -> None:
        """While heartbeats are to be late, keep them; then say all of them."""
        begins_s = self.faults.late_heartbeats_s
        if begins_s is not None and self._due(begins_s) and not self._due(begins_s + self.faults.late_by_s):
            self._late += [message for message in self._out if message.get_type() == "HEARTBEAT"]
            self._out = [message for message in self._out if message.get_type() != "HEARTBEAT"]
        else:
            self._out, self._late = [*self._late, *self._out], []

    def _is_for_me(self, message: Message) -> bool:
        return getattr(message, "target_system", self.system) in (0, self.system)

    def _due(self, at_s: float | None) -> bool:
        return at_s is not None and self._armed_s > -1e8 and self._now >= self._armed_s + at_s

    def _let_faults_happen(self) -> None:
        if self.faults.low_battery_at_s is not None:
            self.battery = self.faults.low_battery if self._is_on("low_battery") else self._full
        if self.armed and self._due(self.faults.disarm_at_s):
            self.armed = False
            self._tell(mavlink.MAV_SEVERITY_INFO, "Disarmed by external command")
        if self.armed and self._armed_s > -1e8:
            self.mode = self._own.mode_after(self.mode, self._now - self._armed_s, outside=self._is_outside)

    @property
    def _is_outside(self) -> bool:
        """Whether it flies outside its fence of polygons and circles, and that is on."""
        armed_for_s = self._now - self._armed_s
        return self.armed and self.fence.is_on and self.fence.is_left_at(self.flight.place, armed_for_s)

    @cached_property
    def _full(self) -> float:
        return self.battery

    def _report(self, now: float) -> None:
        if now >= self._said_s + 1.0:
            self._said_s = now
            known = mavlink.MAV_AUTOPILOT_PX4 if self.kind is PX4 else mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA
            autopilot = known if self.autopilot_field is None else self.autopilot_field
            base = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | (mavlink.MAV_MODE_FLAG_SAFETY_ARMED if self.armed else 0)
            state = mavlink.MAV_STATE_CRITICAL if self.critical else mavlink.MAV_STATE_ACTIVE
            self._say("heartbeat", mavlink.MAV_TYPE_QUADROTOR, autopilot, base, self.mode, state, 3)
            sticks = _STICKS if self.faults.pilot_at_s is not None and not self.faults.no_sticks else 0
            self._say("sys_status", *[sticks] * 3, 0, 12000, -1, round(self.battery * 100), 0, 0, 0, 0, 0, 0)
            breached = int(self._is_on("breach") or self._is_outside)
            if self._is_on("breach_text"):
                self._tell(mavlink.MAV_SEVERITY_WARNING, "Geofence breached")
            self._say("fence_status", breached, breached, mavlink.FENCE_BREACH_BOUNDARY if breached else 0, 0)
        if now >= self._telemetry_s + 0.1:
            self._telemetry_s = now
            self._say_where(round(now * 1000) & 0xFFFFFFFF)

    def _say_where(self, ms: int) -> None:
        flight = self.flight
        lat, lon = (round(degrees * 1e7) for degrees in degrees_of(self.origin, flight.place))
        up = -flight.place[2]
        velocity = [round(v * 100) for v in flight.velocity]
        in_air = self.armed and flight.flies
        landed = mavlink.MAV_LANDED_STATE_IN_AIR if in_air else mavlink.MAV_LANDED_STATE_ON_GROUND
        self._say("extended_sys_state", 0, landed)
        self._say("attitude", ms, 0, 0, flight.yaw, 0, 0, 0)
        state = mavlink.MISSION_STATE_COMPLETE if self.complete else mavlink.MISSION_STATE_ACTIVE
        self._say("mission_current", self.current, len(self.items), state)
        if self._is_on("gps_lost") or self._is_on("no_position"):
            return
        self._say("global_position_int", ms, lat, lon, round((50 + up) * 1000), round(up * 1000), *velocity, 65535)
        self._say("local_position_ned", ms, *flight.place, *flight.velocity)

    def _say(self, name: str, *values: object) -> None:
        self._out.append(getattr(self._codec.make, f"{name}_encode")(*values))

    def _fly(self, by_s: float) -> None:
        if self.mode == self.kind.mission and not self.complete and self.items:
            self._fly_item(by_s)
        elif self.mode == self.kind.guided and self._setpoint is not None:
            if self.kind.streams and self._now > self._setpoint_s + _OFFBOARD_LOST_S:
                self.mode = self.kind.hold
            self.flight.go(self._setpoint, by_s, self._yaw)
        elif self.mode in (self.kind.back, self.kind.land):
            home = self.mode == self.kind.land or self.flight.go((0.0, 0.0, self.flight.place[2]), by_s)
            if home and self.flight.go((*self.flight.place[:2], 0.0), by_s, most_mps=_LANDS_MPS):
                self._landed_s = self._now if self._landed_s is None else self._landed_s
                if self._now >= self._landed_s + _DISARMS_AFTER_S:
                    self.armed, self._landed_s = False, None
                return
        else:
            self.flight.velocity = (0.0, 0.0, 0.0)
        self._landed_s = None

    def _fly_item(self, by_s: float) -> None:
        """ArduPilot turns as a condition before a way point says, waits for no turn, and holds for whole seconds."""
        item, whole = self.items[self.current], self.kind.home_first
        if item.command == mavlink.MAV_CMD_DO_CHANGE_SPEED:
            self.flight.speed_mps = item.param2
            self._next_item()
            return
        if item.command == mavlink.MAV_CMD_CONDITION_YAW:
            self._next_item()
            self._yaw = math.radians(item.param1)
            return
        yaw = self._yaw if whole else None if math.isnan(item.param4) else math.radians(item.param4)
        up = whole and self.current == 0
        if up or (self.flight.go(self._place_of(item), by_s, yaw) and (whole or self.flight.is_turned(yaw))):
            self._held_s = self._now if self._held_s < -1e8 else self._held_s
            hold_s = int(item.param1) if whole else item.param1
            if up or item.command == mavlink.MAV_CMD_NAV_TAKEOFF or self._now >= self._held_s + hold_s:
                for _ in range(3 if self.faults.repeat_reached else 1):
                    self._say("mission_item_reached", self.current)
                self._next_item()

    def _place_of(self, item: Message) -> Place:
        return ned_of(self.origin, item.x / 1e7, item.y / 1e7, item.z)

    def _next_item(self) -> None:
        self._held_s, self._yaw = -1e9, None
        if self.current + 1 < len(self.items):
            self.current += 1
        else:
            self.complete = True
            if self.kind is PX4:
                self.mode = self.kind.hold

    def _on_command_long(self, message: Message) -> None:
        handler: Callable[[Message], int] | None = {
            mavlink.MAV_CMD_DO_SET_MODE: self._set_mode,
            mavlink.MAV_CMD_COMPONENT_ARM_DISARM: self._arm,
            mavlink.MAV_CMD_MISSION_START: self._start,
            mavlink.MAV_CMD_NAV_TAKEOFF: self._take_off,
            mavlink.MAV_CMD_SET_MESSAGE_INTERVAL: lambda _: mavlink.MAV_RESULT_ACCEPTED,
        }.get(message.command)
        result = mavlink.MAV_RESULT_UNSUPPORTED if handler is None else handler(message)
        self._say("command_ack", message.command, result)

    def _on_param_request_read(self, message: Message) -> None:
        fence_m, first_m = self.faults.fence_m or 0.0, self.faults.first_item_m or 0.0
        ardupilot = {"FENCE_RADIUS": fence_m, "FENCE_ALT_MAX": 100.0, "FENCE_AUTOENABLE": 0.0}
        px4 = {"GF_MAX_HOR_DIST": fence_m, "GF_MAX_VER_DIST": 0.0, "MIS_DIST_1WP": first_m}
        fractions = px4 if self.kind is PX4 else ardupilot
        known = {name: (value, mavlink.MAV_PARAM_TYPE_REAL32) for name, value in fractions.items()}
        known |= self.fence.parameters(self.kind)
        if message.param_id in known and not self.faults.mute_parameters:
            self._say("param_value", message.param_id.encode(), *known[message.param_id], len(known), 0)

    def _on_mission_request_list(self, message: Message) -> None:
        for name, values in self.fence.reply(message, self.origin, self._fence_asked):
            self._say(name, *values)
        self._fence_asked += 1

    _on_mission_request_int = _on_mission_request_list

    def _set_mode(self, message: Message) -> int:
        wide = self.kind is PX4
        wanted = int(message.param2) << 16 | int(message.param3) << 24 if wide else int(message.param2)
        if wanted == self.kind.guided and self.kind.streams and self._now > self._setpoint_s + _OFFBOARD_LOST_S:
            return int(mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
        if wanted == self.kind.guided != self.kind.ready and self.faults.refuse_start:
            return int(mavlink.MAV_RESULT_DENIED)
        if self._is_on("gps_lost") and wanted != self.kind.land:
            self._tell(mavlink.MAV_SEVERITY_CRITICAL, "Rejecting mode switch: no global position")
            return int(mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
        self.mode = self._own.ask(wanted, self.mode)
        return int(mavlink.MAV_RESULT_ACCEPTED)

    def _arm(self, message: Message) -> int:
        if not message.param1:
            return self._disarm()
        if self.faults.refuse_arm:
            self._say("statustext", mavlink.MAV_SEVERITY_CRITICAL, b"PreArm: compass not healthy")
            return int(mavlink.MAV_RESULT_DENIED)
        if self.kind is ARDUPILOT and self.mode != self.kind.guided:
            return int(mavlink.MAV_RESULT_FAILED)
        if not self.armed and self._arms_s is None:
            self._arms_s = self._now + self.faults.slow_arm_s
        return int(mavlink.MAV_RESULT_ACCEPTED)

    def _disarm(self) -> int:
        """In the air it refuses; a command to arm that is under way comes first."""
        if self.flight.flies:
            return int(mavlink.MAV_RESULT_DENIED)
        if self._arms_s is not None:
            return int(mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
        self.armed = False
        return int(mavlink.MAV_RESULT_ACCEPTED)

    def _start(self, message: Message) -> int:
        if not self.armed or not self.items or self.faults.refuse_start:
            self._say("statustext", mavlink.MAV_SEVERITY_CRITICAL, b"Mission start denied: no valid mission")
            return int(mavlink.MAV_RESULT_DENIED)
        if (refusal := self._infeasible()) or self._is_on("gps_lost"):
            self._tell(mavlink.MAV_SEVERITY_CRITICAL, refusal or "Mission rejected: no global position")
            return int(mavlink.MAV_RESULT_DENIED)
        self.mode = self._own.ask(self.kind.mission, self.mode)
        return int(mavlink.MAV_RESULT_ACCEPTED)

    def _infeasible(self) -> str:
        """Why a mission is refused at its start; empty if it is flown [PX4: MissionFeasibilityChecker]."""
        places = [i for i in self.items if i.command == mavlink.MAV_CMD_NAV_WAYPOINT][int(self.kind.home_first) :]
        far_m = [math.hypot(*self._place_of(item)[:2]) for item in places]
        first_m = self.faults.first_item_m
        if far_m and first_m is not None and far_m[0] > first_m:
            return f"First waypoint too far away: {far_m[0]:.0f}m, {first_m:.0f} max"
        far = math.inf if self.faults.fence_m is None else self.faults.fence_m
        for number, (item, metres) in enumerate(zip(places, far_m, strict=True), 1):
            left = self.kind is PX4 and self.fence.is_left_at(self._place_of(item), self._now - self._armed_s)
            if metres > far or left:
                return f"Geofence violation for waypoint {number}"
        return ""

    def _take_off(self, message: Message) -> int:
        if not self.armed or self.mode != self.kind.guided or self.faults.refuse_start:
            return int(mavlink.MAV_RESULT_DENIED)
        self._setpoint, self._yaw = (*self.flight.place[:2], -message.param7), None
        return int(mavlink.MAV_RESULT_ACCEPTED)

    def _on_mission_count(self, message: Message) -> None:
        self._arriving = [None] * message.count
        self._ask_for_item(message)

    def _on_mission_item_int(self, message: Message) -> None:
        if message.seq == self.faults.reject_item:
            self._ack(message, mavlink.MAV_MISSION_INVALID)
            return
        if message.seq < len(self._arriving):
            self._arriving[message.seq] = message
        if None in self._arriving:
            self._ask_for_item(message)
            return
        if self._arriving:
            self.items = [item for item in self._arriving if item is not None]
            self._arriving, self.current, self.complete, self._held_s = [], 0, False, -1e9
        self._ack(message, mavlink.MAV_MISSION_ACCEPTED)

    def _ask_for_item(self, message: Message) -> None:
        to = message.get_srcSystem(), message.get_srcComponent()
        self._say("mission_request_int", *to, self._arriving.index(None))

    def _ack(self, message: Message, result: int) -> None:
        self._say("mission_ack", message.get_srcSystem(), message.get_srcComponent(), result)

    def _on_mission_set_current(self, message: Message) -> None:
        if message.seq < len(self.items):
            self.current, self.complete, self._held_s = message.seq, False, -1e9

    def _on_set_position_target_local_ned(self, message: Message) -> None:
        """Of its type mask bits 0 to 2 say that the place does not count, bit 10 that the yaw does not."""
        if message.coordinate_frame == mavlink.MAV_FRAME_LOCAL_NED and not message.type_mask & 0b111:
            self._setpoint, self._setpoint_s = (message.x, message.y, message.z), self._now
            self._yaw = None if message.type_mask & 1 << 10 else message.yaw
