"""The values of objectives: one definition for plans and for what was carried out (docs/design.md, Meaning)."""

from __future__ import annotations

from collections.abc import Collection, Iterable


def makespan(ends_s: Collection[float]) -> float:
    """When the last task ends, seconds; 0 without tasks. The ways to the robots' ends count where given."""
    return max(ends_s, default=0.0)


def lateness(done: Iterable[tuple[float, float, float | None]]) -> float:
    """The sum over tasks done of priority times seconds after the due time; `done` holds priority, end, due time."""
    return sum(priority * max(0.0, end - due) for priority, end, due in done if due is not None)


def objective_values(
    usages: Collection[float], arrivals: Collection[float], ends_s: Collection[float], late: float = 0.0
) -> dict[str, float]:
    """The value of each objective.

    Parameters
    ----------
    usages
        of all robots.
    arrivals
        for each task done the usage of its robot when it arrived at it.
    ends_s
        when each task done ended, seconds; with `rules.makespan_includes_return` when each robot was at its end too.
    late
        the `lateness` of the tasks done.
    """
    total, most = sum(usages), max(usages, default=0.0)
    return {
        "total": total,
        "max": most,
        "total+max": total + most,
        "average": sum(arrivals) / len(arrivals) if arrivals else 0.0,
        "makespan": makespan(ends_s),
        "lateness": late,
    }
