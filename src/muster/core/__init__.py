"""The hot loops, in C++20, for `allocation` and `motion` alone; a verb here has the name of the step it carries out."""

from muster.core._core import (
    AirWays,
    Annealing,
    Bidders,
    Greedy,
    GridMap,
    Insertion,
    Inspection,
    Matching,
    Population,
    Problem,
    Search,
    Team,
    Tree,
    Ways,
)

__all__ = [
    "AirWays",
    "Annealing",
    "Bidders",
    "Greedy",
    "GridMap",
    "Insertion",
    "Inspection",
    "Matching",
    "Population",
    "Problem",
    "Search",
    "Team",
    "Tree",
    "Ways",
]
