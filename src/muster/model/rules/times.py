"""Times in the words of reasons: seconds, and the time of day where the mission says when it starts."""

from __future__ import annotations

import math

from muster.mission.values.time_types import clock_text
from muster.model.rules.rule import ROUNDING, Limits, Question, listed

_DIGITS = (2, 4, 6, 9)
_LONGEST = 1e9  # seconds, up to which times are said as times of day


def moments(problem: Question, *times: float) -> tuple[str, ...]:
    """Times since the start, with as many digits as tell them apart."""
    said = zip(times, spans(*times), strict=True)
    return tuple(f"{seconds}{_of_day(problem, time)}" for time, seconds in said)


def spans(*times: float) -> tuple[str, ...]:
    """How long things take, with as many digits as tell them apart."""
    digits = next((d for d in _DIGITS if len({_seconds(t, d) for t in times}) == len(set(times))), _DIGITS[-1])
    return tuple(_seconds(time, digits) for time in times)


def span(seconds: float) -> str:
    """How long something takes."""
    return _seconds(seconds, _DIGITS[0])


def longer(seconds: float) -> str:
    """How much more time is needed, rounded up, so that it stays enough."""
    return span(math.ceil(seconds * 100 * (1 - 1e-10)) / 100)


def known_least(until: float | None, at_least: float | None) -> str:
    """Whether less is proven to be too little."""
    found = "enough (a plan was found)"
    if until is None or at_least is None or at_least < until * (1 - ROUNDING):
        return f"{found}; whether less is enough is not known"
    return f"{found}, and less is not (proven)"


def reaches(limits: Limits, i: int, j: int) -> tuple[str, float]:
    """What a robot and a task wait for, and until when at the earliest: the way there, a prerequisite, a team."""
    arrival, ready = float(limits.arrival[i, j]), float(limits.ready[j])
    if arrival >= ready * (1 - ROUNDING):
        return "arrives at", arrival
    before, others = limits.awaited[j], limits.rules.beginning_with(j)
    if before is not None:
        return f"begins after {limits.problem.tasks[before].id}, at", ready
    if others:
        return f"begins together with {listed([limits.problem.tasks[k].id for k in others])}, at", ready
    return "its team is there at", ready


def _seconds(time: float, digits: int) -> str:
    text = f"{time:,.{digits}f}".rstrip("0").rstrip(".")
    return f"{text} s"


def _of_day(problem: Question, time: float) -> str:
    start = problem.mission.starts_at
    return "" if start is None or time > _LONGEST else f" ({clock_text(time, start)})"


def rounded(seconds: float) -> str:
    """A time in words that are said under way."""
    return f"{round(seconds, 1):,g} s"
