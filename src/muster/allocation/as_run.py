"""The random algorithms of [tcf-thesis] as its published runs had them: Table A.15.

They differ from those of section 3.2.2 by the bounds of mutation alone (`bounds_of_mutation`). This is inferred from
the published values, not printed: from the greedy plan of eil51 with five salesmen these bounds, and no other that were
tried, end at each of the four values of Table A.15 (787.23, 774.59, 780.42 and 775.01).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from muster.allocation import genetic, greedy_genetic, greedy_hill_climbing, hill_climbing
from muster.allocation.bounds_of_mutation import AS_RUN


@dataclass(frozen=True, kw_only=True)
class ClimbingParameters(hill_climbing.Parameters):
    """Parameters of hill climbing, with the bounds of the published runs."""

    bounds: str = AS_RUN


@dataclass(frozen=True, kw_only=True)
class GeneticParameters(genetic.Parameters):
    """Parameters of the genetic algorithm, with the bounds of the published runs."""

    bounds: str = AS_RUN


HILL_CLIMBING_AS_RUN = replace(
    hill_climbing.HILL_CLIMBING,
    name="hill-climbing-as-run",
    summary="hill climbing as the thesis' runs of HCTA had it: trapped early",
    parameters=ClimbingParameters,
)
GENETIC_AS_RUN = replace(
    genetic.GENETIC,
    name="genetic-as-run",
    summary="the genetic algorithm as the thesis' runs of GenTA had it",
    parameters=GeneticParameters,
)
GREEDY_HILL_CLIMBING_AS_RUN = replace(
    greedy_hill_climbing.GREEDY_HILL_CLIMBING,
    name="greedy+hill-climbing-as-run",
    summary="greedy, then hill climbing as the thesis' runs of GrdHCTA had it",
    parameters=ClimbingParameters,
)
GREEDY_GENETIC_AS_RUN = replace(
    greedy_genetic.GREEDY_GENETIC,
    name="greedy+genetic-as-run",
    summary="greedy, then the genetic algorithm as the thesis' runs of GrdGenTA had it",
    parameters=GeneticParameters,
)
