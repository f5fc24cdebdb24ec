"""Dispatch: sends each robot to its next task, to its work and to its end, and sees how far it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from muster.execution.changes import Change
from muster.execution.monitor import exceeds
from muster.execution.robot_state import Activity, Hand
from muster.execution.task_ledger import Ledger
from muster.execution.task_motion import Doer, Way, Work, path_length, work_of
from muster.motion.actions import Impossible
from muster.motion.port import Place, Waypoint

Tell = Callable[[str, Mapping[str, Any]], None]


class Dispatch:
    """Sends robots of a crew on, one at a time.

    Parameters
    ----------
    ledger
        of the tasks.
    capacity
        how much a robot can use; None: any amount.
    doing, way
        what a task makes a robot do, and how it gets there.
    tell
        is told what happens.
    leave
        whether a robot that is at a task may begin it, where others have a say: then it stops there and asks; None: the
        ledger alone says so.
    """

    def __init__(
        self,
        ledger: Ledger,
        capacity: Callable[[Hand], float | None],
        doing: Doer,
        way: Way,
        tell: Tell,
        leave: Callable[[str], bool] | None = None,
    ) -> None:
        self._ledger = ledger
        self._capacity = capacity
        self._doing = doing
        self._way = way
        self._tell = tell
        self._leave = leave
        self.ahead: Mapping[str, Mapping[str, float]] = {}  # by the plan in force: see `Revision`

    def advance(self, hand: Hand, now: float) -> None:
        """See whether a robot has arrived, or ended its work."""
        if hand.activity is Activity.DRIVING and hand.passed >= hand.to_task:
            self._arrive(hand, now)
        if hand.activity is Activity.WORKING and hand.arrived:
            self._end_work(hand, now)
        if hand.activity is Activity.RETURNING and hand.arrived:
            hand.at_home, hand.stuck_before = True, False
            hand.turn_to(now, Activity.IDLE)
            self._tell("robot_at_end", {"robot": hand.robot.id})

    def send_on(self, hand: Hand, now: float) -> Iterator[Change]:
        """Send a robot on that is available, or may begin; yields why it cannot, which asks for a new plan."""
        if hand.activity is Activity.WAITING:
            if self._ledger.may_begin(hand.route[0]) and (self._leave is None or self._leave(hand.route[0])):
                self._work(hand, now)
        elif hand.available and hand.route and now >= hand.robot.available_from_s:
            yield from self._to_task(hand, hand.route[0], now)
        elif self.goes_home(hand) and hand.home is not None:
            way = self.way(hand, hand.home)
            if way is None:
                self.end_here(hand, now)
            else:
                hand.send(now, Activity.RETURNING, [Waypoint(point) for point in way])
                self._tell("returns", {"robot": hand.robot.id})

    def goes_home(self, hand: Hand) -> bool:
        """Whether a robot without tasks has yet to go where its route ends."""
        return hand.activity is Activity.IDLE and not hand.route and not hand.at_home and hand.home is not None

    def end_here(self, hand: Hand, now: float) -> None:
        """A robot cannot get to where its route ends."""
        if hand.activity is Activity.RETURNING:
            hand.stop(now)
        hand.at_home = True
        self._tell("no_way_to_end", {"robot": hand.robot.id})

    def again(self, hand: Hand, now: float) -> None:
        """Send a robot that does not get on once more, by a new way if it drives."""
        hand.stuck_before = True
        if hand.activity is Activity.WORKING:
            hand.send_again(now)
        else:
            hand.stop(now)

    def take_route(self, hand: Hand, tasks: Sequence[str], now: float) -> None:
        """Give a robot another route; it keeps on with work, and on its way if that is to the same task."""
        if hand.activity is Activity.WORKING:
            hand.route = [hand.route[0], *tasks]
            return
        kept = hand.route[:1] == list(tasks[:1])
        if hand.activity in (Activity.DRIVING, Activity.WAITING) and not kept:
            self._ledger.give_up(hand.route[0])
            hand.stop(now)
        hand.route = list(tasks)
        hand.warned_of = hand.warned_of if kept else ""

    def refuse(self, hand: Hand, task: str, reason: str, now: float) -> Iterator[Change]:
        """A robot cannot do a task of its route: it is never given it again."""
        self._ledger.refuse(task, hand.robot.id, reason)
        self._ledger.give_up(task)
        if hand.activity is not Activity.IDLE:
            hand.stop(now)
        yield Change("task_refused", {"task": task, "robot": hand.robot.id, "reason": reason})

    def way(self, hand: Hand, goal: Place) -> Sequence[Place] | None:
        """The way from where a robot is; by way of the last place known to be free, if it stands where it cannot."""
        found = self._way(hand.robot, hand.position, goal)
        if found is not None:
            return found
        onward = self._way(hand.robot, hand.refuge, goal)
        return None if onward is None else [hand.refuge, *onward]

    def _to_task(self, hand: Hand, task: str, now: float) -> Iterator[Change]:
        work = work_of(self._ledger.tasks[task], hand.robot, self._doing, self._way)
        if isinstance(work, Impossible):
            yield from self.refuse(hand, task, work.reason, now)
            return
        way = self.way(hand, work.entry)
        home = self._home_usage(hand, work)
        if way is None or home is None:
            yield from self.refuse(hand, task, "unreachable: there is no way", now)
            return
        there = [Waypoint(point, label=task) for point in way]
        delay = self._ledger.delays_s.get(task, 0.0)
        lasts = work.lasts_s + delay
        least = _least_usage(hand, work, there, lasts) + home
        if exceeds(least, self._capacity(hand)):
            yield from self.refuse(
                hand, task, f"capacity: {least:.2f} used with it, of {self._capacity(hand):.2f}", now
            )
            return
        hand.work, hand.work_s, hand.delay_s, hand.home_usage = work, lasts, delay, home
        hand.to_task, hand.works = len(there), self._leave is None and self._ledger.may_begin(task)
        hand.at_home = False
        hand.usage_to_task = hand.used - hand.used_before + self._planned_usage(hand, task)
        hand.send(now, Activity.DRIVING, [*there, *(_delayed(work, delay) if hand.works else ())])
        self._tell("sets_out", {"robot": hand.robot.id, "task": task})

    def _arrive(self, hand: Hand, now: float) -> None:
        task = hand.route[0]
        self._ledger.arrive(task, hand.used, now)
        hand.stuck_before = False
        self._tell("arrives", {"robot": hand.robot.id, "task": task})
        if hand.works:
            self._begin(hand, task, now)
            hand.turn_to(now, Activity.WORKING)
        else:
            hand.turn_to(now, Activity.WAITING)

    def _work(self, hand: Hand, now: float) -> None:
        task = hand.route[0]
        if hand.work is not None:
            hand.delay_s, before = self._ledger.delays_s.get(task, 0.0), hand.delay_s
            hand.work_s += hand.delay_s - before
            hand.works = True
            self._begin(hand, task, now)
            hand.send(now, Activity.WORKING, _delayed(hand.work, hand.delay_s))

    def _begin(self, hand: Hand, task: str, now: float) -> None:
        self._ledger.begin(task, now)
        self._tell("starts", {"task": task, "robot": hand.robot.id})

    def _end_work(self, hand: Hand, now: float) -> None:
        """The work has ended, unless it was delayed meanwhile: then the robot stays for that."""
        task = hand.route[0]
        longer = self._ledger.delays_s.get(task, 0.0) - hand.delay_s
        if longer > 0 and hand.work is not None:
            begun = hand.begun_s
            hand.delay_s += longer
            hand.work_s += longer
            hand.send(now, Activity.WORKING, [replace(hand.work.waypoints[-1], hold_s=longer)])
            hand.begun_s = begun
            return
        hand.charge_work()
        self._ledger.end(task, hand.robot.id, now)
        self._ledger.usage[task] = hand.usage_to_task, hand.used - hand.used_before
        hand.used_before = hand.used
        hand.route.pop(0)
        hand.done.append(task)
        hand.turn_to(now, Activity.IDLE)
        self._tell("ends", {"task": task, "robot": hand.robot.id})

    def _planned_usage(self, hand: Hand, task: str) -> float:
        """What a task costs by the plan in force, from the task before it or from where that plan was made."""
        ahead = self.ahead.get(hand.robot.id, {})
        before = hand.done[-1] if hand.done and hand.done[-1] in ahead else ""
        return ahead.get(before, 0.0) - ahead.get(task, 0.0)

    def _home_usage(self, hand: Hand, work: Work) -> float | None:
        """Usage from the exit of a task to where the route ends; None where there is no way."""
        if hand.home is None:
            return 0.0
        way = self._way(hand.robot, work.exit, hand.home)
        if way is None:
            return None
        metres = path_length(work.exit, [Waypoint(point) for point in way])
        return metres / hand.robot.speed_mps if hand.in_time else metres


def _delayed(work: Work, by_s: float) -> list[Waypoint]:
    """The way points of work that takes so much longer: the robot stays in the last."""
    *before, last = work.waypoints
    return [*before, replace(last, hold_s=last.hold_s + by_s)]


def _least_usage(hand: Hand, work: Work, there: Sequence[Waypoint], lasts_s: float) -> float:
    """Usage when a task is done, if nothing comes in the way, in the mission's unit."""
    metres = path_length(hand.position, there)
    if hand.in_time:
        return hand.used + metres / hand.robot.speed_mps + lasts_s
    return hand.used + metres + max(work.cost_m, work.way_m)
