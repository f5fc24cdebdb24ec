"""A forecast of when tasks begin: the earliest schedule of the routes as they are, from where the robots are now.

The least fixpoint of all lower bounds: arrivals, prerequisites with lags, windows, teams. A task that another must
follow within some time begins so late that this is possible.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.task_motion import MotionPlanner, Way, Work, travel_s, work_of
from muster.execution.timing.beginning import next_begin
from muster.execution.timing.duty import back_s
from muster.motion.actions import Impossible
from muster.motion.port import Place, Waypoint
from muster.state.task_ledger import Ledger

_MARGIN = 0.1  # share of the time until a dependant's robot arrives, by which that may be late; and of a longest duty
_SETTLED_S = 1e-6


@dataclass
class Forecast:
    """Forecasts by the ways and works of robots, each of which is looked up once.

    Parameters
    ----------
    ledger, crew
        of the executor.
    plan_motion, way
        as of `Executor`.
    """

    ledger: Ledger
    crew: Mapping[str, RobotState]
    plan_motion: MotionPlanner
    way: Way
    _works: dict[tuple[str, str, Place | tuple[float, ...]], Work | None] = field(default_factory=dict)
    _legs_s: dict[tuple[str, Place, Place], float] = field(default_factory=dict)

    def forget(self) -> None:
        """Forget ways and works that were looked up: most were of tasks that are done."""
        self._works.clear()
        self._legs_s.clear()

    def begins(self, now: float, margin: float = 0.0) -> dict[str, float] | None:
        """When each task of the routes that has not begun begins; None if the routes have no schedule."""
        times = _Times(self, now, margin)
        return times.begins if times.settle() else None

    def hold_until_s(self, task: str, now: float) -> float:
        """When a task should begin so that its dependants can begin in time after it; `now` if it need not wait."""
        if not self.ledger.has_within(task):
            return now
        found = (self.begins(now, margin) for margin in (_MARGIN, 0.0))
        return next((begins[task] for begins in found if begins is not None and task in begins), now)

    def leaves_s(self, state: RobotState, now: float) -> float:
        """When a robot leaves its start for a duty that is short enough; by a margin, if nothing is later so."""
        found = [_Times(self, now, margin) for margin in (0.0, _MARGIN)]
        just, early = (times if times.settle() else None for times in found)
        if just is None:
            return now
        name = state.robot.id
        no_later = early is not None and early.over[name] <= just.over[name] + _SETTLED_S
        return (early if early is not None and no_later else just).leaves[name]

    def work(self, state: RobotState, task: str) -> Work | None:
        """How a robot does a task; None if it cannot."""
        what = self.ledger.tasks[task]
        key = (state.robot.id, task, what.position)
        if key not in self._works:
            work = work_of(what, state.robot, self.plan_motion, self.way, state.times)
            self._works[key] = None if isinstance(work, Impossible) else work
        return self._works[key]

    def lasts_s(self, state: RobotState, task: str) -> float:
        work = self.work(state, task)
        return 0.0 if work is None else work.lasts_s + self.ledger.delays_s.get(task, 0.0)

    def leg_s(self, state: RobotState, start: Place, task: str) -> float:
        """Seconds from a place to where a robot enters a task."""
        work = self.work(state, task)
        if work is None:
            return 0.0
        key = (state.robot.id, start, work.entry)
        if key not in self._legs_s:
            points = self.way(state.robot, start, work.entry) or ()
            self._legs_s[key] = travel_s(state.times, start, [Waypoint(point) for point in points])
        return self._legs_s[key]

    def home_s(self, state: RobotState, start: Place) -> float:
        """Seconds from a place to where the robot's route ends."""
        if state.home is None:
            return 0.0
        points = self.way(state.robot, start, state.home) or ()
        return travel_s(state.times, start, [Waypoint(point) for point in points])


