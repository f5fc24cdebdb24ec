"""The record of what narrowed pairs of robot and task: which rule excluded each, by which bounds."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from muster.model.problem import Bools, Problem
from muster.model.rules import Rule

if TYPE_CHECKING:
    from muster.allocation.bounds.limits import Limits

_NOT = -1
_MOST_ASKED = 50_000  # pairs, up to which it is said why others cannot do tasks
Numbers = npt.NDArray[np.int32]


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

    def narrowed(self, limits: Limits) -> Bools:
        """(m, n) the pairs that some bounds leave of those before; of the others the first rule is remembered."""
        usable = limits.usable.copy()
        for number, possible in enumerate(limits.possible_by_rule):
            if possible is not None:
                self._rule[usable & ~possible] = number
                usable &= possible
        self._step[limits.usable & ~usable] = len(self._steps)
        self._steps.append(replace(limits))  # without what is worked out from it
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


def why_no_others(limits: Limits, group: Collection[int], tasks: Sequence[int]) -> tuple[str, ...]:
    """Why no robot outside a group does any of some tasks, each reason once; empty: one may, or pairs are too many.

    Of what refuses a pair the rule and its words, of what excluded one, for which times differ, the rule alone.
    """
    problem, found = limits.problem, dict[str, None]()
    outside = [i for i in range(len(problem.robots)) if i not in group]
    if len(outside) * len(tasks) > _MOST_ASKED:
        return ()
    for i in outside:
        for j in tasks:
            if (refused := problem.refusal(i, j)) is not None:
                found[", ".join(refused)] = None
            elif (cause := limits.exclusions.cause(i, j)) is not None:
                found[cause.rule.blamed(cause.limits, i, j)] = None
            else:
                return ()
    return tuple(found)
