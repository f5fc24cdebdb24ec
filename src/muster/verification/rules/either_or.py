"""Of tasks that stand for each other at most one is done."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class EitherOr:
    """Of tasks tied by `either_or`, directly or through others, at most one is in the plan."""

    kind = "either-or"
    ignorable = True

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        """Yield a violation for each task in the plan behind the first of its set."""
        for step in route.steps:
            name = step.task.id
            done = [one for one in case.alternatives[name] if one in case.done]
            if name != done[0] and case.members[name][0] is route.robot:
                detail = f"{done[0]} is in the plan too; expected at most one of {', '.join(case.alternatives[name])}"
                yield Violation(self.kind, route.robot.id, name, detail)

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Return whether another of its set is in the plan; undecided where the task comes together with others."""
        if any(one in case.done for one in case.alternatives[task.id]):
            return True
        has_sets = len(set(case.alternatives.values())) < len(case.mission.tasks)
        return None if has_sets and (case.needs_others(task) or case.is_paired(task)) else False
