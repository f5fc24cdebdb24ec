"""A forecast of when tasks begin: the earliest schedule of the routes as they are, from where the robots are now."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.task_motion import MotionPlanner, Way, Work, travel_s, work_of
from muster.mission.system.clock import TIME_ROUNDING_S
from muster.model.schedule import Course, Schedule
from muster.motion.actions import Impossible
from muster.motion.port import Place
from muster.state.task_ledger import Ledger

_MARGIN = 0.1  # share of the time until a dependant's robot arrives, by which that may be late; and of a longest duty


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
        schedule = self._schedule(now, margin)
        return schedule.begins_s if schedule.settle() else None

    def hold_until_s(self, task: str, now: float) -> float:
        """When a task should begin so that its dependants can begin in time after it; `now` if it need not wait."""
        if not self.ledger.must_be_followed(task):
            return now
        found = (self.begins(now, margin) for margin in (_MARGIN, 0.0))
        return next((begins[task] for begins in found if begins is not None and task in begins), now)

    def leaves_s(self, state: RobotState, now: float) -> float:
        """When a robot leaves its start for a duty that is short enough; by a margin, if nothing is later so."""
        found = [self._schedule(now, margin) for margin in (0.0, _MARGIN)]
        just, early = (schedule if schedule.settle() else None for schedule in found)
        if just is None:
            return now
        name = state.robot.id
        no_later = early is not None and early.over_s[name] <= just.over_s[name] + TIME_ROUNDING_S
        return (early if early is not None and no_later else just).leaves_s.get(name, now)

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
            self._legs_s[key] = travel_s(state.times, start, points)
        return self._legs_s[key]

    def between_s(self, state: RobotState, first: str, last: str) -> float:
        """The least seconds from the end of a task of a robot's route to the begin of a later one, travel and work."""
        work, seconds = self.work(state, first), 0.0
        for name in state.route[state.route.index(first) + 1 : state.route.index(last) + 1]:
            seconds += 0.0 if work is None else self.leg_s(state, work.exit, name)
            seconds += self.lasts_s(state, name) if name != last else 0.0
            work = self.work(state, name) or work
        return seconds

    def home_s(self, state: RobotState, start: Place) -> float:
        """Seconds from a place to where the robot's route ends."""
        if state.home is None:
            return 0.0
        points = self.way(state.robot, start, state.home) or ()
        return travel_s(state.times, start, points)

    def _schedule(self, now: float, margin: float) -> Schedule:
        present = [state for state in self.crew.values() if not state.out]
        ends_s, lasts_s = dict(self.ledger.ends_s), dict[str, float]()
        for state in present:
            if state.activity is Activity.WORKING:
                ends_s.setdefault(state.route[0], now + state.work_left_s(now))
            for name in _not_begun(state):
                lasts_s[name] = max(lasts_s.get(name, 0.0), self.lasts_s(state, name))
        courses = [self._course(state, now) for state in present]
        return Schedule(self.ledger.model, courses, lasts_s, ends_s, now, margin)

    def _course(self, state: RobotState, now: float) -> Course:
        busy_s = state.work_left_s(now) if state.activity is Activity.WORKING else 0.0
        free_s = max(now + busy_s, state.robot.available_from_s)
        legs, last = self._legs_of(state)
        return Course(
            free_s,
            _not_begun(state),
            legs,
            robot=state.robot.id,
            limits=state.limits,
            is_under_way=state.activity in (Activity.DRIVING, Activity.WAITING),
            home_s=self.home_s(state, last),
            has_left=state.known.left_s is not None,
        )

    def _legs_of(self, state: RobotState) -> tuple[Sequence[float], Place]:
        """Seconds to each task ahead, from the one before it; and where the last one ends."""
        works = state.activity is Activity.WORKING and state.work is not None
        place = state.work.exit if works and state.work is not None else state.position
        legs = []
        for k, name in enumerate(_not_begun(state)):
            if k == 0 and state.activity is Activity.WAITING:
                legs.append(0.0)
            elif k == 0 and state.activity is Activity.DRIVING:
                legs.append(state.travel_left_s)
            else:
                legs.append(self.leg_s(state, place, name))
            work = self.work(state, name)
            place = place if work is None else work.exit
        return legs, place


def _not_begun(state: RobotState) -> list[str]:
    return state.route[1:] if state.activity is Activity.WORKING else list(state.route)
