"""A robot drives and works while it is available: within one of its shifts, and its route ends by the last of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from muster.mission.model import Mission
from muster.verification.measure import MeasuredRoute
from muster.verification.rules.limit_rule import LimitRule
from muster.verification.schedule_nodes import is_after


class Shift(LimitRule):
    """A robot's legs and work each lie within one shift; its route, the way to its end included, ends by the last."""

    kind = "shift"

    def is_in(self, mission: Mission) -> bool:
        return any(robot.available_until_s is not None or robot.shifts_s for robot in mission.robots)


@dataclass(frozen=True)
class Shifts:
    """The shifts of a robot that has several, in order: when each begins and ends, seconds."""

    times: tuple[tuple[float, float], ...]

    @classmethod
    def by_robot(cls, routes: Iterable[MeasuredRoute], limit: Callable[[float], float]) -> dict[str, Shifts]:
        """Return the shifts of each robot that has several, by id; `limit` moves their ends by a margin."""
        return {
            route.robot.id: cls(tuple((begins, math.inf if ends is None else limit(ends)) for begins, ends in own))
            for route in routes
            if (own := route.robot.shifts_s)
        }

    @staticmethod
    def by_task(routes: Iterable[MeasuredRoute], by_robot: Mapping[str, Shifts]) -> dict[str, list[Shifts]]:
        """Return the shifts of those robots that do a task, for each task that any of them does."""
        by_task: dict[str, list[Shifts]] = {}
        for route in (route for route in routes if route.robot.id in by_robot):
            for step in route.steps:
                by_task.setdefault(step.task.id, []).append(by_robot[route.robot.id])
        return by_task

    def begin(self, time: float, seconds: float) -> float:
        """Return the first moment from `time` on from which a shift lasts so many seconds; inf: there is none."""
        tried = ((max(time, begins), ends) for begins, ends in self.times)
        return next((begin for begin, ends in tried if not is_after(begin + seconds, ends)), math.inf)

    def over(self, time: float) -> int:
        """Return how many shifts have ended before a moment."""
        return sum(is_after(time, ends) for _, ends in self.times)
