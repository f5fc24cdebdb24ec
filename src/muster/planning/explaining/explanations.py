"""Why tasks are left out of a plan, and why one is done by this robot and not by another: as data."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from muster.allocation.allocator import routes_of
from muster.allocation.bounds.work_shortfall import Shortfall
from muster.allocation.reasons.explanations import Alternative, alternatives, unassigned
from muster.allocation.remedies.conflicts import without_search
from muster.allocation.remedies.remedies import remedies, smallest_as_is
from muster.allocation.remedies.remedy import Remedy
from muster.allocation.stop import Stop
from muster.mission.auction_book import Award
from muster.mission.errors import Finding, ParameterError, PlanError
from muster.mission.model import Mission
from muster.mission.plan import Plan, Unassigned
from muster.mission.texts.near_matches import did_you_mean
from muster.model.problem import Problem
from muster.planning.judging import admits
from muster.verification import RouteFigures, Verdict, verify

EXPLAIN_TIME_LIMIT_S = 10.0
_FOR_REASONS = 0.5  # share of the time; the rest is for changes
_MOST_SHORT = 50  # tasks left out whose smallest change is looked for when none is asked for by name
_IN_KNOTS = ("mission", "unknown-robot", "unknown-task", "repeated-robot", "repeated-task", "deadlock", "prerequisite")


@dataclass(frozen=True)
class LeftOut:
    """The tasks that a plan leaves out, and for the first of them the smallest change with which each could be done."""

    problem: Problem = field(repr=False)
    unassigned: tuple[Unassigned, ...]
    changes: Mapping[str, Remedy | None]
    cut_short: bool = False
    """Whether time was up before all reasons and changes were found."""
    shortfalls: tuple[Shortfall, ...] = ()
    """Proofs that no plan does all tasks, as their work is too much for the robots."""

    def as_dict(self) -> dict[str, Any]:
        """Return what `muster explain --format json` prints."""
        smallest = [{"task": task, "remedy": _plain(remedy)} for task, remedy in self.changes.items()]
        return {
            "ignored": list(self.problem.ignored),
            "shortfalls": [short.as_dict() for short in self.shortfalls],
            "unassigned": [asdict(item) for item in self.unassigned],
            "smallest": smallest,
            "cut_short": self.cut_short,
        }


@dataclass(frozen=True, kw_only=True)
class OneTask:
    """The explanation of one task of a plan.

    Parameters
    ----------
    robot
        the robot that does it, of a team the first; None: it is left out.
    alternatives
        for each robot the effect of giving it the task.
    remedies
        for each robot the changes that it would need.
    award
        the award of the task in a plan of an auction.
    cut_short
        whether time was up before all remedies were looked for.
    """

    problem: Problem = field(repr=False)
    plan: Plan
    verdict: Verdict
    task: str
    robot: str | None
    alternatives: tuple[Alternative, ...]
    remedies: tuple[Remedy, ...]
    award: Award | None
    cut_short: bool = False

    @property
    def objective(self) -> float | None:
        return self.verdict.value()

    @property
    def team(self) -> tuple[str, ...]:
        """The robots that do the task, in mission order."""
        return tuple(route.robot for route in self.verdict.routes if self.task in route.tasks)

    @property
    def route(self) -> RouteFigures | None:
        """The route that has the task."""
        return next((route for route in self.verdict.routes if route.robot == self.robot), None)

    def as_dict(self) -> dict[str, Any]:
        """Return what `muster explain --task T --format json` prints."""
        data = {
            "task": self.task,
            "robot": self.robot,
            "team": list(self.team),
            "ignored": list(self.problem.ignored),
            "objective": self.objective,
            "alternatives": [asdict(other) for other in self.alternatives],
            "remedies": [_plain(remedy) for remedy in self.remedies],
            "cut_short": self.cut_short,
        }
        return data if self.award is None else {**data, "award": self.award.as_dict()}


def require_fit(mission: Mission, plan: Plan, file: str, ignore: Collection[str] = ()) -> None:
    """Refuse a plan that does not fit the mission, or whose tasks wait for each other: `verify` says more.

    Raises
    ------
    PlanError
        if the plan does not fit; `file` names it.
    """
    wrong = [v for v in verify(mission, plan, ignore).violations if v.kind in _IN_KNOTS]
    if wrong:
        expected = "a plan of this mission (`muster verify` says more)"
        raise PlanError(
            [
                Finding(file, None, v.kind, ", ".join(filter(None, (v.task or v.robot, v.detail))), expected)
                for v in wrong
            ]
        )


def left_out(mission: Mission, plan: Plan, ignore: Collection[str], stop: Stop) -> LeftOut:
    """Explain why tasks are left out of a plan that fits the mission, as far as there is time."""
    problem = Problem.compile(mission, plan.objective, ignore)
    routes = routes_of(problem, plan)
    missing_any = len({j for route in routes for j in route}) < len(problem.tasks)
    short = without_search(problem).shortfalls if missing_any else ()
    for_reasons = None if stop.time_left_s is None else _FOR_REASONS * stop.time_left_s
    missing = unassigned(problem, routes, stop.part(time_limit=for_reasons, iterations=None).due)
    changes: dict[str, Remedy | None] = {}
    for item in missing[:_MOST_SHORT]:
        found = smallest_as_is(problem, routes, problem.task_index[item.task], admits, stop.due)
        if stop.due():
            break
        changes[item.task] = found
    cut_short = stop.due() or not all(item.reasons for item in missing)
    return LeftOut(problem, missing, changes, cut_short, short)


def one_task(mission: Mission, plan: Plan, task: str, ignore: Collection[str], stop: Stop) -> OneTask:
    """Explain why a task is done by this robot and not by another, or left out, in a plan that fits the mission.

    What robots would need to do it is looked for as long as there is time.

    Raises
    ------
    ParameterError
        if the mission has no such task.
    """
    problem = Problem.compile(mission, plan.objective, ignore)
    if task not in problem.task_index:
        hint = did_you_mean(task, problem.task_index)
        raise ParameterError(f"--task: {task}; expected the id of a task of this mission{hint}")
    routes, j = routes_of(problem, plan), problem.task_index[task]
    found = alternatives(problem, routes, j)
    changes = remedies(problem, routes, j, admits, stop.due)
    cut_short = stop.due()
    verdict = verify(mission, plan, ignore, plan.objective)
    return OneTask(
        problem=problem,
        plan=plan,
        verdict=verdict,
        task=task,
        robot=next((route.robot for route in verdict.routes if task in route.tasks), None),
        alternatives=found,
        remedies=changes,
        award=None if plan.book is None else plan.book.award_of(task),
        cut_short=cut_short,
    )


def _plain(remedy: Remedy | None) -> dict[str, Any] | None:
    return None if remedy is None else remedy.as_dict()
