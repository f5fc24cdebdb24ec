"""Table 2.2 of [tcf-thesis]: how it ranks three metaheuristics, from the literature."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

GENETIC, SWARM, COLONY = "order-crossover", "particle-swarm", "ant-colony"
"""The allocators that stand for GA, PSO and ACO: those that the section describes."""

RANKS: Mapping[str, tuple[str, str, str]] = MappingProxyType(
    {
        "computational demand": (SWARM, GENETIC, COLONY),
        "global search": (GENETIC, COLONY, SWARM),
        "robustness": (COLONY, GENETIC, SWARM),
    }
)
"""From the best to the worst."""
