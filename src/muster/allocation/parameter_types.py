"""The parameters of the allocators that ship, for type checkers."""

from __future__ import annotations

from typing import TypedDict


class AllocatorParameters(TypedDict, total=False):
    """Parameters by name; which of them an allocator has is listed by `muster solve --list-allocators`."""

    annealing_steps: int
    battery_weight: float
    bid: str | None
    blink: float
    bounds: str
    bundle_size: int
    cold: float
    crossover_probability: float
    discount: float
    hot: float
    longest_string: int
    mutation_probability: float
    near: int
    parts: int
    placement: str
    population_size: int
    ray: str
    removed: float
    replaced_share: float
    ro: float
    start_mutants: int
    suitability_weight: float
    threads: int
    topology: str
    winner: str
