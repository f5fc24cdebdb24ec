"""What statistics say of the runs of a comparison.

Standings of allocators with confidence intervals, paired tests of two allocators (Wilcoxon's signed ranks
[wilcoxon1945], with Holm's correction [holm1979]), performance profiles [dolan2002]. Needs SciPy (extra `compare`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from statistics import fmean, median

import numpy as np
import numpy.typing as npt

from muster.mission.system.extras import needs_extra
from muster_studies.comparison.ranking import (
    Rank,
    are_equal,
    bests,
    by_mission,
    close,
    completes_as_much,
    gap,
    order,
    ratio,
    typical,
)
from muster_studies.comparison.run import FAILED, INVALID, NOT_APPLICABLE, Run

_CONFIDENCE = 0.95
_RESAMPLES = 9999
_EXACT, _EXACT_WITH_TIES = 50, 12
"""Differences up to which the test is exact: of all signs, and of all signs where some differences are equal."""


@dataclass(frozen=True, kw_only=True)
class Standing:
    """How an allocator stands among all.

    Parameters
    ----------
    runs
        made on missions that it can take.
    failed
        of them without a plan that counts.
    not_applicable
        missions that it cannot take.
    as_much
        share of its runs that complete as much weight as the best run on their mission.
    gap_mean, gap_low, gap_high
        per cent of the objective above the best run on the mission, of the runs that complete as much: the mean over
        missions of their means, and its confidence interval (95 %). The mean is infinite, without an interval, where
        the best objective of a mission is 0 and that of a run is not; nor has a
        single mission an interval where no run differs.
    gap_median
        of all its runs that complete as much.
    wins, ties, losses
        missions on which its run in the middle is better than those of all others; as good as the best of them; worse.
    time_s
        mean time until it ended, by the comparison's clock.
    """

    allocator: str
    runs: int
    failed: int
    not_applicable: int
    as_much: float | None
    gap_mean: float | None
    gap_low: float | None
    gap_high: float | None
    gap_median: float | None
    wins: int
    ties: int
    losses: int
    time_s: float | None


@dataclass(frozen=True, kw_only=True)
class Pair:
    """Two allocators beside each other, on missions that both can take.

    Parameters
    ----------
    wins, ties, losses
        of the first, among what is paired.
    difference
        per cent of the objective of the first above that of the second: the median over the missions on which both
        complete as much; infinite on a mission where that of the second alone is 0.
    p_value, p_holm
        of the two-sided test that neither is better, and corrected for all pairs that are tested. None: there is
        nothing to test, as less than two of what is paired are there.
    exact
        whether the p-value is that of the exact distribution.
    units
        what is paired: `missions`, or `seeds` of a single mission; these once where no seed changes either allocator.
    """

    allocator: str
    other: str
    wins: int
    ties: int
    losses: int
    difference: float | None
    p_value: float | None
    p_holm: float | None
    exact: bool
    units: str


@dataclass(frozen=True)
class Profile:
    """The share of an allocator's runs whose objective is at most so many times the best on the mission.

    `ratios` and `shares` are the steps (k,): from each ratio on the share holds, up to the next.
    """

    allocator: str
    ratios: npt.NDArray[np.float64]
    shares: npt.NDArray[np.float64]


def require_scipy() -> None:
    """Raise MissingExtraError where SciPy is not installed."""
    with needs_extra("compare", "a comparison"):
        import scipy.stats  # noqa: F401


def standings_of(runs: Sequence[Run], allocators: Sequence[str]) -> tuple[Standing, ...]:
    """How each allocator stands, in the order given."""
    best, grouped = bests(runs), by_mission(runs)
    middles = [{name: typical(some) for name, some in own.items()} for own in grouped.values()]
    found = []
    for name in allocators:
        own = [run for run in runs if run.allocator == name]
        able = [run for run in own if run.status != NOT_APPLICABLE]
        gaps = [(run.mission, gap(run, best[run.mission])) for run in able]
        known = [(mission, value) for mission, value in gaps if value is not None]
        mean, low, high = mean_with_interval(_by_unit(known))
        as_much = [completes_as_much(run, best[run.mission]) for run in able]
        wins, ties, losses = _record(name, middles)
        found.append(
            Standing(
                allocator=name,
                runs=len(able),
                failed=sum(run.status in (FAILED, INVALID) for run in own),
                not_applicable=len({run.mission for run in own if run.status == NOT_APPLICABLE}),
                as_much=fmean(as_much) if as_much else None,
                gap_mean=mean,
                gap_low=low,
                gap_high=high,
                gap_median=median(value for _, value in known) if known else None,
                wins=wins,
                ties=ties,
                losses=losses,
                time_s=_mean([run.elapsed_s for run in able if run.elapsed_s is not None]),
            )
        )
    return tuple(found)


def pairs_of(runs: Sequence[Run], allocators: Sequence[str], against: str | None = None) -> tuple[Pair, ...]:
    """All pairs of allocators, or those with one of them; corrected for as many tests as there are."""
    pairs = [(a, b) for a, b in combinations(allocators, 2) if against in (None, a, b)]
    turned = [(a, b) if b == against else (b, a) if a == against else (a, b) for a, b in pairs]
    found = [_pair(runs, a, b) for a, b in turned]
    corrected = iter(holm([pair.p_value for pair in found if pair.p_value is not None]))
    return tuple(pair if pair.p_value is None else replace(pair, p_holm=next(corrected)) for pair in found)


def profiles_of(runs: Sequence[Run], allocators: Sequence[str]) -> tuple[Profile, ...]:
    """The performance profile of each allocator; a run without a plan, or that completes less, is never there."""
    best = bests(runs)
    found = []
    for name in allocators:
        ratios = [ratio(run, best[run.mission]) for run in runs if run.allocator == name]
        finite = np.array(sorted(one for one in ratios if math.isfinite(one)))
        steps, counts = np.unique(finite, return_counts=True)
        found.append(Profile(name, steps, np.cumsum(counts) / max(1, len(ratios))))
    return tuple(found)


def holm(p_values: Sequence[float]) -> list[float]:
    """P-values corrected for several tests [holm1979]."""
    corrected, least = [0.0] * len(p_values), 0.0
    for place, k in enumerate(sorted(range(len(p_values)), key=lambda k: p_values[k])):
        least = max(least, min(1.0, (len(p_values) - place) * p_values[k]))
        corrected[k] = least
    return corrected


def signed_rank(differences: Sequence[float]) -> tuple[float, bool]:
    """The p-value of Wilcoxon's signed ranks, two-sided, without differences of 0; and whether it is exact."""
    from scipy.stats import PermutationMethod, wilcoxon

    given = np.array([d for d in differences if d != 0])
    if len(given) == 0:
        return 1.0, True
    tied = len({*np.abs(given).tolist()}) < len(given)
    if not tied and len(given) <= _EXACT:
        return float(wilcoxon(given, method="exact").pvalue), True
    if len(given) <= _EXACT_WITH_TIES:
        return float(wilcoxon(given, method=PermutationMethod(n_resamples=2**_EXACT_WITH_TIES)).pvalue), True
    return float(wilcoxon(given, method="asymptotic", correction=True).pvalue), False


