"""The values of objectives: one definition for plans and for what was carried out (docs/design.md, Meaning)."""

from __future__ import annotations

from collections.abc import Collection, Iterable


def makespan(ends_s: Collection[float], returns_s: Collection[float] = ()) -> float:
    """When the last task ends, seconds; 0 without tasks.

    Parameters
    ----------
    returns_s
        when each robot that does tasks is at its end, with `rules.makespan_includes_return`; else the ways of robots to
        their ends do not count.
    """
    return max((*ends_s, *returns_s), default=0.0)


def lateness(work: Iterable[tuple[float, float, float | None]]) -> float:
    """The sum over tasks done of priority x seconds after the due time.

    Parameters
    ----------
    work
        for each task done its priority, its end in seconds, and its due time, None where it has none.
    """
    return sum((priority * max(0.0, end_s - due_s) for priority, end_s, due_s in work if due_s is not None), start=0.0)


def objective_values(
    usages: Collection[float],
    arrivals: Collection[float],
    ends_s: Collection[float],
    *,
    lateness_s: float = 0.0,
    returns_s: Collection[float] = (),
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
    lateness_s
        as `lateness` sums it up. Of two plans as late as each other the one of less total cost is the better one.
    returns_s
        as in `makespan`.
    """
    total, most = sum(usages), max(usages, default=0.0)
    return {
        "total": total,
        "max": most,
        "total+max": total + most,
        "average": sum(arrivals) / len(arrivals) if arrivals else 0.0,
        "makespan": makespan(ends_s, returns_s),
        "lateness": lateness_s,
    }
