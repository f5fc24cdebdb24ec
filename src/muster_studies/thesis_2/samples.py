"""The runs of the comparison, and the figures made from them.

All anytime allocators have the same processor time on every mission, whatever else the machine does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt
from statistics import fmean, stdev
from typing import Any

from muster.allocation.registry import allocator_named
from muster_studies.effort import QUICK_SEEDS, Effort
from muster_studies.runs import Case, Outcome, mission_named

SALESMEN = ("eil51-5-thesis", "berlin52-5-thesis")
TEST_CASES = ("16T-3R", "24T-5R", "31T-6R50")
SEARCH_AND_RESCUE = ("market-rescue-20",)
MISSIONS = (*SALESMEN, *TEST_CASES, *SEARCH_AND_RESCUE)

METAHEURISTICS = ("particle-swarm", "ant-colony", "order-crossover", "ipga", "genetic", "greedy+genetic", "search")
MARKETS = (
    "contract-net",
    "alliance",
    "auction",
    "combinatorial-auction",
    "bertsekas-auction",
    "consensus-bundle",
    "market",
)
ALLOCATORS = ("greedy", *METAHEURISTICS, *MARKETS)

SECONDS, QUICK_SECONDS, SEEDS = 0.2, 0.05, 30

Samples = Mapping[Any, Any]


def seconds(effort: Effort) -> float:
    """Of processor time for an anytime allocator."""
    return QUICK_SECONDS if effort.quick else SECONDS


def seed_count(effort: Effort) -> int:
    return effort.seeds or (QUICK_SEEDS if effort.quick else SEEDS)


def cases(effort: Effort) -> dict[tuple[str, str], Case]:
    """By allocator and mission."""
    return {(name, mission): _case(name, mission, effort) for name in ALLOCATORS for mission in MISSIONS}


def _case(allocator: str, mission: str, effort: Effort) -> Case:
    anytime = allocator_named(allocator).anytime
    return Case(
        mission=mission,
        allocator=allocator,
        objective=mission_named(mission).rules.objective,
        iterations=effort.iterations if anytime else None,
        time_limit=seconds(effort) if anytime and effort.iterations is None else None,
        processor_time=True,
    )


@dataclass(frozen=True)
class Excesses:
    """By how many per cent the plans of an allocator are above the best known, for each seed and mission.

    `fewer` is the share of plans that do less than the best; they have no excess.
    """

    by_mission: Mapping[str, tuple[float | None, ...]]

    @property
    def fewer(self) -> float:
        every = [excess for row in self.by_mission.values() for excess in row]
        return sum(excess is None for excess in every) / len(every)

    def mean(self, missions: Sequence[str] = MISSIONS) -> float | None:
        """The mean of the missions' means."""
        means = [fmean(done) for mission in missions if (done := self._done(mission))]
        return fmean(means) if means else None

    def half_interval(self) -> float | None:
        """Half of the 95 % confidence interval of the mean over missions, from its values seed by seed."""
        rows = [row for row in self.by_mission.values() if len(row) > 1]
        if not rows:
            return None
        by_seed = [[row[k] for row in rows if row[k] is not None] for k in range(len(rows[0]))]
        means = [fmean(done) for seed in by_seed if (done := [one for one in seed if one is not None])]
        return half_interval(means)

    def worst(self) -> float | None:
        """The mean over missions of the worst seed's excess."""
        worst = [max(done) for mission in self.by_mission if (done := self._done(mission))]
        return fmean(worst) if worst else None

    def _done(self, mission: str) -> list[float]:
        return [excess for excess in self.by_mission[mission] if excess is not None]


def half_interval(values: Sequence[float]) -> float | None:
    """Half of the 95 % confidence interval of a mean, by Student's distribution; None of less than two values."""
    from scipy.stats import t

    if len(values) < 2:
        return None
    return float(t.ppf(0.975, len(values) - 1)) * stdev(values) / sqrt(len(values))


def excesses(effort: Effort, found: Samples) -> dict[str, Excesses]:
    """By allocator."""
    own = cases(effort)
    best = {mission: _best(found, [own[name, mission] for name in ALLOCATORS]) for mission in MISSIONS}
    return {
        name: Excesses(
            {
                mission: tuple(_excess(one, best[mission]) for one in found[own[name, mission]].outcomes)
                for mission in MISSIONS
            }
        )
        for name in ALLOCATORS
    }


def _best(found: Samples, of: Sequence[Case]) -> Outcome:
    """The best plan that any allocator found with any seed."""
    best: Outcome = min((found[case].best for case in of), key=lambda outcome: outcome.rank)
    return best


def _excess(outcome: Outcome, best: Outcome) -> float | None:
    if outcome.verdict.weight_completed < best.verdict.weight_completed:
        return None
    return 100.0 * (outcome.value / best.value - 1.0)
