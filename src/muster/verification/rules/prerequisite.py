"""A task is in the plan only together with all its prerequisites."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class Prerequisite:
    """All prerequisites of a task in the plan are in the plan: [tcf-thesis] (3.16)."""

    kind = "prerequisite"
    ignorable = True

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        for step in route.steps:
            for name in step.task.prerequisites:
                if name not in case.done:
                    detail = f"its prerequisite {name} is not in the plan"
                    yield Violation(self.kind, route.robot.id, step.task.id, detail)

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether a prerequisite is left out.

        With all of them in the plan the task can stand at the end of any route, unless a task in the plan waits for it
        or there are rules of times, teams and relations, lags among them.
        """
        if not case.done.issuperset(task.prerequisites):
            return True
        awaited = case.deadlocked or task.id in case.awaited
        return None if awaited or case.is_timed else False
