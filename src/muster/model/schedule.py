"""The earliest schedule of routes of a mission under way: the least fixpoint of all lower bounds of begins.

Robots arrive one task after the other, tasks wait for those before them, begin in their openings, and together where
they are one unit. A task after which another must begin within some time begins so late that this is possible.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from muster.model.robot_limits import NO_LIMITS, RobotLimits
from muster.model.under_way import UnderWay

_SETTLED_S = 1e-6


@dataclass(frozen=True)
class Course:
    """What lies ahead of a robot: from when on it is free, its tasks in order, and seconds on the way to each.

    It may be on the first way already, goes home in the end, and may be yet to leave its start.
    """

    free_s: float
    tasks: Sequence[str]
    legs_s: Sequence[float]
    robot: str = ""
    limits: RobotLimits = NO_LIMITS
    is_under_way: bool = False
    home_s: float = 0.0
    has_left: bool = False


@dataclass
class Schedule:
    """Lower bounds of the times at which tasks begin, raised until they fit together.

    Parameters
    ----------
    rules
        what is asked of tasks.
    courses
        of the robots.
    lasts_s
        how long each task of the courses takes.
    ends_s
        of tasks that have begun: when each ended, or will.
    now
        when the schedule begins.
    margin
        the share of the time until a robot arrives at a task by which it may be late; what the task must follow soon is
        held back for that.
    """

    rules: UnderWay
    courses: Sequence[Course]
    lasts_s: Mapping[str, float]
    ends_s: Mapping[str, float]
    now: float
    margin: float = 0.0
    begins_s: dict[str, float] = field(init=False)

    def __post_init__(self) -> None:
        self.begins_s = {name: self.now for course in self.courses for name in course.tasks}
        self._arrives_s = dict(self.begins_s)
        self.leaves_s: dict[str, float] = {}  # by robot, where its way from its start is limited
        self.over_s: dict[str, float] = {}
        self._raised = False

    def settle(self) -> bool:
        """Raise bounds until none changes; False if they never fit together."""
        for _ in range(2 * len(self.begins_s) + 2 * len(self.courses) + 4):
            self._raised = False
            for course in self.courses:
                self._follow(course)
            for name in self.begins_s:
                self._wait(name)
            for name in self.begins_s:
                self._hold_back(name)
            if not self._raised:
                return True
        return False

    def _raise(self, name: str, to: float) -> None:
        if self.begins_s[name] + _SETTLED_S < to < math.inf:
            self.begins_s[name] = to
            self._raised = True

    def _follow(self, course: Course) -> None:
        """The robot arrives at one task after the other."""
        leaves_s, limits = self.leaves_s.get(course.robot, course.free_s), course.limits
        for k, (name, leg_s) in enumerate(zip(course.tasks, course.legs_s, strict=True)):
            sets_out_s = leaves_s if k == 0 and course.is_under_way else limits.set_out(leaves_s, leg_s)
            arrives_s = sets_out_s + leg_s
            self._arrives_s[name] = max(self._arrives_s[name], arrives_s)
            self._raise(name, arrives_s)
            self._raise(name, limits.set_out(self.begins_s[name], self.lasts_s[name]))
            leaves_s = self.begins_s[name] + self.lasts_s[name]
        if course.tasks and not course.has_left and limits.lasts_most_s < math.inf:
            self._leave_late(course, leaves_s)

    def _leave_late(self, course: Course, free_s: float) -> None:
        """The robot leaves its start soon enough before it is at its end."""
        over_s = self.over_s[course.robot] = course.limits.back_s(free_s, course.home_s)
        leaves_s = over_s - (1 - self.margin) * course.limits.lasts_most_s
        if self.leaves_s.get(course.robot, course.free_s) + _SETTLED_S < leaves_s < math.inf:
            self.leaves_s[course.robot], self._raised = leaves_s, True

    def _wait(self, name: str) -> None:
        """The tasks before it have ended for long enough, and it may begin, as may those that begin with it."""
        for before, (least_s, _) in self.rules.before(name).items():
            if before in self.ends_s or before in self.begins_s:
                self._raise(name, self._end_s(before) + least_s)
        unit = self.rules.unit(name)
        together_s = max(self.begins_s.get(other, self.now) for other in unit)
        self._raise(name, self.rules.next_begin_s(unit, together_s))

    def _hold_back(self, name: str) -> None:
        """The tasks before it begin so late that it can begin soon enough after them."""
        for before, (least_s, most_s) in self.rules.gaps(name).items():
            if most_s < math.inf and before in self.begins_s:
                late_s = held_back_for(self._arrives_s[name] - self.now, self.margin, least_s, most_s)
                self._raise(before, self.begins_s[name] + late_s - most_s - self.lasts_s[before])

    def _end_s(self, name: str) -> float:
        return self.ends_s[name] if name in self.ends_s else self.begins_s[name] + self.lasts_s[name]


def held_back_for(ahead_s: float, margin: float, least_s: float, most_s: float) -> float:
    """How late a task may be that must begin between two times after another: a share of how far ahead it is.

    That is half of the time between the two at most.
    """
    return min(margin * ahead_s, (most_s - least_s) / 2)
