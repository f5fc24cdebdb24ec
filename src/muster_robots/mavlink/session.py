"""The session of one drone, sans-I/O: messages and orders in; messages, progress and faults out; times are given.

Without `settings.arm` a session says nothing but heartbeats and requests for telemetry: all leaves by `_say`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from muster.mission.errors import ParameterError
from muster.motion.port import Telemetry, Waypoint
from muster_robots.custody import Custody, Holder, Standing, Wants
from muster_robots.mavlink.autopilots import AtEnd, autopilot_of
from muster_robots.mavlink.commands import after_limits, guided, into, mission, stand_down, with_limits
from muster_robots.mavlink.dialect import Message, mavlink
from muster_robots.mavlink.drone import Drone, UnheardOrder
from muster_robots.mavlink.fault_detection import FaultDetector
from muster_robots.mavlink.faults import (
    KIND_UNDER,
    TEXTS_BEFORE_S,
    Costs,
    Fault,
    FaultError,
    Kind,
    Reaction,
    StatusText,
)
from muster_robots.mavlink.fence_detours import MapCheck
from muster_robots.mavlink.mission_items import given_in
from muster_robots.mavlink.position_targets import EVERY_S, position_target
from muster_robots.mavlink.procedures import telemetry_requests
from muster_robots.mavlink.requests import RequestSequence, Script

_ASK_AGAIN_S = 5.0
_LET_GO = Kind.LANDED, Kind.DISARMED
"""Faults after which Muster sends no command any more."""
_ANSWERS_S = 2.0
"""Seconds without any message after which answers are not waited for, until something is heard again."""
_WANTED: dict[AtEnd, Wants] = {"hold": Wants.HOLD, "return": Wants.RETURN, "land": Wants.LAND}
_AT_END: dict[Wants, AtEnd] = {wants: at_end for at_end, wants in _WANTED.items()}
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

    def __init__(self, drone: Drone, fence: MapCheck) -> None:
        self.drone, self.fence = drone, fence
        self.custody = Custody(drone.settings.custody_limits)
        self.faults: list[Fault] = []
        self.fault: Fault | None = None  # why it takes no part any more; None while it does
        self._refused = ""  # why it does not carry out its order
        self._suspended: Fault | None = None  # why it takes no part for now
        self._unheard: UnheardOrder | None = None
        self.takes_over = False  # whether it is taken over when it is heard
        self._order = 0
        self._texts_before = 0  # status texts that had arrived when the last command was begun
        self._silent_since_s = float("-inf")  # time of the last position before a silence
        self._outbox: list[Message] = []
        self._requests: RequestSequence | None = None
        self._fault_detector = FaultDetector(drone)
        self._said_s = self._asked_s = self._streamed_s = float("-inf")

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
        suspended = "" if self._suspended is None else self._suspended.reason
        unheard = None if self._unheard is None else (self._unheard.number, self._unheard.passed)
        return Telemetry(
            self._silent_since_s if self._counts_as_silent else telemetry.heard_s if suspended else telemetry.place_s,
            place,
            telemetry.heading,
            telemetry.velocity,
            telemetry.odometry_m,
            self._order,
            drone.passed,
            charge=telemetry.battery,
            refused=self._refused,
            suspended=suspended,
            carried_out=unheard,
        )

    @property
    def _counts_as_silent(self) -> bool:
        """Whether it is silent, or has been, and has not shown since that it does what Muster wants."""
        suspect = self.custody.standing is Standing.SUSPECT and self._suspended is None
        return self.fault is None and (suspect or self.custody.standing is Standing.SILENT)

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
        self._unheard = None
        if self.fault is None and self.custody.standing is Standing.OURS:
            self.custody.want(Wants.ORDER if waypoints else Wants.HOLD)
            self._try(lambda: self._set_out(self.drone.flown(waypoints), now), now)
        return self._order

    def read_limits(self, now: float) -> None:
        """Ask for what limits where it may fly; only with leave to arm."""
        if self.drone.settings.arm and self.drone.autopilot is not None:
            self._requests = RequestSequence(with_limits(self.drone), self._say, now)

    def hold(self, now: float) -> int:
        """Let it stay where it is, if it flies, and is ours; on the ground it is not left armed."""
        self._take_order()
        self.end("hold", now)
        return self._order

    def end(self, at_end: AtEnd, now: float) -> None:
        """Let it hover, return to where it was armed, or land, if it flies, and is ours.

        A drone that is silent, or that somebody else has, is told so as soon as it is heard, and is ours again.
        """
        if self.drone.autopilot is None or (self.fault is not None and self.fault.kind in _LET_GO):
            return
        if self.fault is not None and not self._may_interrupt(self.fault, at_end):
            return
        self.custody.want(_WANTED[at_end])
        self._requests = None
        if self.custody.is_heard and (self.fault is None or self.drone.is_left_to_us):
            self._try(lambda: self._end_flight(now), now)

    def take_over(self, now: float) -> None:
        """Take over a drone that an earlier run has left armed in a mode of Muster's: it hovers, or stands down."""
        drone = self.drone
        self.takes_over = drone.autopilot is None  # not heard yet: at its first heartbeat
        if not self.takes_over and drone.telemetry.armed and drone.telemetry.mode in drone.kind.own_modes:
            drone.asked_to_arm = True
            self.end("hold", now)

    @property
    def is_pending(self) -> bool:
        """Whether it was not told yet what it is to do at last, or has not shown that it does it."""
        drone = self.drone
        if drone.autopilot is None or not drone.asked_to_arm or (self.fault and self.fault.kind in _LET_GO):
            return False
        seen = drone.seen(busy=self.busy)
        fits = self.custody.does_what_is_wanted(seen) and not drone.stands
        return not self.custody.is_heard or (self.drone.is_left_to_us and not fits)

    @property
    def ends_its_flight(self) -> bool:
        """Whether it returns or lands, or is to and obeys nobody else."""
        drone = self.drone
        is_to = self.custody.wanted in (Wants.RETURN, Wants.LAND) and drone.ours
        return is_to or drone.telemetry.mode in (drone.kind.back, drone.kind.land)

    def note_missing_hold(self, now: float) -> None:
        """Add to its faults that it did not get the command to hover: it may fly on."""
        if not self.is_pending or not self.drone.is_left_to_us:
            return
        silent_s = now - self.drone.telemetry.heard_s
        detail = f"nothing heard for {silent_s:.1f} s; not told to hover"
        if not self.custody.is_heard and not any(fault.detail.endswith("not told to hover") for fault in self.faults):
            self.faults.append(Fault(now, self.drone.robot.id, Kind.LINK_LOST, detail))

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
        self.drone.telemetry.note_heard(now)
        self.drone.telemetry.hear(message, now)
        if self.takes_over and message.get_type() == "HEARTBEAT":
            self.take_over(now)
        if message.get_type() == "STATUSTEXT":
            self._add_texts(now)
        self._try(lambda: self._answer(message, now), now)
        self._try(lambda: self._watch(now), now)

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
        """Note a fault, and react by its kind: the drone is out for good, or its task is, or it takes part later."""
        if kind is Kind.LANDED and self._suspended is not None:
            detail = f"{detail}; {self._suspended.reason}"
        fault = Fault(now, self.drone.robot.id, kind, detail, self._texts_of(kind, now))
        if self.fault is not None:
            self.faults += [fault] if kind is Kind.COMMAND_REFUSED else []
            return
        self.faults.append(fault)
        did_not_obey = kind in (Kind.NO_ANSWER, Kind.COMMAND_REFUSED) and self.drone.telemetry.was_up
        if kind is Kind.START_REFUSED and self.drone.telemetry.critical:
            did_not_obey = True
        if did_not_obey:
            self.custody.suspect(now)
        if did_not_obey or kind is Kind.FENCE_BREACHED:
            self._suspended = fault
        if kind.costs is Costs.TASK and not did_not_obey:
            self._refused = fault.reason
        elif kind.costs is Costs.ROBOT and not did_not_obey:
            self.fault = fault
        self._break_off()
        if kind.reaction is not Reaction.NOTHING:
            self.custody.want(Wants.RETURN if kind.reaction is Reaction.RETURN else self._wanted_after)
            self._end_flight(now)

    @property
    def _wanted_after(self) -> Wants:
        """What it is to do after a fault: what the end of the mission asks, if that was said, else to hold."""
        return self.custody.wanted if self.custody.wanted in (Wants.RETURN, Wants.LAND) else Wants.HOLD

    def _break_off(self) -> None:
        self.drone.forget_order()
        self._requests = self.drone.mode = None

    def _texts_of(self, kind: Kind, now: float) -> tuple[StatusText, ...]:
        """The status texts that may give the cause of a fault: of a refusal all since the command."""
        telemetry = self.drone.telemetry
        refusal = kind.is_refusal
        return telemetry.texts_after(self._texts_before) if refusal else telemetry.texts_since(now - TEXTS_BEFORE_S)

    def _add_texts(self, now: float) -> None:
        """Add a status text that arrives shortly after a fault to it."""
        if not self.faults or not self.faults[-1].awaits_texts(now):
            return
        before, new = self.faults[-1], self.drone.telemetry.texts[-1]
        after = self.faults[-1] = before.with_text(new)
        self.fault = after if self.fault is before else self.fault
        self._suspended = after if self._suspended is before else self._suspended
        self._refused = after.reason if self._refused == before.reason else self._refused

    def _watch(self, now: float) -> None:
        """Compare what it is to do with what it does, and say the former again where that is due."""
        drone, before = self.drone, self.custody.standing
        command = self.custody.look(drone.seen(busy=self.busy), now)
        if (after := self.custody.standing) is not before:
            self._change_standing(after, now)
        if command is not None and drone.asked_to_arm and not self.busy and self._may_be_told:
            self._end_flight(now)

    @property
    def _may_be_told(self) -> bool:
        return self.fault is None or self.fault.kind not in _LET_GO

    def _change_standing(self, after: Standing, now: float) -> None:
        """Its relation to Muster is another: it takes no part for now, or takes part again."""
        if self.fault is not None:
            return
        if after is Standing.OURS:
            self._suspended = None
        elif after is Standing.SILENT:
            self._silent_since_s = self.drone.telemetry.place_s
        elif after in KIND_UNDER:
            self._suspend(KIND_UNDER[after], now)
        elif self._suspended is None and self.drone.telemetry.breach:
            self.fail(Kind.FENCE_BREACHED, self.drone.telemetry.breach, now)
        elif self._suspended is None and (unfit := self.drone.seen(busy=self.busy).unfit):
            self._suspend(Kind.NO_POSITION, now, unfit)
        if self.custody.is_worn_out(now):
            raise FaultError(Kind.LINK_LOST, self.custody.worn_out_words)

    def _suspend(self, kind: Kind, now: float, detail: str = "") -> None:
        """Somebody else has it, or it does not know where it is: it takes no part for now, and keeps its order not."""
        mode = f"mode {self.drone.kind.name_of_mode(self.drone.telemetry.mode)}"
        fault = Fault(now, self.drone.robot.id, kind, detail or mode, self._texts_of(kind, now))
        self.faults.append(fault)
        self._suspended = fault
        self._break_off()
        self.custody.want(self._wanted_after)

    def _take_order(self) -> None:
        if self.custody.standing is Standing.SILENT and self.drone.route is not None:
            self._unheard = UnheardOrder(self._order, self.drone.route, self.drone.passed)
        self._order += 1
        self._refused = ""
        self.drone.forget_order()

    def _set_out(self, waypoints: Sequence[Waypoint], now: float) -> None:
        here = self.drone.telemetry.place
        if here is None or not self.drone.located:
            raise FaultError(Kind.NO_ANSWER, "it has not said where it is")
        if self.drone.seen(busy=False).holder is not Holder.MUSTER:
            self.custody.let_go(self.drone.seen(busy=False))
            self._change_standing(self.custody.standing, now)
            return
        if refusal := self.fence(here, waypoints):
            raise FaultError(Kind.OUTSIDE_FENCE, refusal)
        if not waypoints:
            return
        self._fault_detector.require_charge()
        way = guided if self.drone.settings.offboard else mission
        self._begin(after_limits(self.drone, waypoints, self.fence, way), now)

    def _may_interrupt(self, fault: Fault, at_end: AtEnd) -> bool:
        """Whether the reaction to a fault may be broken off: to hover in favour of an end, to return never."""
        return fault.kind.reaction is not Reaction.RETURN and (self._requests is None or at_end != "hold")

    def _end_flight(self, now: float) -> None:
        """Into the mode that is wanted if it flies under Muster; on the ground it stands down instead."""
        if self.drone.stands:
            self._begin(stand_down(self.drone), now)
        elif self.drone.ours and self.custody.wanted in _AT_END:
            self._begin(into(self.drone, self.drone.kind.final_mode(_AT_END[self.custody.wanted])), now)

    def _begin(self, script: Script, now: float) -> None:
        self._texts_before = self.drone.telemetry.texts_heard
        self._requests = RequestSequence(script, self._say, now)

    def _answer(self, message: Message, now: float) -> None:
        beats = message.get_type() == "HEARTBEAT" and self.drone.asked_to_arm
        if self._requests is not None:
            self._requests.hear(message, now)
            self._requests = None if self._requests.done else self._requests
        elif beats and self.fault is None:
            self._fault_detector.check_heartbeat()
        if beats and self._requests is None and self.drone.mode == self.drone.telemetry.mode:
            self.drone.changing_mode = False
        self._see_progress(message)

    def _see_progress(self, message: Message) -> None:
        """Items reached: one that is lost is made up for by the next, and one that is repeated changes nothing."""
        unheard = self._unheard
        flown: Drone | UnheardOrder = self.drone if unheard is None or self.drone.route is not None else unheard
        if flown.route is not None:
            flown.passed = max(flown.passed, flown.route.passed_by(message))

    def _go_on(self, now: float) -> None:
        if self._requests is not None and now <= self.drone.telemetry.heard_s + _ANSWERS_S:
            self._requests.tick(now)
            if self._requests.done:
                self._requests = None
        self._watch(now)
        if self.fault is None:
            self._fault_detector.check_clock(now)
            self._lead(now)

    def _lead(self, now: float) -> None:
        """Say where it is to be, if it is led by way points that are said one by one."""
        drone, telemetry = self.drone, self.drone.telemetry
        if drone.follower is None or telemetry.place is None:
            return
        drone.follower.hear(now, telemetry.place, telemetry.heading)
        drone.passed = given_in(drone.follower.passed_points)
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
        for request in telemetry_requests(self.drone.target):
            self._say(request)

    def _say(self, message: Message) -> None:
        """The one way out."""
        harmless = message.get_type() == "HEARTBEAT" or getattr(message, "command", None) in _REQUESTS
        if not harmless and not self.drone.settings.arm:
            name = f"{self.drone.robot.id}: {message.get_type()}"
            raise ParameterError(f"{name}; expected nothing of the kind without leave to arm")
        self._outbox.append(message)
