"""The hot loops, in C++20. Called from `allocation` alone; a verb here has the name of the step it carries out."""

from muster.core._core import (
    Annealing,
    Bidders,
    Greedy,
    Insertion,
    Inspection,
    Matching,
    Population,
    Problem,
    Search,
    Team,
)

__all__ = [
    "Annealing",
    "Bidders",
    "Greedy",
    "Insertion",
    "Inspection",
    "Matching",
    "Population",
    "Problem",
    "Search",
    "Team",
]
