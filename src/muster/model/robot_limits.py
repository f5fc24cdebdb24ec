"""What rules ask of one robot under way, whatever it does: limits of its times, and stations that are not for it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Self

from muster.mission.model import Station
from muster.mission.system.clock import TIME_ROUNDING_S
from muster.model.parts import Openings
from muster.model.plan_model import PlanModel

_TIMES = ("over_by", "lasts_most", "spans")


@dataclass(frozen=True)
class RobotLimits:
    """The limits of one robot.

    Parameters
    ----------
    over_by_s
        when its route is over at the latest; inf: whenever.
    lasts_most_s
        how long it is under way at the most; inf: ever.
    spans
        when it drives and works; empty: at any time.
    closed
        the stations at which it does not call.
    words
        by primitive the word of the rule that gave the limit.
    """

    over_by_s: float = math.inf
    lasts_most_s: float = math.inf
    spans: Openings = field(default_factory=list)
    closed: frozenset[str] = frozenset()
    words: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, model: PlanModel, stations: Sequence[Station]) -> Self:
        """Return the limits of the only robot of a model."""
        return cls(
            float(model.over_by[0]),
            float(model.lasts_most[0]),
            model.spans(0),
            frozenset(station.id for k, station in enumerate(stations) if not model.may_call(0, k)),
            {limit: model.given_by(limit, 0) for limit in _TIMES},
        )

    def set_out(self, now_s: float, seconds: float) -> float:
        """Return from when on, not before now, it is busy for so long without a rest; inf: never again."""
        if not self.spans:
            return now_s
        tried = ((max(now_s, begins), ends) for begins, ends in self.spans)
        return next((begin for begin, ends in tried if begin + seconds <= ends + TIME_ROUNDING_S), math.inf)

    def back_s(self, free_s: float, home_s: float) -> float:
        """Return when it is at the end of its route, so many seconds away, if it is free at a time; inf: never."""
        return self.set_out(free_s, home_s) + home_s if home_s else free_s

    def due_s(self, left_s: float | None) -> float:
        """Return when it has to be back that left its start at a time, if it has; inf: whenever."""
        return min(self.over_by_s, math.inf if left_s is None else left_s + self.lasts_most_s)

    def too_late(self, free_s: float, home_s: float, left_s: float | None) -> str:
        """Return why it is back too late that is free at a time, and left its start at another, if it has; or ""."""
        back_s = self.back_s(free_s, home_s)
        if back_s == math.inf:
            return self.never("the way to its end")
        by_s = self.due_s(left_s)
        if back_s <= by_s + TIME_ROUNDING_S:
            return ""
        word = self.words["over_by" if by_s == self.over_by_s else "lasts_most"]
        return f"{word}: would be back at {back_s:,.1f} s, after {by_s:,g} s"

    def never(self, what: str) -> str:
        """Return why it never again has the time for something without a rest."""
        return f"{self.words['spans']}: none left lasts as long as {what}"


NO_LIMITS = RobotLimits()
"""The limits of a robot of which rules ask nothing."""
