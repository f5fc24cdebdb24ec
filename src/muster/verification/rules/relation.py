"""Tasks tied by who does them: the same robots, other robots, or both at the same moment."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class Relation:
    """`same_robot_as` and `other_robot_than` bind where both tasks are done; `starts_with` ties both or neither."""

    kind = "relation"
    ignorable = True

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        for step in route.steps:
            if case.members[step.task.id][0] is route.robot:
                for detail in _wrong(case, step.task):
                    yield Violation(self.kind, None, step.task.id, detail)

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Undecided where tasks are tied."""
        return None if case.has_relations else False


def _wrong(case: Case, task: Task) -> Iterator[str]:
    own = {robot.id for robot in case.members[task.id]}
    for name in task.same_robot_as:
        if name in case.done and own != (other := _members(case, name)):
            yield f"done by {_listed(own)}, and {name} by {_listed(other)}; expected the same"
    for name in task.other_robot_than:
        common = own & _members(case, name)
        if common:
            yield f"done by {_listed(common)}, and so is {name}; expected other robots"
    for name in task.starts_with:
        if name not in case.done:
            yield f"begins together with {name}, which is not in the plan"
        elif own & _members(case, name):
            yield f"begins together with {name}, which {_listed(own & _members(case, name))} does too"
    for name in case.beginning_with.get(task.id, ()):
        if name not in case.done:
            yield f"{name} begins together with it, and is not in the plan"


def _members(case: Case, name: str) -> set[str]:
    return {robot.id for robot in case.members.get(name, ())}


def _listed(names: set[str]) -> str:
    return ", ".join(sorted(names))
