"""The session of one drone, sans-I/O: messages and orders in; messages, progress and faults out; times are given.

Without `settings.arm` a session says nothing but heartbeats and requests for telemetry: all leaves by `_say`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from muster.mission.errors import ParameterError
from muster.motion.port import Place, Telemetry, Waypoint
from muster_robots.mavlink.autopilots import AtEnd, autopilot_of
from muster_robots.mavlink.commands import guided, into, mission, stand_down
from muster_robots.mavlink.dialect import Message, mavlink
from muster_robots.mavlink.drone import Drone
from muster_robots.mavlink.fault_detection import FaultDetector
from muster_robots.mavlink.faults import Fault, FaultError, Kind, Reaction
from muster_robots.mavlink.position_targets import EVERY_S, position_target
from muster_robots.mavlink.procedures import command
from muster_robots.mavlink.requests import RequestSequence, Script

Fence = Callable[[Place, Sequence[Waypoint]], str]
"""Why a drone may not go from a place through way points; empty if it may."""

_TELEMETRY = (30, 32, 33, 147, 1, 42, 162)  # ATTITUDE, the two places, the two of the battery, MISSION_CURRENT, fence
_TELEMETRY_US = 100_000
_ASK_AGAIN_S = 5.0
_LET_GO = Kind.TAKEN_OVER, Kind.DISARMED
"""Faults after which Muster sends no command any more."""
_REQUESTS = (mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAV_CMD_REQUEST_MESSAGE)


class Session:
    """The connection to one drone.

    Parameters
    ----------
    drone
        who it is, and what is known of it.
    fence
        says where it may go.
    """

    def __init__(self, drone: Drone, fence: Fence) -> None:
        self.drone, self.fence = drone, fence
        self.faults: list[Fault] = []  # after the first, refusals of what it was told because of that, or at the end
        self._at_end: AtEnd = "hold"  # what a drone that is out is told when it answers
        self.hold_pending = False  # whether its link was lost, and it was not told to hold since
        self.takes_over = False  # whether it is taken over when it is heard
        self._order = 0
        self._outbox: list[Message] = []
        self._requests: RequestSequence | None = None
        self._fault_detector = FaultDetector(drone)
        self._said_s = self._asked_s = self._streamed_s = float("-inf")

    @property
    def fault(self) -> Fault | None:
        """Why it takes no part any more; None while it does."""
        return self.faults[0] if self.faults else None

    @property
    def busy(self) -> bool:
        """Whether a request is not answered yet."""
        return self._requests is not None

    def take(self) -> list[Message]:
        """What is to be sent, which it forgets."""
        taken, self._outbox = self._outbox, []
        return taken

    def telemetry(self) -> Telemetry | None:
        """As a port has it; None before it has said where it is."""
        drone, telemetry = self.drone, self.drone.telemetry
        if telemetry.place is None:
            return None
        place = telemetry.place if drone.height_m is None else (*telemetry.place[:2], 0.0)
        return Telemetry(
            telemetry.place_s,
            place,
            telemetry.heading,
            telemetry.velocity,
            telemetry.odometry_m,
            self._order,
            drone.passed,
            charge=telemetry.battery,
        )

    def follow(self, waypoints: Sequence[Waypoint], now: float) -> int:
        """Let it pass way points in place of those that it still has.

        Raises
        ------
        ParameterError
            if it may not arm.
        """
        if not self.drone.settings.arm:
            raise ParameterError(f"{self.drone.robot.id}: way points; expected none without leave to arm")
        self._take_order()
        if self.fault is None:
            self._try(lambda: self._set_out(self.drone.flown(waypoints), now), now)
        return self._order

    def hold(self, now: float) -> int:
        """Let it stay where it is, if it flies, and is ours; on the ground it is not left armed."""
        self._take_order()
        self.end("hold", now)
        return self._order

    def end(self, at_end: AtEnd, now: float) -> None:
        """Let it hover, return to where it was armed, or land, if it flies, and is ours.

        A drone that is out is told so as soon as it answers.
        """
        self._at_end = at_end
        if self.drone.autopilot is None:
            return
        if self.fault is None:
            self._requests = None
            self._try(lambda: self._end_flight(self._final_mode, now), now)
        elif self._hears(now) and self._may_interrupt(self.fault):
            self._requests = None
            self._try(lambda: self._call_back(now), now)

    def take_over(self, now: float) -> None:
        """Take over a drone that an earlier run has left armed in a mode of Muster's: it hovers, or stands down."""
        drone = self.drone
        self.takes_over = drone.autopilot is None  # not heard yet: at its first heartbeat
        if not self.takes_over and drone.telemetry.armed and drone.telemetry.mode in drone.kind.own_modes:
            drone.asked_to_arm = True
            self.end("hold", now)

    def note_missing_hold(self) -> None:
        """Add to its fault that it did not get the command to hover: it may fly on."""
        if self.fault is not None and self.hold_pending and self._is_left_to_us:
            self.faults[0] = replace(self.fault, detail=f"{self.fault.detail}; not told to hover")
            self.hold_pending = False

    def hear(self, message: Message, now: float) -> None:
        """Take in one message.

        Raises
        ------
        ParameterError
            at the first heartbeat, if Muster cannot fly such a drone.
        """
        if message.get_type() == "HEARTBEAT" and self.drone.autopilot is None:
            self.drone.autopilot = autopilot_of(message, self.drone.robot.id)
        if self.drone.autopilot is None:
            return
        self.drone.telemetry.hear(message, now)
        if self.takes_over and message.get_type() == "HEARTBEAT":
            self.take_over(now)
        if message.get_type() == "STATUSTEXT":
            self._explain_refusal(now)
        self._try(lambda: self._answer(message, now), now)

    def tick(self, now: float) -> None:
        """Say what is due, and notice what did not come."""
        if now >= self._said_s + 1.0:
            self._said_s = now
            kind = mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID
            self._say(mavlink.MAVLink_heartbeat_message(*kind, 0, 0, mavlink.MAV_STATE_ACTIVE, 3))
        if self.drone.autopilot is None:
            return
        silent = now - max(self.drone.telemetry.place_s, self._asked_s) >= _ASK_AGAIN_S
        if silent or self._asked_s < 0:
            self._ask_for_telemetry(now)
        self._try(lambda: self._go_on(now), now)

    def fail(self, kind: Kind, detail: str, now: float) -> None:
        """Take no part any more, for good, and react by the kind of fault."""
        texts = self.drone.telemetry.texts if kind.is_refusal else ()
        fault = Fault(now, self.drone.robot.id, kind, detail, texts)
        if self.fault is not None:
            self.hold_pending = self.fault.kind is Kind.LINK_LOST and kind is Kind.NO_ANSWER
            self.faults += [fault] if kind is Kind.COMMAND_REFUSED else []
            return
        self.faults.append(fault)
        self.hold_pending = kind is Kind.LINK_LOST
        self.drone.forget_order()
        self._requests = self.drone.mode = None
        reactions = {Reaction.HOLD: self.drone.kind.hold, Reaction.RETURN: self.drone.kind.back}
        if kind.reaction in reactions:
            self._end_flight(reactions[kind.reaction], now)

    def _explain_refusal(self, now: float) -> None:
        """Add a status text that arrives shortly after a refusal to its fault."""
        if self.faults and self.faults[-1].awaits_texts(now):
            self.faults[-1] = replace(self.faults[-1], texts=self.drone.telemetry.texts)

    def _take_order(self) -> None:
        self._order += 1
        self.drone.forget_order()

    def _set_out(self, waypoints: Sequence[Waypoint], now: float) -> None:
        here = self.drone.telemetry.place
        if here is None or not self.drone.located:
            raise FaultError(Kind.NO_ANSWER, "it has not said where it is")
        self._fault_detector.require_nobody_flies_it()
        refusal = self.fence(here, waypoints)
        if refusal:
            raise FaultError(Kind.OUTSIDE_FENCE, refusal)
        if not waypoints:
            return
        self._fault_detector.require_charge()
        way = guided if self.drone.settings.offboard else mission
        self._begin(way(self.drone, waypoints), now)

    @property
    def _final_mode(self) -> int:
        return self.drone.kind.final_mode(self._at_end)

    def _may_interrupt(self, fault: Fault) -> bool:
        """Whether the reaction to a fault may be broken off: to hover in favour of an end, to return never."""
        return self._requests is None or (self._at_end != "hold" and fault.kind.reaction is not Reaction.RETURN)

    def _end_flight(self, mode: int, now: float) -> None:
        """Into a mode if it flies under Muster; on the ground it stands down instead."""
        if self.drone.stands:
            self._begin(stand_down(self.drone), now)
        elif self.drone.ours:
            self._begin(into(self.drone, mode), now)

    @property
    def _is_left_to_us(self) -> bool:
        """Whether nobody flies it but Muster: no pilot, and no failsafe of its autopilot."""
        drone = self.drone
        return drone.ours or (
            drone.stands and (not drone.telemetry.armed or drone.telemetry.mode in drone.kind.own_modes)
        )

    def _hears(self, now: float) -> bool:
        return now - self.drone.telemetry.heartbeat_s <= self.drone.settings.link_lost_s

    def _call_back(self, now: float) -> None:
        """Let one that has failed end its flight, or stand down: it may still fly what others fly now."""
        self.hold_pending = False
        if self.fault is not None and self.fault.kind not in _LET_GO and self._is_left_to_us:
            self._end_flight(self._final_mode, now)

    def _begin(self, script: Script, now: float) -> None:
        self._fault_detector.astray = 0
        if not (self.faults and self.faults[-1].awaits_texts(now)):
            self.drone.telemetry.texts = ()
        self._requests = RequestSequence(script, self._say, now)

    def _answer(self, message: Message, now: float) -> None:
        beats = message.get_type() == "HEARTBEAT" and self.drone.asked_to_arm
        if self._requests is not None:
            if beats:
                self._fault_detector.check_heartbeat_meanwhile()
            self._requests.hear(message, now)
            self._requests = None if self._requests.done else self._requests
        elif beats and self.fault is None:
            self._fault_detector.check_heartbeat()
        elif beats and self.hold_pending:
            self._call_back(now)
        self._see_progress(message)

    def _see_progress(self, message: Message) -> None:
        """Items reached: one that is lost is made up for by the next, and one that is repeated changes nothing."""
        drone = self.drone
        if drone.route is None:
            return
        if message.get_type() == "MISSION_ITEM_REACHED":
            drone.passed = max(drone.passed, drone.route.passed(message.seq))
        elif message.get_type() == "MISSION_CURRENT":
            over = message.mission_state == mavlink.MISSION_STATE_COMPLETE
            drone.passed = max(drone.passed, drone.route.passed(len(drone.route.items) if over else message.seq - 1))

    def _go_on(self, now: float) -> None:
        if self._requests is not None:
            self._requests.tick(now)
            if self._requests.done:
                self._requests = None
        if self.fault is None:
            self._fault_detector.check_clock(now)
            self._lead(now)

    def _lead(self, now: float) -> None:
        """Say where it is to be, if it is led by way points that are said one by one."""
        drone, telemetry = self.drone, self.drone.telemetry
        if drone.follower is None or telemetry.place is None:
            return
        drone.follower.hear(now, telemetry.place, telemetry.heading)
        drone.passed = drone.follower.passed
        if now >= self._streamed_s + EVERY_S and telemetry.local is not None:
            self._streamed_s = now
            self._say(position_target(drone.follower.target, drone.target, telemetry.local, now))

    def _try(self, what: Callable[[], None], now: float) -> None:
        """Do something that a fault may end; a second fault, of the reaction to the first, ends that alone."""
        try:
            what()
        except FaultError as error:
            self._requests = None
            self.fail(error.kind, error.detail, now)

    def _ask_for_telemetry(self, now: float) -> None:
        self._asked_s = now
        for number in _TELEMETRY:
            rate = mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, _TELEMETRY_US
            self._say(command(self.drone.target, *rate))

    def _say(self, message: Message) -> None:
        """The one way out."""
        harmless = message.get_type() == "HEARTBEAT" or getattr(message, "command", None) in _REQUESTS
        if not harmless and not self.drone.settings.arm:
            name = f"{self.drone.robot.id}: {message.get_type()}"
            raise ParameterError(f"{name}; expected nothing of the kind without leave to arm")
        self._outbox.append(message)
