"""The hot loops, in C++20. A verb here has the name of the step that it carries out.

Called from `allocation` and `motion` alone.
"""

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
    squared_distances,
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
    "squared_distances",
]
