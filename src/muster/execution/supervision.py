"""Supervision of the robots at intervals: findings of the monitor become changes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from muster.execution.changes import Changes
from muster.execution.deadlocks.standstill import Standstill
from muster.execution.deadlocks.traffic_waits import Progress, TrafficWaits, plain_place
from muster.execution.dispatch import Dispatch
from muster.execution.record import Tell
from muster.execution.robots.monitor import Limits, exceeds, is_silent, is_stuck, stands_in_the_way
from muster.execution.robots.robot_state import MOVING, Activity, RobotState
from muster.execution.robots.task_motion import place
from muster.motion.port import Place
from muster.state.robot_events import (
    RobotRunsLow,
    RobotSentAgain,
    RobotSilent,
    RobotStandsAside,
    RobotStuck,
    RobotSuspended,
    TrafficJam,
)
from muster.state.task_events import TaskRefused
from muster.state.task_ledger import Ledger

GIVES_UP_AFTER = 4
"""Times the limit of a jam after which one of its robots gives up its task."""
AGAIN_AFTER_S = 5.0
"""For so long a robot waits for one that is out, where another has given up their task for it."""
MOST_SENT_AGAIN = 4
"""So often a robot is sent again that does not take its orders."""
HOLDING_UP_SENT_AGAIN = 2
"""So often where others wait for it."""
LONGEST_ASIDE = 3
"""Times the first time that a robot stands aside at most."""


class Leader(Protocol):
    """Who leads robots through traffic, and what of them it knows."""

    def reaches(self, robot: str, places: Sequence[Place]) -> list[bool]:
        """To which places a robot, by its name, can get past those that stand for good, for all that is known."""
        ...

    def makes_no_room(self, robot: str) -> bool:
        """Whether a robot that has nothing to do was told several times to make room, and has not moved."""
        ...

    def moved(self, robot: str) -> None:
        """Somebody has put a robot, by its name, where it now says that it is."""
        ...


class NoLeader:
    """Nobody is known to be cut off, or told to make room."""

    def moved(self, robot: str) -> None:
        """See `Leader`."""

    def reaches(self, robot: str, places: Sequence[Place]) -> list[bool]:
        """See `Leader`."""
        return [True for _ in places]

    def makes_no_room(self, robot: str) -> bool:
        """See `Leader`."""
        return False


@dataclass
class Supervisor:
    """Notices missed telemetry, way points refused, waiting in traffic, jams, no progress, and too little capacity.

    Parameters
    ----------
    crew, ledger, dispatch, changes, traffic
        of the executor.
    capacity
        how much a robot can use; None: any amount.
    limits
        how long what may last.
    emit, ask
        receive every event that asks for no new plan; and those that ask for one.
    look_s
        when the next look is due.
    leader
        who leads robots through traffic.
    """

    crew: Mapping[str, RobotState]
    ledger: Ledger
    dispatch: Dispatch
    changes: Changes
    traffic: TrafficWaits
    capacity: Callable[[RobotState], float | None]
    limits: Limits
    emit: Tell
    ask: Tell
    look_s: float
    leader: Leader
    standstill: Standstill = field(default_factory=Standstill)

    def look(self, now: float) -> None:
        """Check all robots that take part, if that is due."""
        if now < self.look_s:
            return
        self.look_s = now + self.limits.look_every_s
        self._look_at_traffic(now)
        self._break_jams(now)
        self._break_standstill(now)
        for state in self._present:
            if state.refused and state.activity in MOVING:
                self._give_up(state, state.refused, now)
            elif state.suspended:
                self.changes.exclude(state, RobotSuspended, now, state.suspended)
            elif is_silent(state, now, self.limits):
                self.changes.exclude(state, RobotSilent, now)
            elif (broken := self._broken_before(state)) is not None:
                self._give_way_to_broken(state, broken, now)
            elif state.activity is Activity.IDLE and self.leader.makes_no_room(state.robot.id):
                self.changes.exclude(state, RobotStuck, now, "makes no room for others")
            elif is_stuck(state, now, self.limits):
                self._free_or_put_out(state, now)
            elif state.activity is Activity.DRIVING and self.capacity(state) is not None:
                self._notice_capacity(state, now)

    def pass_over(self, now: float) -> None:
        """Leave a pause that ends now out of all that is counted."""
        self.standstill.since_s = now
        self.traffic.pass_over(now)

    def _look_at_traffic(self, now: float) -> None:
        """Who waits for another, or was sent another way, is not stuck for coming no nearer.

        Work that takes far too long is told whatever traffic plans.
        """
        for event in self.traffic.look(now):
            self.emit(event)
        for robot in self.traffic.waits:
            self.crew[robot].nearest_s = now
        for state in (self.crew[robot] for robot in self.traffic.sent_round):
            if state.activity is not Activity.WORKING:
                state.nearest_m, state.nearest_s = state.way_left_m, now

    @property
    def _present(self) -> list[RobotState]:
        return [state for state in self.crew.values() if not state.out]

    def _free_or_put_out(self, state: RobotState, now: float) -> None:
        """A robot without progress is sent again, and excluded the next time; not if a failed robot blocks it.

        One under way that has not taken its last order is sent again a few times more: it may take the next one.
        """
        takes = state.takes_orders or state.activity is Activity.WORKING
        broken = [other for other in self.crew.values() if other.out]
        blocking = next((one for one in broken if stands_in_the_way(one, state.robot, state.points_left)), None)
        if blocking is not None and takes:
            self._give_way_to_broken(state, blocking, now)
        elif state.sent_again >= (1 if takes else self._most_sent_again(state)):
            self.changes.exclude(state, RobotStuck, now, "no progress with nobody in its way")
        else:
            self.emit(RobotSentAgain(robot=state.robot.id, reason="no progress"))
            self.dispatch.again(state, now)

    def _most_sent_again(self, state: RobotState) -> int:
        waited_for = any(self.traffic.waits_for(robot) == state.robot.id for robot in self.traffic.waits)
        return HOLDING_UP_SENT_AGAIN if waited_for else MOST_SENT_AGAIN

    def _broken_before(self, state: RobotState) -> RobotState | None:
        """The robot that is out for which another has waited too long."""
        other = self.crew.get(self.traffic.waits_for(state.robot.id))
        if other is None or not other.out:
            return None
        known = bool(state.route) and self.ledger.blocked_by.get(state.route[0]) == other.robot.id
        least_s = AGAIN_AFTER_S if known else self.limits.stuck_after_s
        return other if self.traffic.progress[state.robot.id].behind_s.get(other.robot.id, 0.0) > least_s else None

    def _give_way_to_broken(self, state: RobotState, broken: RobotState, now: float) -> None:
        """Where there is no way round it a robot ends here or gives up its task; traffic leads those that it steers."""
        if self._goes_round(state, broken, now):
            return
        if state.steered and self.leader.reaches(state.robot.id, [state.next_stop])[0]:
            self._give_up(state, f"jam: held up by {broken.robot.id}, out", now)
        elif state.activity is Activity.RETURNING:
            self.dispatch.end_here(state, now)
        elif state.activity is Activity.TO_STATION:
            self.dispatch.leave_station(state, f"unreachable: {broken.robot.id} stands there, out", now)
        else:
            self._give_up_blocked(state, broken, now)

    def _break_jams(self, now: float) -> None:
        """In a jam one robot after the other stands aside; a long one is told; at last a robot gives up its task."""
        for jam in self.traffic.jams():
            members = self.traffic.members(jam)
            lasted_s, held_s = (min(getattr(one, key) for one in members) for key in ("jammed_s", "held_s"))
            if lasted_s >= self.limits.jam_after_s and not all(one.told for one in members):
                self._tell_jam(jam, members, now - lasted_s)
            if self._steered(members):  # who steers them lets them pass
                continue
            if lasted_s >= self._longest_jam_s:
                for one in members:
                    one.jammed_s = self.limits.jam_after_s
                self._give_up_in_jam(self._first_to_yield(members), jam, now)
            elif not self._is_ring(jam):
                if lasted_s >= self.limits.jam_after_s:
                    self._lead_round(jam, now)
            elif held_s >= self._turn(jam, members) * self.limits.aside_after_s:
                for one in members:
                    one.held_s = 0.0
                self._let_stand_aside(self._first_to_yield(members), now)

    def _lead_round(self, jam: Collection[str], now: float) -> None:
        """Those who wait for one that has nothing to do go round it where they can; else it is sent off their way."""
        for robot in sorted(jam & self.traffic.waits.keys()):
            state, other = self.crew[robot], self.crew.get(self.traffic.waits_for(robot))
            if other is None or other.activity is not Activity.IDLE or self._goes_round(state, other, now):
                continue
            if not (state.steered or other.steered):
                self.dispatch.make_room(other, state, now)

    def _goes_round(self, state: RobotState, standing: RobotState, now: float) -> bool:
        """Send a robot that nobody steers round one that stands; returns whether it has a way that it has not tried."""
        if state.steered or not self.dispatch.go_round(state, standing, now):
            return False
        self.traffic.progress[state.robot.id].goes_round(state.way_left_m)
        return True

    def _break_standstill(self, now: float) -> None:
        """Where robots that traffic leads have not got on for as long as a jam may last one of them gives up."""
        self.standstill.look(self.crew.values(), now)
        under_way = [one for one in self._present if one.steered and one.activity in MOVING]
        if not under_way or now - self.standstill.since_s < self._longest_jam_s:
            return
        self.standstill.since_s = now
        state = self._first_to_yield([self.traffic.progress[one.robot.id] for one in under_way])
        self._give_up(state, f"jam: nobody has got on for {self._longest_jam_s:g} s", now)

    @property
    def _longest_jam_s(self) -> float:
        return GIVES_UP_AFTER * self.limits.jam_after_s

    def _is_ring(self, jam: Collection[str]) -> bool:
        """Whether all of a jam want to get on, as far as is known; else one that stands is to make room."""
        return all(robot in self.traffic.waits or robot not in self.crew for robot in jam)

    def _steered(self, members: Sequence[Progress]) -> bool:
        """Whether traffic decides who passes first of these robots.

        That one waits for another says the collision avoidance of a robot by itself, too.
        """
        return any(self.crew[one.robot].steered for one in members)

    def _turn(self, jam: Collection[str], members: Sequence[Progress]) -> int:
        """Which of a jam is the next to stand aside, from 1, as far as its robots do not know of each other.

        Of robots of another crew nothing is known: those that see each other alone take turns by their ids.
        """
        strangers = [robot for robot in jam if robot not in self.crew]
        return 1 + sum(robot < members[0].robot for robot in strangers)

    def _first_to_yield(self, members: Sequence[Progress]) -> RobotState:
        """Who stands aside next: by turns, first who has no task there, then by priority."""

        def rank(one: Progress) -> tuple[int, bool, float, str]:
            state = self.crew[one.robot]
            return one.asides, state.activity is not Activity.RETURNING, state.robot.avoidance_priority, one.robot

        return self.crew[min(members, key=rank).robot]

    def _tell_jam(self, jam: frozenset[str], members: Sequence[Progress], since_s: float) -> None:
        for robot in jam & self.traffic.progress.keys():
            self.traffic.progress[robot].told = True
        place = plain_place(self.crew[members[0].robot].position)
        self.emit(TrafficJam(robots=tuple(sorted(jam)), position=place, since_s=since_s))

    def _let_stand_aside(self, state: RobotState, now: float) -> None:
        """Longer each time; work is not broken off for that."""
        robot = state.robot.id
        progress = self.traffic.progress[robot]
        progress.asides += 1
        if state.activity is not Activity.WORKING:
            self.emit(RobotStandsAside(robot=robot, waits_for=self.traffic.waits[robot].waits_for))
            aside_s = min(progress.asides, LONGEST_ASIDE) * self.limits.aside_s
            self.dispatch.stand_aside(state, now + aside_s, now)

    def _give_up_in_jam(self, state: RobotState, jam: Collection[str], now: float) -> None:
        others = ", ".join(robot for robot in sorted(jam) if robot != state.robot.id)
        self._give_up(state, f"jam: held up by {others} for {self._longest_jam_s:g} s", now)

    def _give_up(self, state: RobotState, reason: str, now: float) -> None:
        """A robot does not get to its way point: other robots do the task, or it ends where it is."""
        if state.activity is Activity.RETURNING:
            self.dispatch.end_here(state, now)
        elif state.activity is Activity.TO_STATION:
            self.dispatch.leave_station(state, reason, now)
        else:
            self.dispatch.refuse(state, state.route[0], reason, now)

    def _give_up_blocked(self, state: RobotState, blocking: RobotState, now: float) -> None:
        """A failed robot stands in the way to a task: others that have no way to it, or to others, get none either."""
        task, reason = state.route[0], f"unreachable: {blocking.robot.id} stands there, out"
        others: dict[str, list[str]] = {}
        for other in self._present:
            able = set(self.ledger.tasks[task].requires) <= set(other.robot.skills)
            if other is not state and able and stands_in_the_way(blocking, other.robot, state.places_of_work):
                others.setdefault(task, []).append(other.robot.id)
        for other in self._present:
            for cut_off in self._cut_off(other, [task] if other.robot.id in others.get(task, ()) else []):
                others.setdefault(cut_off, []).append(other.robot.id)
        refused = TaskRefused(
            task=task,
            robot=state.robot.id,
            reason=reason,
            blocked_by=blocking.robot.id,
            others={name: tuple(robots) for name, robots in others.items()},
        )
        self.dispatch.leave(state, refused, now)

    def _cut_off(self, state: RobotState, refused: Collection[str]) -> list[str]:
        """The tasks to which traffic knows no way for a robot, but for those that it has refused, or does now."""
        robot, refusals = state.robot.id, self.ledger.refusals
        open_tasks = [task for task in self.ledger.open if task.id not in refused]
        known = [task for task in open_tasks if robot not in refusals.get(task.id, {})]
        places = [place(task.position if task.entry is None else task.entry) for task in known]
        reached = self.leader.reaches(robot, places)
        cut_off = [task.id for task, is_reached in zip(known, reached, strict=True) if not is_reached]
        return [task for task in cut_off if state.route[:1] != [task]]

    def _notice_capacity(self, state: RobotState, now: float) -> None:
        """The capacity of a robot is too small for its current task, or for the rest of its route."""
        task, capacity, after = state.route[0], self.capacity(state), state.used_after(now)
        if exceeds(after + state.home_usage, capacity):
            reason = f"capacity: {after + state.home_usage:.2f} used with it, of {capacity:.2f}"
            self.dispatch.refuse(state, task, reason, now)
        elif state.warned_of != task and exceeds(after + self.dispatch.ahead[state.robot.id].get(task, 0.0), capacity):
            state.warned_of = task
            self.ask(RobotRunsLow(robot=state.robot.id, capacity=capacity))
