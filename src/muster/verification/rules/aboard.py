"""What a task delivers is on board for no longer than the task says."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Mission
from muster.verification.measure import MeasuredRoute
from muster.verification.rules.span_rule import Span, SpanRule


class Aboard(SpanRule):
    """A task that delivers begins at most `longest_aboard_s` after the end of the task that it delivers."""

    kind = "aboard"
    relies_on = "load"

    def is_in(self, mission: Mission) -> bool:
        return any(task.longest_aboard_s is not None for task in mission.tasks)

    def spans(self, route: MeasuredRoute) -> Iterator[Span]:
        """Yield a limit for each delivery behind what it delivers; another order breaks the rule `load`."""
        behind: set[str] = set()
        for task in (step.task for step in route.steps):
            if task.longest_aboard_s is not None and task.delivers in behind:
                said = f"the way on board from the end of {task.delivers} to the begin of {task.id}"
                yield Span(self.kind, route.robot.id, task.delivers, task.id, task.longest_aboard_s, said)
            behind.add(task.id)
