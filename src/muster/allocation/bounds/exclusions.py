"""The record of what narrowed pairs of robot and task: which rule excluded each, by which bounds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from muster.model.problem import Bools, Problem
from muster.model.rules import Rule
from muster.model.rules.rule import Limits

_NOT = -1
Numbers = npt.NDArray[np.int32]


class Narrowing(Limits, Protocol):
    """Bounds, and what rules leave of their pairs."""

    @property
    def possible_by_rule(self) -> list[Bools | None]: ...

    def bare(self) -> Limits: ...


@dataclass(frozen=True)
class Cause:
    """What excluded a pair.

    Parameters
    ----------
    rule
        the rule.
    limits
        the bounds and the pairs left, as they were then.
    """

    rule: Rule
    limits: Limits


class Exclusions:
    """What excluded pairs, step by step; written while bounds are narrowed, and only then."""

    def __init__(self, problem: Problem) -> None:
        self._rules = problem.rules
        self._steps: list[Limits] = []
        shape = len(problem.robots), len(problem.tasks)
        self._rule: Numbers = np.full(shape, _NOT, np.int32)
        self._step: Numbers = np.full(shape, _NOT, np.int32)

    def narrowed(self, limits: Narrowing) -> Bools:
        """(m, n) the pairs that some bounds leave of those before; of the others the first rule is remembered."""
        usable = limits.usable.copy()
        for number, possible in enumerate(limits.possible_by_rule):
            if possible is not None:
                self._rule[usable & ~possible] = number
                usable &= possible
        self._step[limits.usable & ~usable] = len(self._steps)
        self._steps.append(limits.bare())
        return usable

    def cause(self, i: int, j: int) -> Cause | None:
        """What excluded robot i from task j; None: nothing did, or a rule that refuses the pair whatever the route."""
        number = int(self._rule[i, j])
        return None if number == _NOT else Cause(self._rules[number], self._steps[int(self._step[i, j])])

    def before(self, word: str, *, robot: int | None = None, task: int | None = None) -> Limits | None:
        """The last bounds that hold whatever a rule says of a robot or a task: by it no pair of these was excluded.

        None: it excluded none at all.
        """
        of_rule = np.array([rule.word == word for rule in self._rules])
        at = np.s_[robot, :] if robot is not None else np.s_[:, task]
        steps = self._step[at][(self._rule[at] != _NOT) & of_rule[self._rule[at]]]
        return self._steps[int(steps.min())] if len(steps) else None
