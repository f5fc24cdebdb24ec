"""The rules of time, teams and relations as the arrays that the core takes; what is empty binds nothing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from muster.model.rules import RULES, Question
from muster.model.rules.rule import limits_array
from muster.motion.leg_times import LegTimes

_NONE = np.empty(0)


def timed_arrays(problem: Question, profiles: Sequence[LegTimes]) -> dict[str, Any]:
    """The keyword arguments of `core.Problem` that are about rules and times."""
    of_rules = {name: array for rule in RULES for name, array in rule.core_arrays(problem).items()}
    return {
        **of_rules,
        "due": limits_array(problem.timed_rules.due),
        **_profiles(profiles),
        "makespan_includes_return": problem.mission.rules.makespan_includes_return,
    }


def _profiles(profiles: Sequence[LegTimes]) -> dict[str, Any]:
    if all(profile.is_constant for profile in profiles):
        return {"acceleration": _NONE, "climb": _NONE, "turn": _NONE, "over_map": False}
    return {
        "acceleration": np.array([profile.acceleration_mps2 for profile in profiles]),
        "climb": np.array([profile.climb_mps for profile in profiles]),
        "turn": np.array([profile.turn_s for profile in profiles]),
        "over_map": any(profile.over_map for profile in profiles),
    }
