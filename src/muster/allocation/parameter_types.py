"""The parameters of the allocators that ship, for type checkers."""

from __future__ import annotations

from typing import TypedDict


class AllocatorParameters(TypedDict, total=False):
    """Parameters by name; which of them an allocator has is listed by `muster solve --list-allocators`."""

    acquiescence: float
    alpha: float
    annealing_steps: int
    battery_weight: float
    beta: float
    bid: str | None
    blink: float
    bounds: str
    bundle_size: int
    cold: float
    combinations: int
    crossover_probability: float
    discount: float
    elite: float
    evaporation: float
    group_size: int
    hot: float
    inertia: float
    leader: str
    leader_weight: float
    longest_string: int
    mutation_probability: float
    near: int
    order: str
    own_weight: float
    parts: int
    patience: float
    placement: str
    population_size: int
    precision: float
    quality_weight: float
    ray: str
    removed: float
    replaced_share: float
    ro: float
    seeds: int
    start_mutants: int
    suitability_weight: float
    threads: int
    topology: str
    winner: str
    worth: float
