"""The allocators by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from muster.allocation.allocator import Allocator
from muster.allocation.auction import AUCTION
from muster.allocation.consensus_bundle import CONSENSUS_BUNDLE
from muster.allocation.genetic import GENETIC
from muster.allocation.greedy import GREEDY
from muster.allocation.greedy_genetic import GREEDY_GENETIC
from muster.allocation.greedy_hill_climbing import GREEDY_HILL_CLIMBING
from muster.allocation.hill_climbing import HILL_CLIMBING
from muster.allocation.market import MARKET
from muster.allocation.search import SEARCH
from muster.mission.errors import ParameterError
from muster.mission.near_matches import did_you_mean

_IMPLEMENTATIONS = (
    GREEDY,
    HILL_CLIMBING,
    GENETIC,
    GREEDY_HILL_CLIMBING,
    GREEDY_GENETIC,
    AUCTION,
    MARKET,
    CONSENSUS_BUNDLE,
    SEARCH,
)

ALLOCATORS: Mapping[str, Allocator] = MappingProxyType({a.name: a for a in _IMPLEMENTATIONS})


def allocator_named(name: str) -> Allocator:
    """The allocator of that name.

    Raises
    ------
    ParameterError
        if there is none.
    """
    if name not in ALLOCATORS:
        hint = did_you_mean(str(name), ALLOCATORS)
        raise ParameterError(f"allocator: {name}; expected {', '.join(ALLOCATORS)}{hint}")
    return ALLOCATORS[name]