def mean_with_interval(values: Sequence[float]) -> tuple[float | None, float | None, float | None]:
    """The mean of some values, and the bounds of its confidence interval by the bootstrap; None where there is none."""
    if not values:
        return None, None, None
    mean = fmean(values)
    if len(values) == 1 or math.isinf(mean):
        return mean, None, None
    if close(min(values), max(values)):
        return mean, mean, mean
    from scipy.stats import bootstrap

    found = bootstrap(
        (np.array(values),),
        np.mean,
        confidence_level=_CONFIDENCE,
        n_resamples=_RESAMPLES,
        batch=100,
        method="percentile",
        rng=np.random.default_rng(0),
    ).confidence_interval
    return mean, float(found.low), float(found.high)


def _mean(values: Sequence[float]) -> float | None:
    return fmean(values) if values else None


def _by_unit(gaps: Sequence[tuple[str, float]]) -> list[float]:
    """The mean of each mission; of a single mission all its values, or one where they are equal."""
    own: dict[str, list[float]] = {}
    for mission, value in gaps:
        own.setdefault(mission, []).append(value)
    if len(own) != 1:
        return [fmean(values) for values in own.values()]
    (values,) = own.values()
    return values[:1] if close(min(values), max(values)) else values


def _record(name: str, middles: Sequence[dict[str, Rank]]) -> tuple[int, int, int]:
    """Missions on which an allocator wins, ties with the best, loses."""
    counts = [0, 0, 0]
    for ranks in middles:
        others = [rank for other, rank in ranks.items() if other != name]
        if name in ranks and others:
            counts[1 + max(order(ranks[name], rank) for rank in others)] += 1
    return counts[0], counts[1], counts[2]


