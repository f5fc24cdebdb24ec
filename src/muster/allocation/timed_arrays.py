"""The rules of time, teams and relations as the arrays that the core takes; what is empty binds nothing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from muster.allocation.timed_rules import TimedRules
from muster.mission.model import Mission
from muster.motion.leg_times import LegTimes

_NONE = np.empty(0)
_NO_NUMBERS = np.empty(0, dtype=np.int32)


def timed_arrays(
    rules: TimedRules, kinds: npt.NDArray[np.int32], profiles: Sequence[LegTimes], mission: Mission
) -> dict[str, Any]:
    """The keyword arguments of `core.Problem` that are about time, teams and relations; `kinds` is (m,)."""
    return {
        "windows": rules.windows if any(rules.windows) else [],
        "deadline": _limits(rules.deadline),
        "due": _limits(rules.due),
        "available_until": _limits(rules.available_until),
        **_lags(rules),
        **_relations(rules),
        **_teams(rules, kinds),
        **_profiles(profiles),
        "makespan_includes_return": mission.rules.makespan_includes_return,
    }


def _profiles(profiles: Sequence[LegTimes]) -> dict[str, Any]:
    if all(profile.is_constant for profile in profiles):
        return {"acceleration": _NONE, "climb": _NONE, "turn": _NONE}
    return {
        "acceleration": np.array([profile.acceleration_mps2 for profile in profiles]),
        "climb": np.array([profile.climb_mps for profile in profiles]),
        "turn": np.array([profile.turn_s for profile in profiles]),
    }


def _limits(limits: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return limits if np.isfinite(limits).any() else _NONE


def _lags(rules: TimedRules) -> dict[str, Any]:
    lags = [lag for j in range(len(rules.problem.tasks)) for lag in rules.lags(j)]
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


def _teams(rules: TimedRules, kinds: npt.NDArray[np.int32]) -> dict[str, Any]:
    if not rules.with_teams:
        return {"parts": [], "abilities": _NONE, "needs": _NONE}
    first_of_kind = np.unique(kinds, return_index=True)[1]
    tasks = range(len(rules.problem.tasks))
    parts = [
        [(count, fits[first_of_kind].tolist()) for count, fits in rules.parts(j)] if rules.has_parts(j) else []
        for j in tasks
    ]
    names = sorted({name for j in tasks for name in rules.needed(j)})
    return {
        "parts": parts,
        "abilities": np.array([[(r.abilities or {}).get(name, 0.0) for name in names] for r in rules.problem.robots]),
        "needs": np.array([[rules.needed(j).get(name, 0.0) for name in names] for j in tasks]),
    }
