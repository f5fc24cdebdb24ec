"""A route uses no more than the robot's work capacity, the reserve taken off."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from muster.mission.model import Robot
from muster.model.parts import Parts
from muster.model.rules.rule import ROUNDING, Bools, InPlan, Limits, Outlook, Question, Rule, Tried


class Capacity(Rule):
    """`u_i <= (1 - capacity_reserve) * work_capacity_i`. An ignored capacity is infinite."""

    word: ClassVar[str] = "capacity"
    lifted_late = True
    of_a_route = True
    of_the_team = True
    resource = ("capacity", "work capacity")

    def compile(self, problem: Question, parts: Parts) -> None:
        for i, robot in enumerate(problem.robots):
            if robot.work_capacity is not None:
                parts.uses(i, problem.mission.rules.usable_share * robot.work_capacity)

    def possible(self, limits: Limits) -> Bools:
        return np.asarray(limits.usage <= limits.rules.capacity[:, None] * (1 + ROUNDING))

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        if outlook.least <= problem.model.capacity[i] * (1 + ROUNDING):
            return None
        unit = problem.usage_unit
        return f"takes at least {outlook.least:.2f} {unit}, of {problem.model.capacity[i]:.2f} {unit}"

    def left_out(self, plan: InPlan, i: int, j: int) -> str | None:
        if plan.is_timed:
            return plan.kept_out(self.word, i, j)
        insertion, problem = plan.insertion(i, j), plan.problem
        if insertion is None or insertion.usage <= problem.model.capacity[i]:
            return None
        return _too_much(problem, i, insertion.usage)

    def broken_at(self, tried: Tried) -> str:
        if tried.usage > tried.problem.model.capacity[tried.i]:
            return _too_much(tried.problem, tried.i, tried.usage)
        return "with its team one of the robots would need more than its capacity"


def _too_much(problem: Question, i: int, usage: float) -> str:
    unit = problem.usage_unit
    return f"at least {usage:.2f} {unit} with it, of {problem.model.capacity[i]:.2f} {unit}"


@dataclass(frozen=True, kw_only=True)
class CapacityChange:
    """Work capacities of a robot, the reserve included, the other changes made.

    `now` is the mission's, None where it is unlimited. With `as_is` the task fits into the robot's route and nothing
    else of the plan changes: exactly that much is needed for it. With less than `at_least` no admissible plan does what
    the plan does and the task by this robot: that is proven. With `enough` such a plan was found, and judged.
    `grows` tells whether more is needed than there is now, as far as is known. Values are None where nothing is.
    """

    now: float | None
    as_is: float | None = None
    at_least: float | None = None
    enough: float | None = None

    @classmethod
    def of(cls, problem: Question, i: int) -> CapacityChange:
        """No change of robot i."""
        return cls(now=None if math.isinf(problem.model.capacity[i]) else problem.robots[i].work_capacity)

    def robot(self, robot: Robot) -> Robot:
        """The robot with the capacity that is enough."""
        return robot if self.now is None or self.enough is None else replace(robot, work_capacity=self.enough)

    @property
    def grows(self) -> bool:
        needed = max(self.enough or 0.0, self.at_least or 0.0)
        return self.now is not None and needed > self.now * (1 + ROUNDING)

    def short(self, unit: str) -> str:
        """The change in a few words; empty where none is known to be enough."""
        if not self.grows or self.enough is None or self.now is None:
            return ""
        return f"capacity {_up(self.enough)} {unit}, not {self.now:g}"

    def lines(self, unit: str) -> list[str]:
        """The change, a line for what is needed and one for the rest of the plan as it is."""
        least, enough = self.at_least, self.enough
        proven = least is not None and self.now is not None and least > self.now
        parts = []
        if proven and enough is not None and least is not None and _down(least) == _up(enough):
            parts.append(f"{_up(enough)} {unit} is needed (proven) and enough (a plan was found)")
        else:
            parts += [f"needs at least {_down(least)} {unit} (proven)"] if proven and least is not None else []
            parts += [f"{_up(enough)} {unit} is enough (a plan was found)"] if enough is not None else []
            parts += ["whether less is enough is not known"] if not proven else []
        lines = [f"capacity: {', '.join(parts)}; it has {self.now:g}"]
        if self.as_is is not None:
            lines.append(f"capacity with the rest of the plan as it is: {_up(self.as_is)} {unit}")
        return lines


def _up(value: float) -> str:
    """A figure rounded up, so that a sufficient value stays sufficient."""
    return f"{math.ceil(value * 100 * (1 - 1e-10)) / 100:.2f}"


def _down(value: float) -> str:
    """A figure rounded down, so that a least value stays one."""
    return f"{math.floor(value * 100 * (1 + 1e-10)) / 100:.2f}"