@dataclass
class _Times:
    """Lower bounds of the times at which tasks begin, raised until they fit together."""

    of: Forecast
    now: float
    margin: float
    begins: dict[str, float] = field(default_factory=dict)
    leaves: dict[str, float] = field(default_factory=dict)  # by robot that has yet to leave, and whose duty is limited
    over: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._ledger = self.of.ledger
        present = [state for state in self.of.crew.values() if not state.out]
        self._ahead = {state.robot.id: _not_begun(state) for state in present}
        self._present = present
        self._ends = dict(self._ledger.ends_s)
        for state in present:
            if state.activity is Activity.WORKING:
                self._ends.setdefault(state.route[0], self.now + state.work_left_s(self.now))
        names = list(dict.fromkeys(name for route in self._ahead.values() for name in route))
        self.begins = dict.fromkeys(names, self.now)
        self._arrives = dict(self.begins)
        self._lasts = {
            name: max(self.of.lasts_s(state, name) for state in present if name in self._ahead[state.robot.id])
            for name in names
        }
        self._last: dict[str, Place] = {}  # by robot where its last task ends
        self._legs = {state.robot.id: list(self._legs_of(state)) for state in present}
        waiting = [s for s in present if s.robot.longest_duty_s is not None and s.known.left_s is None]
        self.leaves = {state.robot.id: self._free_s(state) for state in waiting}
        self._homes = {s.robot.id: self.of.home_s(s, self._last[s.robot.id]) for s in waiting}
        self.over = dict(self.leaves)
        self._raised = False

    def settle(self) -> bool:
        """Raise bounds until none changes; False if they never fit together."""
        for _ in range(2 * len(self.begins) + 2 * len(self.leaves) + 4):
            self._raised = False
            for state in self._present:
                self._follow(state)
            for name in self.begins:
                self._wait(name)
            for name in self.begins:
                self._hold_prerequisites(name)
            if not self._raised:
                return True
        return False

    def _raise(self, name: str, to: float) -> None:
        if self.begins[name] + _SETTLED_S < to < math.inf:
            self.begins[name] = to
            self._raised = True

    def _follow(self, state: RobotState) -> None:
        """The robot arrives at one task after the other."""
        robot = state.robot
        leaves = self.leaves.get(robot.id, self._free_s(state))
        under_way = state.activity in (Activity.DRIVING, Activity.WAITING)
        for k, (name, leg) in enumerate(zip(self._ahead[robot.id], self._legs[robot.id], strict=True)):
            arrives = leaves + leg if k == 0 and under_way else robot.set_out(leaves, leg) + leg
            self._arrives[name] = max(self._arrives[name], arrives)
            self._raise(name, arrives)
            leaves = self.begins[name] + self._lasts[name]
        if robot.longest_duty_s is not None and robot.id in self.leaves:
            self.over[robot.id] = back_s(state, leaves, self._homes[robot.id])
            self._leave(robot.id, self.over[robot.id] - (1 - self.margin) * robot.longest_duty_s)

    def _leave(self, robot: str, at: float) -> None:
        if self.leaves[robot] + _SETTLED_S < at < math.inf:
            self.leaves[robot] = at
            self._raised = True

    def _wait(self, name: str) -> None:
        """Prerequisites have ended, windows are open, and tasks that begin with it begin too."""
        for before in self._ledger.prerequisites(name):
            if before in self._ends or before in self.begins:
                self._raise(name, self._end(before) + self._ledger.tasks[name].lag(before).after_s)
        unit = self._ledger.unit(name)
        together = max(self.begins.get(other, self.now) for other in unit)
        begin = next_begin([self._ledger.tasks[other] for other in unit], together)
        for state in self._present:
            if state.robot.shifts_s and name in self._ahead[state.robot.id]:
                begin = state.robot.set_out(begin, self._lasts[name])
        self._raise(name, begin)

    def _hold_prerequisites(self, name: str) -> None:
        """Prerequisites begin so late that this task can begin in time after them."""
        for before, lag in self._ledger.tasks[name].lags.items():
            if lag.within_s is not None and before in self.begins:
                late = min(self.margin * (self._arrives[name] - self.now), (lag.within_s - lag.after_s) / 2)
                self._raise(before, self.begins[name] + late - lag.within_s - self._lasts[before])

    def _end(self, name: str) -> float:
        return self._ends[name] if name in self._ends else self.begins[name] + self._lasts[name]

    def _free_s(self, state: RobotState) -> float:
        busy = state.work_left_s(self.now) if state.activity is Activity.WORKING else 0.0
        return max(self.now + busy, state.robot.available_from_s)

    def _legs_of(self, state: RobotState) -> Sequence[float]:
        """Seconds to each task ahead, from the one before it."""
        works = state.activity is Activity.WORKING and state.work is not None
        place = state.work.exit if works and state.work is not None else state.position
        legs = []
        for k, name in enumerate(self._ahead[state.robot.id]):
            if k == 0 and state.activity is Activity.WAITING:
                legs.append(0.0)
            elif k == 0 and state.activity is Activity.DRIVING:
                legs.append(state.travel_left_s)
            else:
                legs.append(self.of.leg_s(state, place, name))
            work = self.of.work(state, name)
            place = place if work is None else work.exit
        self._last[state.robot.id] = place
        return legs


def _not_begun(state: RobotState) -> list[str]:
    return state.route[1:] if state.activity is Activity.WORKING else list(state.route)
