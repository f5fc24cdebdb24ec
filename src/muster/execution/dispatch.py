"""Dispatch: sends each robot to its next task, to its work and to its end, and tracks its progress."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from muster.execution.changes import Change
from muster.execution.monitor import exceeds
from muster.execution.robot_state import Activity, RobotState
from muster.execution.task_ledger import Ledger
from muster.execution.task_motion import MotionPlanner, Way, Work, path_length, work_of
from muster.motion.actions import Impossible
from muster.motion.port import Place, Waypoint

Emit = Callable[[str, Mapping[str, Any]], None]


class Dispatch:
    """Sends robots to their next task, one robot a call.

    Parameters
    ----------
    ledger
        of the tasks.
    capacity
        how much a robot can use; None: any amount.
    plan_motion, way
        what a task makes a robot do, and how it gets there.
    emit
        receives every event.
    leave
        whether a robot that is at a task may begin it, where others have a say: then it stops there and asks; None: the
        ledger alone says so.
    """

    def __init__(
        self,
        ledger: Ledger,
        capacity: Callable[[RobotState], float | None],
        plan_motion: MotionPlanner,
        way: Way,
        emit: Emit,
        leave: Callable[[str], bool] | None = None,
    ) -> None:
        self._ledger = ledger
        self._capacity = capacity
        self._plan_motion = plan_motion
        self._way = way
        self._emit = emit
        self._leave = leave
        self.ahead: Mapping[str, Mapping[str, float]] = {}  # by the plan in force: see `Revision`

    def advance(self, state: RobotState, now: float) -> None:
        """Check whether a robot has arrived, or ended its work."""
        if state.activity is Activity.DRIVING and state.passed >= state.to_task:
            self._arrive(state, now)
        if state.activity is Activity.WORKING and state.arrived:
            self._end_work(state, now)
        if state.activity is Activity.RETURNING and state.arrived:
            state.at_home, state.stuck_before = True, False
            state.begin_activity(now, Activity.IDLE)
            self._emit("robot_at_end", {"robot": state.robot.id})

    def send_on(self, state: RobotState, now: float) -> Iterator[Change]:
        """Send a robot on that is available, or may begin; yields a change that requires a new plan if it cannot."""
        if state.activity is Activity.WAITING:
            if self._ledger.may_begin(state.route[0]) and (self._leave is None or self._leave(state.route[0])):
                self._work(state, now)
        elif state.available and state.route and now >= state.robot.available_from_s:
            yield from self._to_task(state, state.route[0], now)
        elif self.goes_home(state) and state.home is not None:
            way = self.way(state, state.home)
            if way is None:
                self.end_here(state, now)
            else:
                state.send(now, Activity.RETURNING, [Waypoint(point) for point in way])
                self._emit("returns", {"robot": state.robot.id})

    def goes_home(self, state: RobotState) -> bool:
        """Whether a robot without tasks has yet to go where its route ends."""
        return state.activity is Activity.IDLE and not state.route and not state.at_home and state.home is not None

    def end_here(self, state: RobotState, now: float) -> None:
        """A robot cannot get to where its route ends."""
        if state.activity is Activity.RETURNING:
            state.stop(now)
        state.at_home = True
        self._emit("no_way_to_end", {"robot": state.robot.id})

    def again(self, state: RobotState, now: float) -> None:
        """Send a robot without progress once more, by a new path if it drives."""
        state.stuck_before = True
        if state.activity is Activity.WORKING:
            state.send_again(now)
        else:
            state.stop(now)

    def take_route(self, state: RobotState, tasks: Sequence[str], now: float) -> None:
        """Give a robot another route; it goes on with its work, and with its path if that leads to the same task."""
        if state.activity is Activity.WORKING:
            state.route = [state.route[0], *tasks]
            return
        kept = state.route[:1] == list(tasks[:1])
        if state.activity in (Activity.DRIVING, Activity.WAITING) and not kept:
            self._ledger.give_up(state.route[0])
            state.stop(now)
        state.route = list(tasks)
        state.warned_of = state.warned_of if kept else ""

    def refuse(self, state: RobotState, task: str, reason: str, now: float) -> Iterator[Change]:
        """A robot cannot do a task of its route: it is never given it again."""
        self._ledger.refuse(task, state.robot.id, reason)
        self._ledger.give_up(task)
        if state.activity is not Activity.IDLE:
            state.stop(now)
        yield Change("task_refused", {"task": task, "robot": state.robot.id, "reason": reason})

    def way(self, state: RobotState, goal: Place) -> Sequence[Place] | None:
        """The way from where a robot is; by way of the last place known to be free, if it stands where it cannot."""
        found = self._way(state.robot, state.position, goal)
        if found is not None:
            return found
        onward = self._way(state.robot, state.refuge, goal)
        return None if onward is None else [state.refuge, *onward]

    def _to_task(self, state: RobotState, task: str, now: float) -> Iterator[Change]:
        work = work_of(self._ledger.tasks[task], state.robot, self._plan_motion, self._way)
        if isinstance(work, Impossible):
            yield from self.refuse(state, task, work.reason, now)
            return
        way = self.way(state, work.entry)
        home = self._home_usage(state, work)
        if way is None or home is None:
            yield from self.refuse(state, task, "unreachable: there is no way", now)
            return
        there = [Waypoint(point, label=task) for point in way]
        delay = self._ledger.delays_s.get(task, 0.0)
        lasts = work.lasts_s + delay
        least = _least_usage(state, work, there, lasts) + home
        if exceeds(least, self._capacity(state)):
            yield from self.refuse(
                state, task, f"capacity: {least:.2f} used with it, of {self._capacity(state):.2f}", now
            )
            return
        state.work, state.work_s, state.delay_s, state.home_usage = work, lasts, delay, home
        state.to_task, state.works = len(there), self._leave is None and self._ledger.may_begin(task)
        state.at_home = False
        state.usage_to_task = state.used - state.used_before + self._planned_usage(state, task)
        state.send(now, Activity.DRIVING, [*there, *(_delayed(work, delay) if state.works else ())])
        self._emit("sets_out", {"robot": state.robot.id, "task": task})

    def _arrive(self, state: RobotState, now: float) -> None:
        task = state.route[0]
        self._ledger.arrive(task, state.used, now)
        state.stuck_before = False
        self._emit("arrives", {"robot": state.robot.id, "task": task})
        if state.works:
            self._begin(state, task, now)
            state.begin_activity(now, Activity.WORKING)
        else:
            state.begin_activity(now, Activity.WAITING)

    def _work(self, state: RobotState, now: float) -> None:
        task = state.route[0]
        if state.work is not None:
            state.delay_s, before = self._ledger.delays_s.get(task, 0.0), state.delay_s
            state.work_s += state.delay_s - before
            state.works = True
            self._begin(state, task, now)
            state.send(now, Activity.WORKING, _delayed(state.work, state.delay_s))

    def _begin(self, state: RobotState, task: str, now: float) -> None:
        self._ledger.begin(task, now)
        self._emit("starts", {"task": task, "robot": state.robot.id})

    def _end_work(self, state: RobotState, now: float) -> None:
        """The work has ended, unless it was delayed meanwhile: then the robot stays for that."""
        task = state.route[0]
        longer = self._ledger.delays_s.get(task, 0.0) - state.delay_s
        if longer > 0 and state.work is not None:
            begun = state.begun_s
            state.delay_s += longer
            state.work_s += longer
            state.send(now, Activity.WORKING, [replace(state.work.waypoints[-1], hold_s=longer)])
            state.begun_s = begun
            return
        state.charge_work()
        self._ledger.end(task, state.robot.id, now)
        self._ledger.usage[task] = state.usage_to_task, state.used - state.used_before
        state.used_before = state.used
        state.route.pop(0)
        state.done.append(task)
        state.begin_activity(now, Activity.IDLE)
        self._emit("ends", {"task": task, "robot": state.robot.id})

    def _planned_usage(self, state: RobotState, task: str) -> float:
        """What a task costs by the plan in force, from the task before it or from where that plan was made."""
        ahead = self.ahead.get(state.robot.id, {})
        before = state.done[-1] if state.done and state.done[-1] in ahead else ""
        return ahead.get(before, 0.0) - ahead.get(task, 0.0)

    def _home_usage(self, state: RobotState, work: Work) -> float | None:
        """Usage from the exit of a task to where the route ends; None where there is no way."""
        if state.home is None:
            return 0.0
        way = self._way(state.robot, work.exit, state.home)
        if way is None:
            return None
        metres = path_length(work.exit, [Waypoint(point) for point in way])
        return metres / state.robot.speed_mps if state.in_time else metres


def _delayed(work: Work, by_s: float) -> list[Waypoint]:
    """The way points of work that takes so much longer: the robot stays in the last."""
    *before, last = work.waypoints
    return [*before, replace(last, hold_s=last.hold_s + by_s)]


def _least_usage(state: RobotState, work: Work, there: Sequence[Waypoint], lasts_s: float) -> float:
    """Usage when a task is done, if nothing comes in the way, in the mission's unit."""
    metres = path_length(state.position, there)
    if state.in_time:
        return state.used + metres / state.robot.speed_mps + lasts_s
    return state.used + metres + max(work.cost_m, work.way_m)
