"""A task for a team is done by all the robots that it needs, each allowed for its part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from muster.mission.model import Robot, Task, TeamPart
from muster.mission.texts.counting import counted
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation

_ROUNDING = 1e-9


class Team:
    """The robots in whose routes the task stands are the team that it asks for."""

    kind = "team"
    ignorable = True

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        for step in route.steps:
            members = case.members[step.task.id]
            if members[0] is route.robot:
                wrong = team_fault(step.task, members, skills=case.holds("skill"))
                if wrong is not None:
                    yield Violation(self.kind, None, step.task.id, wrong)

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Undecided for a team's task: it depends on the other members."""
        return None if task.is_for_team else False


def team_fault(task: Task, members: Sequence[Robot], *, skills: bool) -> str | None:
    """Why robots are not the team that a task asks for; None: they are. `skills`: whether these matter."""
    if task.needs is not None:
        return _short(task, members)
    if not task.is_for_team and len(members) == 1:
        return None
    parts = task.team or (TeamPart(count=task.robots_needed or 1),)
    needed = sum(part.count for part in parts)
    names = ", ".join(robot.id for robot in members)
    if len(members) != needed:
        return f"needs {counted(needed, 'robot')}, done by {len(members)}: {names}"
    if not _matched([part for part in parts for _ in range(part.count)], members, skills):
        return f"{names} do not fit the parts of its team"
    return None


def _short(task: Task, members: Sequence[Robot]) -> str | None:
    """Which ability the members give too little of."""
    for name, needed in (task.needs or {}).items():
        given = sum((robot.abilities or {}).get(name, 0.0) for robot in members)
        if given < needed * (1 - _ROUNDING):
            return f"needs {name} {needed:g}, {', '.join(robot.id for robot in members)} give {given:g}"
    return None


def _matched(places: Sequence[TeamPart], members: Sequence[Robot], skills: bool) -> bool:
    """Whether each place of a team can be given to another member: a bipartite matching by augmenting paths."""
    place_of: dict[int, int] = {}  # by member

    def place(k: int, tried: set[int]) -> bool:
        for i, robot in enumerate(members):
            if i in tried or not places[k].fits(robot, skills=skills):
                continue
            tried.add(i)
            if i not in place_of or place(place_of[i], tried):
                place_of[i] = k
                return True
        return False

    return all(place(k, set()) for k in range(len(places)))