def _pair(runs: Sequence[Run], a: str, b: str) -> Pair:
    both = list(_paired(runs, a, b))
    signs = [order(one, other) for one, other in both]
    p_value, exact = signed_rank(_signed_magnitudes(both)) if len(both) > 1 else (None, False)
    relative = [_above(one[1], other[1]) for one, other in both if close(one[0], other[0]) and math.isfinite(one[1])]
    return Pair(
        allocator=a,
        other=b,
        wins=signs.count(-1),
        ties=signs.count(0),
        losses=signs.count(1),
        difference=median(relative) if relative else None,
        p_value=p_value,
        p_holm=p_value,
        exact=exact,
        units="seeds" if len({run.mission for run in runs}) == 1 else "missions",
    )


def _above(value: float, other: float) -> float:
    """By how many per cent a value is above another; infinite above 0."""
    if close(value, other):
        return 0.0
    return 100 * (value / other - 1) if other > 0 else math.inf


def _paired(runs: Sequence[Run], a: str, b: str) -> Iterator[tuple[Rank, Rank]]:
    """The ranks of two allocators on each mission that both can take: of the run in the middle.

    Of a single mission: of each seed that both have.
    """
    grouped = by_mission(runs)
    for own in grouped.values():
        if a in own and b in own:
            yield from [(typical(own[a]), typical(own[b]))] if len(grouped) > 1 else _by_seed(own[a], own[b])


def _by_seed(of_a: Sequence[Run], of_b: Sequence[Run]) -> list[tuple[Rank, Rank]]:
    """The ranks of two allocators for each seed that both have.

    Where the seed changes neither of them they are one observation, however often it was made.
    """
    others = {run.seed: run.rank for run in of_b}
    both = [(run.rank, others[run.seed]) for run in of_a if run.seed in others]
    is_one = bool(both) and all(are_equal(ranks) for ranks in zip(*both, strict=True))
    return both[:1] if is_one else both


def _signed_magnitudes(both: Sequence[tuple[Rank, Rank]]) -> list[float]:
    """Differences whose sizes stand in the order of the lexicographic ones; below 0 where the first is better.

    A plan beside none differs more than any two plans; where weights differ more than where objectives alone do.
    Objectives differ by their ratio, as missions are of different sizes.
    """
    sizes = [_magnitude(one, other) for one, other in both]
    step = {size: 1.0 + k for k, size in enumerate(sorted({*sizes}))}
    return [order(one, other) * step[size] for (one, other), size in zip(both, sizes, strict=True)]


def _magnitude(one: Rank, other: Rank) -> tuple[float, float, float]:
    if order(one, other) == 0:
        return 0.0, 0.0, 0.0
    if math.isinf(one[0]) or math.isinf(other[0]):
        return 1.0, 0.0, 0.0
    if not close(one[0], other[0]):
        return 0.0, round(abs(one[0] - other[0]) / max(-one[0], -other[0]), 12), 0.0
    return 0.0, 0.0, round(1 - min(one[1], other[1]) / max(one[1], other[1]), 12)
