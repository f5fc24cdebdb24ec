"""The values of objectives: one definition for plans and for what was carried out (docs/design.md, Meaning)."""

from __future__ import annotations

from collections.abc import Collection


def makespan(ends_s: Collection[float]) -> float:
    """When the last task ends, seconds; 0 without tasks. The ways of robots to their ends do not count."""
    return max(ends_s, default=0.0)


def objective_values(
    usages: Collection[float], arrivals: Collection[float], ends_s: Collection[float]
) -> dict[str, float]:
    """The value of each objective.

    Parameters
    ----------
    usages
        of all robots.
    arrivals
        for each task done the usage of its robot when it arrived at it.
    ends_s
        when each task done ended, seconds.
    """
    total, most = sum(usages), max(usages, default=0.0)
    return {
        "total": total,
        "max": most,
        "total+max": total + most,
        "average": sum(arrivals) / len(arrivals) if arrivals else 0.0,
        "makespan": makespan(ends_s),
    }
