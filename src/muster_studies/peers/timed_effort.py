"""The effort of the comparison in time."""

from __future__ import annotations

from muster_studies.effort import Effort

QUICK_S = 0.3
"""The limit of each run with --quick."""
_SEEDS, _QUICK_SEEDS = 3, 1


def limit_of(effort: Effort, seconds: float) -> float:
    """The limit of a run that has so many seconds otherwise."""
    return QUICK_S if effort.quick else seconds


def seeds_of(effort: Effort) -> int:
    return effort.seeds or (_QUICK_SEEDS if effort.quick else _SEEDS)
