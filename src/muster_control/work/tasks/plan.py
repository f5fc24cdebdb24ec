"""The task that plans a mission."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from muster.allocation.stop import Progress, Stop
from muster.planning.request import Request
from muster.planning.solving import answer
from muster_control.work.missions import mission_of, plan_of
from muster_control.work.tasks.check_request import checked_options

_MOST_POINTS = 200  # of the history that progress shows
_AT_MOST_EVERY_S = 0.1

Report = Callable[[dict[str, Any]], None]


def run(arguments: Mapping[str, Any], report: Report, interrupt: Stop) -> dict[str, Any]:
    """`{"mission", ...}` -> `{"plan", "why"}`: the plan as its file holds it, and why its bound holds or is missing.

    Beside the mission: `start` and `fixed` (plans), and the options of a planning request by their names. When
    `interrupt` is interrupted the search ends with its best plan, or with its first; a bound is then left out.
    """
    solution = answer(request_of(arguments), on_progress=_Reporter(report), interrupt=interrupt)
    return {"plan": solution.plan.as_dict(), "why": solution.why}


def request_of(arguments: Mapping[str, Any]) -> Request:
    """The planning request in plain data.

    Raises
    ------
    ParameterError, InputError
    """
    given = dict(arguments)
    mission = mission_of(given.pop("mission"))
    plans = {name: plan_of(plan, name) for name in ("start", "fixed") if (plan := given.pop(name, None)) is not None}
    return Request.of(checked_options(given), mission, **plans)


class _Reporter:
    """Reports progress as plain data, at most so often."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._reported = -math.inf

    def __call__(self, progress: Progress) -> None:
        if progress.elapsed_s < self._reported + _AT_MOST_EVERY_S:
            return
        self._reported = progress.elapsed_s
        self._report(
            {
                "elapsed_s": progress.elapsed_s,
                "share": progress.share,
                "weight": progress.weight,
                "objective": progress.objective if math.isfinite(progress.objective) else None,
                "bound": progress.bound,
                "history": thinned(progress.history),
            }
        )


def thinned(history: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """At most so many points of a history, the last among them."""
    step = -(-len(history) // _MOST_POINTS)
    return list(history[::-1][:: step or 1][::-1])
