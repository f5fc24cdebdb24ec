"""A robot does at least as many tasks as it must, or none at all."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class MinTasks:
    """A route has no task, or at least `min_tasks`; a team's task counts for each of its members."""

    kind = "min-tasks"
    ignorable = True

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        done, least = len(route.steps), route.robot.min_tasks
        if 0 < done < least:
            yield Violation(self.kind, route.robot.id, None, f"{done} in its route, at least {least} or none")

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether the route would still be too short; undecided where other robots or tasks have to come with it."""
        if len(route.steps) + 1 < route.robot.min_tasks:
            return None if case.is_paired(task) else True
        return None if case.needs_others(task) and any(robot.min_tasks > 1 for robot in case.mission.robots) else False
