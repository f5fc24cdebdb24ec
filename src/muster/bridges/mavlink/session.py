"""One drone, sans-I/O: messages in, messages out, times given. What it does, how far it is, why it cannot go on.

Without `settings.arm` a session says nothing but heartbeats and requests for telemetry: all leaves by `_say`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from muster.bridges.mavlink import scripts
from muster.bridges.mavlink.autopilots import Autopilot, autopilot_of
from muster.bridges.mavlink.conversation import Conversation, Script, pause
from muster.bridges.mavlink.dialect import Message, mavlink
from muster.bridges.mavlink.faults import Fault, FaultError, Kind, Reaction
from muster.bridges.mavlink.follower import EVERY_S, Follower
from muster.bridges.mavlink.items import Route, route_of
from muster.bridges.mavlink.seen import Seen
from muster.bridges.mavlink.settings import Settings
from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.port import Place, Telemetry, Waypoint

Fence = Callable[[Place, Sequence[Waypoint]], str]
"""Why a drone may not go from a place through way points; empty if it may."""

_TELEMETRY = (30, 32, 33, 147, 1, 42, 162)  # ATTITUDE, the two places, the two of the battery, MISSION_CURRENT, fence
_TELEMETRY_US = 100_000
_ASK_AGAIN_S = 5.0
_REQUESTS = (mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAV_CMD_REQUEST_MESSAGE)


class Session:
    """What is said to one drone and heard from it.

    Parameters
    ----------
    robot
        who it is in the mission.
    seen
        where what it says of itself is kept, and the frames in which it says it.
    settings
        what is allowed.
    fence
        says where it may go.
    height_m
        in a mission in the plane, how high above home it flies; None in space.
    """

    def __init__(self, robot: Robot, seen: Seen, settings: Settings, fence: Fence, height_m: float | None) -> None:
        self.robot, self.seen, self.settings = robot, seen, settings
        self.autopilot: Autopilot | None = None
        self.fault: Fault | None = None
        self.order, self.passed = 0, 0
        self.fence, self._height_m = fence, height_m
        self._outbox: list[Message] = []
        self._talk: Conversation | None = None
        self._route: Route | None = None  # the mission that it flies
        self._follower: Follower | None = None
        self._mode: int | None = None  # in which it must be
        self._flew = False  # whether Muster asked it to arm
        self._took_off = False  # whether it was seen armed since
        self._astray = 0  # heartbeats in a row in another mode
        self._said_s = self._asked_s = self._streamed_s = float("-inf")

    @property
    def located(self) -> bool:
        """Whether it has said where it is, in all frames in which it is to be told where to go."""
        return self.seen.place is not None and not (self.settings.offboard and self.seen.local is None)

    def take(self) -> list[Message]:
        """What is to be sent, which it forgets."""
        taken, self._outbox = self._outbox, []
        return taken

    def telemetry(self) -> Telemetry | None:
        """As a port has it; None before it has said where it is."""
        seen = self.seen
        if seen.place is None:
            return None
        place = seen.place if self._height_m is None else (*seen.place[:2], 0.0)
        return Telemetry(seen.place_s, place, seen.heading, seen.velocity, seen.odometry_m, self.order, self.passed)

    def follow(self, waypoints: Sequence[Waypoint], now: float) -> int:
        """Let it pass way points in place of those that it still has.

        Raises
        ------
        ParameterError
            if it may not arm.
        """
        if not self.settings.arm:
            raise ParameterError(f"{self.robot.id}: way points; expected none without leave to arm")
        self._take_order()
        if self.fault is None:
            self._try(lambda: self._set_out([self.flown(waypoint) for waypoint in waypoints], now), now)
        return self.order

    def hold(self, now: float) -> int:
        """Let it stay where it is, if it flies, and is ours."""
        self._take_order()
        if self.autopilot is not None:
            self._bring_into(self.autopilot.hold, now)
        return self.order

    def go_back(self, now: float) -> None:
        """Let it return to where it was armed, and land there, as its autopilot does it."""
        if self.autopilot is not None:
            self._bring_into(self.autopilot.back, now)

    def land(self, now: float) -> None:
        """Let it land where it is."""
        if self.autopilot is not None:
            self._bring_into(self.autopilot.land, now)

    def hear(self, message: Message, now: float) -> None:
        """Take in one message.

        Raises
        ------
        ParameterError
            at the first heartbeat, if Muster cannot fly such a drone.
        """
        if message.get_type() == "HEARTBEAT" and self.autopilot is None:
            self.autopilot = autopilot_of(message, self.robot.id)
        if self.autopilot is None:
            return
        self.seen.hear(message, now)
        self._try(lambda: self._answer(message, now), now)

    def tick(self, now: float) -> None:
        """Say what is due, and notice what did not come."""
        if now >= self._said_s + 1.0:
            self._said_s = now
            kind = mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID
            self._say(mavlink.MAVLink_heartbeat_message(*kind, 0, 0, mavlink.MAV_STATE_ACTIVE, 3))
        if self.autopilot is None:
            return
        silent = now - max(self.seen.place_s, self._asked_s) >= _ASK_AGAIN_S
        if silent or self._asked_s < 0:
            self._ask_for_telemetry(now)
        self._try(lambda: self._go_on(now), now)

    def fail(self, kind: Kind, detail: str, now: float) -> None:
        """Take no part any more, for good, and react as the kind of fault says."""
        if self.fault is not None:
            return
        self.fault = Fault(now, self.robot.id, kind, detail)
        self._talk = self._route = self._follower = self._mode = None
        assert self.autopilot is not None
        reactions = {Reaction.HOLD: self.autopilot.hold, Reaction.RETURN: self.autopilot.back}
        if kind.reaction in reactions and self._ours:
            self._begin(self._into(reactions[kind.reaction]), now)

    @property
    def _ours(self) -> bool:
        """Whether it flies, in a mode in which Muster brought it."""
        return (
            self._flew and self.seen.armed and self.autopilot is not None and self.seen.mode in self.autopilot.own_modes
        )

    def _take_order(self) -> None:
        self.order, self.passed = self.order + 1, 0
        self._route = self._follower = None

    def flown(self, waypoint: Waypoint) -> Waypoint:
        """A way point at the height at which it is flown."""
        x, y, z = waypoint.position
        ground = self.seen.start[2]
        height = z if self._height_m is None else ground + self._height_m
        return replace(waypoint, position=(x, y, max(height, ground + self.settings.lowest_m)))

    def _set_out(self, waypoints: Sequence[Waypoint], now: float) -> None:
        here, target = self.seen.place, self.seen.heartbeat
        if here is None or target is None or not self.located:
            raise FaultError(Kind.NO_ANSWER, "it has not said where it is")
        refusal = self.fence(here, waypoints)
        if refusal:
            raise FaultError(Kind.OUTSIDE_FENCE, refusal)
        if not waypoints:
            return
        self._require_charge()
        self._begin(self._guided(waypoints) if self.settings.offboard else self._mission(waypoints), now)

    def _mission(self, waypoints: Sequence[Waypoint]) -> Script:
        """Stay, be given a mission, arm if it stands on the ground, fly it. Missions are never changed in flight."""
        target, seen = self.seen.heartbeat, self.seen
        assert self.autopilot is not None
        assert seen.earth is not None
        yield from self._into(self.autopilot.hold if seen.armed else self.autopilot.ready)
        assert seen.place is not None
        route = route_of(
            waypoints,
            seen.place,
            seen.earth,
            self.autopilot,
            speed_mps=self.robot.speed_mps,
            accept_m=self.settings.accept_m,
            take_off=not seen.armed,
        )
        yield from scripts.upload(target, route)
        yield from self._armed()
        yield from scripts.started(target, self.autopilot, route.first)
        self._route, self._mode = route, self.autopilot.mission

    def _guided(self, waypoints: Sequence[Waypoint]) -> Script:
        """PX4: way points are said for a second, then it follows them. ArduPilot: it climbs first."""
        assert self.autopilot is not None
        assert self.seen.local is not None
        follower = Follower(waypoints, self.settings.accept_m)
        if self.autopilot.streams:
            self._follower = follower
            yield pause(1.2)
            yield from self._into(self.autopilot.guided)
            yield from self._armed()
            return
        yield from self._into(self.autopilot.guided)
        if not self.seen.armed:
            yield from self._armed()
            yield from scripts.climb(self.seen.heartbeat, waypoints[0].position[2] - self.seen.start[2])
        self._follower = follower

    def _armed(self) -> Script:
        self._flew = True
        if not self.seen.armed:
            yield from scripts.armed(self.seen.heartbeat)

    def _into(self, mode: int) -> Script:
        assert self.autopilot is not None
        self._mode = None
        if self.seen.mode != mode:
            yield from scripts.mode(self.seen.heartbeat, self.autopilot, mode)
        self._mode = mode

    def _bring_into(self, mode: int, now: float) -> None:
        """Into a mode, if it flies under Muster, and has not failed."""
        if self.fault is None:
            self._talk = None
            if self._ours:
                self._try(lambda: self._begin(self._into(mode), now), now)

    def _begin(self, script: Script, now: float) -> None:
        self._astray = 0
        self._talk = Conversation(script, self._say, now)

    def _answer(self, message: Message, now: float) -> None:
        if self._talk is not None:
            self._talk.hear(message, now)
            self._talk = None if self._talk.done else self._talk
        elif message.get_type() == "HEARTBEAT" and self.fault is None and self._flew:
            self._look_at_mode()
        self._see_progress(message)

    def _see_progress(self, message: Message) -> None:
        """Items reached: one that is lost is made up for by the next, and one that is repeated changes nothing."""
        if self._route is None:
            return
        if message.get_type() == "MISSION_ITEM_REACHED":
            self.passed = max(self.passed, self._route.passed(message.seq))
        elif message.get_type() == "MISSION_CURRENT":
            over = message.mission_state == mavlink.MISSION_STATE_COMPLETE
            self.passed = max(self.passed, self._route.passed(len(self._route.items) if over else message.seq - 1))

    def _look_at_mode(self) -> None:
        """In a mode that Muster did not choose somebody else flies: the pilot, or the autopilot's own failsafe."""
        assert self.autopilot is not None
        self._took_off = self._took_off or self.seen.armed
        if self._took_off and not self.seen.armed and self._mode not in (self.autopilot.back, self.autopilot.land):
            raise FaultError(Kind.DISARMED, self.seen.text or "it says that it is not armed")
        over = self._route is not None and self.passed >= len(self._route.passed_with)
        fine = self._mode is None or self.seen.mode == self._mode or (over and self.seen.mode == self.autopilot.hold)
        self._astray = 0 if fine else self._astray + 1
        if self._astray >= 2:
            raise FaultError(Kind.TAKEN_OVER, f"mode {self.seen.mode:#x}; {self.seen.text}".rstrip("; "))

    def _go_on(self, now: float) -> None:
        if self._talk is not None:
            self._talk.tick(now)
            if self._talk.done:
                self._talk = None
        if self.fault is not None:
            return
        self._notice(now)
        if self._follower is not None and self.seen.place is not None:
            self._follower.look(self.seen.place, now)
            self.passed = self._follower.passed
            if now >= self._streamed_s + EVERY_S and self.seen.local is not None:
                self._streamed_s = now
                self._say(self._follower.message(self.seen.heartbeat, self.seen.local, now))

    def _notice(self, now: float) -> None:
        silence = now - self.seen.heartbeat_s
        if silence > self.settings.link_lost_s:
            raise FaultError(Kind.LINK_LOST, f"no heartbeat for {silence:.1f} s")
        if self._flew:
            if self.seen.breach:
                raise FaultError(Kind.FENCE_BREACHED, self.seen.breach)
            self._require_charge()

    def _require_charge(self) -> None:
        left = self.seen.battery
        if left is not None and left < self.settings.low_battery:
            raise FaultError(Kind.LOW_BATTERY, f"{left:.0%} left; expected {self.settings.low_battery:.0%}")

    def _try(self, what: Callable[[], None], now: float) -> None:
        """Do something that a fault may end; a second fault, of the reaction to the first, ends that alone."""
        try:
            what()
        except FaultError as error:
            said = f" ({self.seen.text})" if error.kind is Kind.ARM_REFUSED and self.seen.text else ""
            self._talk = None
            self.fail(error.kind, error.detail + said, now)

    def _ask_for_telemetry(self, now: float) -> None:
        self._asked_s = now
        for number in _TELEMETRY:
            rate = mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, _TELEMETRY_US
            self._say(scripts.command(self.seen.heartbeat, *rate))

    def _say(self, message: Message) -> None:
        """The one way out."""
        harmless = message.get_type() == "HEARTBEAT" or getattr(message, "command", None) in _REQUESTS
        assert harmless or self.settings.arm, f"{message.get_type()} without leave to arm"
        self._outbox.append(message)
