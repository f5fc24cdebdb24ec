"""The interface of a rule, and the change that lifts a rule for a robot and a task."""

from __future__ import annotations

import math
from collections.abc import Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar, Protocol

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.model import Mission, Robot, Task

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Scores = Mapping[str, Mapping[str, float]]

ROUNDING = 2e-9
"""By how much a usage may be above a capacity, relative; a little more than the judge allows."""


class Question(Protocol):
    """What rules look at: a `Problem`."""

    @property
    def mission(self) -> Mission: ...
    @property
    def robots(self) -> tuple[Robot, ...]: ...
    @property
    def tasks(self) -> tuple[Task, ...]: ...
    @property
    def capacity(self) -> Floats: ...
    @property
    def prerequisites(self) -> list[list[int]]: ...
    @property
    def usage_unit(self) -> str: ...
    @property
    def core(self) -> core.Problem: ...

    def action_refusal(self, i: int, j: int) -> str | None: ...

    def actions_refused(self, i: int) -> frozenset[int]: ...

    def no_way_to(self, i: int, j: int) -> str: ...


class Change:
    """What has to change for a robot to do a task under one rule: the least. Subclasses are frozen dataclasses."""

    @property
    def plain(self) -> Any:
        """The change as plain data."""
        raise NotImplementedError

    @property
    def short(self) -> str:
        """The change in a few words."""
        raise NotImplementedError

    @property
    def line(self) -> str:
        """The change as a line of its own."""
        return self.short

    def robot(self, robot: Robot) -> Robot:
        """The robot as it would have to be."""
        return robot

    def task(self, task: Task, robot: Robot) -> Task:
        """The task as it would have to be for the robot."""
        return task

    def suitability(self, table: Scores) -> Scores:
        """The suitability table as it would have to be."""
        return table


class InPlan:
    """Routes, and what one more task in them would do."""

    def __init__(self, problem: Question, routes: Sequence[Sequence[int]]) -> None:
        self.problem = problem
        self.inspection = core.Inspection(problem.core, [list(route) for route in routes])
        self.done = {j for route in routes for j in route}
        self._at = lru_cache(maxsize=1)(self.inspection.cheapest_insertion)

    def insertion(self, i: int, j: int) -> core.Insertion | None:
        """Where in the route of robot i task j adds least usage and nothing deadlocks; None: nowhere."""
        return self._at(i, j)

    def has_no_way(self, i: int) -> bool:
        """Whether the route of robot i itself has a leg without a way."""
        return math.isinf(self.inspection.usages[i])


@dataclass(frozen=True)
class Outlook:
    """What is known of a robot and a task whatever the plan.

    Parameters
    ----------
    least
        the least usage of any route of the robot that holds the task; inf where there is none.
    lost_before
        a prerequisite that can never be done; empty: none is known.
    """

    least: float
    lost_before: str = ""


class Rule:
    """One rule. What a rule does not say it leaves as it is here: nothing is refused.

    Parameters
    ----------
    word
        of reasons and of `--ignore`.
    ignorable
        whether it can be ignored.
    key, no_change
        of its change in the plain data of a remedy, and what stands there where no change is needed; no key: a robot
        is not changed for it, or not by it alone.
    """

    word: ClassVar[str]
    ignorable: ClassVar[bool] = True
    key: ClassVar[str | None] = None
    no_change: ClassVar[Any] = None

    def kinds(self, problem: Question) -> Sequence[Hashable] | None:
        """For each robot what `refusal` depends on, beside the task; None: it refuses nobody."""
        return None

    def refusal(self, problem: Question, i: int, j: int) -> str | None:
        """Why robot i may not do task j whatever its route; None if it may."""
        return None

    def possible(self, problem: Question, least: Floats) -> Bools | None:
        """(m, n) the pairs that may be in an admissible plan, by the least usages of routes with them; None: all."""
        return None

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        """Why robot i can do task j in no admissible plan; None if it may."""
        return self.refusal(problem, i, j)

    def left_out(self, plan: InPlan, i: int, j: int) -> str | None:
        """Why robot i does not do task j, which a plan leaves out; None if this rule does not keep it from it."""
        return self.refusal(plan.problem, i, j)

    def change(self, problem: Question, robot: Robot, task: Task) -> Change | None:
        """The least change with which the rule does not refuse the pair; None if none is needed."""
        return None


def listed(names: Collection[str]) -> str:
    """Names in one line."""
    return ", ".join(names)
