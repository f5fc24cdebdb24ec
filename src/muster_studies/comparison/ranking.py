"""Runs beside each other, lexicographically: more weight completed first, then the lower objective."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from muster_studies.comparison.run import NOT_APPLICABLE, Run

_TOLERANCE = 1e-9
"""Relative: values that differ by less are equal."""

Rank = tuple[float, float]
"""Of a run: minus the weight completed, then the objective; infinite without a plan. Lower is better."""


@dataclass(frozen=True)
class Best:
    """The most weight that any run on a mission completes, and the least objective of those that do; None: none has."""

    weight: float
    value: float


def order(one: Rank, other: Rank) -> int:
    """-1 where the first is better, 1 where it is worse, 0 where they are equal."""
    for a, b in zip(one, other, strict=True):
        if not close(a, b):
            return -1 if a < b else 1
    return 0


def close(a: float, b: float) -> bool:
    """Whether two figures are equal but for rounding."""
    return a == b or math.isclose(a, b, rel_tol=_TOLERANCE, abs_tol=1e-12)


def typical(runs: Sequence[Run]) -> Rank:
    """The rank in the middle of those of some runs; of an even number the mean of the two, without a plan if one is."""
    ranks = sorted(run.rank for run in runs)
    lower, upper = ranks[(len(ranks) - 1) // 2], ranks[len(ranks) // 2]
    return (lower[0] + upper[0]) / 2, (lower[1] + upper[1]) / 2


def are_equal(ranks: Sequence[Rank]) -> bool:
    """Whether some ranks are all the same."""
    return all(order(ranks[0], rank) == 0 for rank in ranks[1:])


def best_of(runs: Sequence[Run]) -> Best | None:
    """The best of all runs on a mission; None where none has a plan."""
    done = [run.rank for run in runs if run.is_done]
    if not done:
        return None
    weight = -min(done)[0]
    return Best(weight, min(value for minus, value in done if close(-minus, weight)))


def completes_as_much(run: Run, best: Best | None) -> bool:
    """Whether a run completes as much weight as the best one on its mission."""
    return best is not None and close(-run.rank[0], best.weight)


def ratio(run: Run, best: Best | None) -> float:
    """The objective of a run by the best one; infinite where it has no plan, or completes less weight than the best."""
    value = run.rank[1]
    if best is None or not completes_as_much(run, best):
        return math.inf
    if close(value, best.value):
        return 1.0
    return value / best.value if best.value > 0 else math.inf


def gap(run: Run, best: Best | None) -> float | None:
    """By how many per cent a run's objective is above the best; None where it completes less weight than the best.

    Infinite where the best objective is 0, and its own is not.
    """
    return 100 * (ratio(run, best) - 1) if completes_as_much(run, best) else None


def by_mission(runs: Sequence[Run]) -> dict[str, dict[str, list[Run]]]:
    """The runs by mission and allocator, in order; without those of allocators that cannot take the mission."""
    found: dict[str, dict[str, list[Run]]] = {}
    for run in runs:
        own = found.setdefault(run.mission, {})
        if run.status != NOT_APPLICABLE:
            own.setdefault(run.allocator, []).append(run)
    return found


def bests(runs: Sequence[Run]) -> Mapping[str, Best | None]:
    """By mission the best of all its runs."""
    return {
        mission: best_of([run for some in own.values() for run in some]) for mission, own in by_mission(runs).items()
    }
