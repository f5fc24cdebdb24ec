"""The rules of time, teams and relations as the arrays that the core takes; what is empty binds nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from muster.allocation.problem import Problem
    from muster.allocation.timed_rules import TimedRules

_NONE = np.empty(0)
_NO_NUMBERS = np.empty(0, dtype=np.int32)


def timed_arrays(problem: Problem) -> dict[str, Any]:
    """The keyword arguments of `core.Problem` that are about time, teams and relations."""
    rules = problem.timed_rules
    return {
        "windows": rules.windows if any(rules.windows) else [],
        "deadline": _limits(rules.deadline),
        "due": _limits(rules.due),
        "available_until": _limits(rules.available_until),
        **_lags(problem, rules),
        **_relations(rules),
        **_teams(problem, rules),
        "time": _NONE,
        "time_class": _NO_NUMBERS,
        "makespan_includes_return": problem.mission.rules.makespan_includes_return,
    }


def _limits(limits: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return limits if np.isfinite(limits).any() else _NONE


def _lags(problem: Problem, rules: TimedRules) -> dict[str, Any]:
    lags = [lag for j in range(len(problem.tasks)) for lag in rules.lags(j)]
    after, within = np.array([lag[1] for lag in lags]), np.array([lag[2] for lag in lags])
    return {
        "after": after if after.any() else _NONE,
        "within": within if np.isfinite(within).any() else _NONE,
    }


def _relations(rules: TimedRules) -> dict[str, Any]:
    return {
        "unit": _NO_NUMBERS if len(rules.units) == len(rules.unit) else np.array(rules.unit, dtype=np.int32),
        "same_robot": rules.same_robot if any(rules.same_robot) else [],
        "other_robot": rules.other_robot if any(rules.other_robot) else [],
    }


def _teams(problem: Problem, rules: TimedRules) -> dict[str, Any]:
    if not rules.with_teams:
        return {"parts": [], "abilities": _NONE, "needs": _NONE}
    first_of_kind = np.unique(problem.kinds, return_index=True)[1]
    tasks = range(len(problem.tasks))
    parts = [
        [(count, fits[first_of_kind].tolist()) for count, fits in rules.parts(j)] if rules.has_parts(j) else []
        for j in tasks
    ]
    names = sorted({name for j in tasks for name in rules.needed(j)})
    return {
        "parts": parts,
        "abilities": np.array([[(r.abilities or {}).get(name, 0.0) for name in names] for r in problem.robots]),
        "needs": np.array([[rules.needed(j).get(name, 0.0) for name in names] for j in tasks]),
    }
