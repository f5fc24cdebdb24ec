"""The hot loops, in C++20. A verb here has the name of the step that it carries out.

Called from `allocation` and `motion` alone.
"""

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
    squared_distances,
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
    "squared_distances",
]
