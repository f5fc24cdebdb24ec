"""A robot does at least so many tasks, or none at all: one that would do too few is not worth sending out."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass, replace
from typing import ClassVar

import numpy as np

from muster.mission.model import Mission, Robot
from muster.mission.texts.counting import counted
from muster.model.parts import Parts
from muster.model.rules.rule import Bools, Change, Found, Limits, Outlook, Question, Rule, Tried, listed


@dataclass(frozen=True)
class FewerTasks(Change):
    """A smaller least number of tasks of a robot: `enough` instead of `now`."""

    now: int
    enough: int

    @property
    def plain(self) -> dict[str, int]:
        return asdict(self)

    @property
    def short(self) -> str:
        return f"min_tasks {self.enough} instead of {self.now}"

    @property
    def line(self) -> str:
        return f"{self.short}: enough (a plan was found)"

    def robot(self, robot: Robot) -> Robot:
        return replace(robot, min_tasks=self.enough)

    def narrowed(self, found: Found) -> Change | None:
        return replace(self, enough=found.tasks) if found.tasks < self.now else None


class MinTasks(Rule):
    """A route has no task, or at least `min_tasks_i`; a team's task counts for each of its members."""

    word: ClassVar[str] = "min-tasks"
    asked: ClassVar[Mapping[str, str]] = {"least_stops": "min-tasks"}
    for_good = False
    lifted_late = True
    of_a_route = True
    of_the_team = True
    key = "min_tasks"

    def compile(self, problem: Question, parts: Parts) -> None:
        if problem.past is not None:
            return  # what was planned kept it; what happened since may not leave so many
        for i, robot in enumerate(problem.robots):
            if robot.min_tasks > 1:
                parts.stops(i, min(robot.min_tasks, len(problem.tasks) + 1))

    def possible(self, limits: Limits) -> Bools | None:
        least = limits.problem.model.least_stops
        if not (least > 1).any():
            return None
        enough = limits.usable.sum(axis=1) >= least
        return np.broadcast_to(enough[:, None], limits.usable.shape)

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        least = int(problem.model.least_stops[i])
        if least <= 1 or outlook.limits.usable[i].sum() >= least:
            return None
        may = sum(problem.may(i, k) for k in range(len(problem.tasks)))
        only = f"and may do only {counted(may, 'task')}" if may < least else "and can never do so many"
        return f"does at least {least} tasks or none, {only}"

    def broken_at(self, tried: Tried) -> str:
        problem, least = tried.problem, tried.problem.model.least_stops
        short = [{k: len(r) for k, r in enumerate(routes) if 0 < len(r) < least[k]} for routes, _ in tried.places]
        said = (
            f"{problem.robots[k].id} would do {counted(n, 'task')}, and does at least {least[k]} or none"
            for k, n in min(short, key=len).items()
        )
        return f"with it {listed(list(said))}"

    def never_used(self, mission: Mission, robot: Robot) -> str | None:
        if robot.min_tasks <= len(mission.tasks):
            return None
        return f"min_tasks {robot.min_tasks}, and the mission has {counted(len(mission.tasks), 'task')}"

    def too_few(self, problem: Question, i: int, tasks: int) -> bool:
        return 0 < tasks < int(problem.model.least_stops[i])

    def lifted(self, problem: Question, i: int, j: int, done: Collection[int]) -> Change | None:
        least = problem.robots[i].min_tasks
        return FewerTasks(least, 0) if least > 1 else None
