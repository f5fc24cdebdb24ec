"""Rules on the time between two moments of one robot's route, which `schedule` holds the routes to."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import ClassVar

from muster.verification.measure import MeasuredRoute
from muster.verification.rules.limit_rule import LimitRule
from muster.verification.station_queues import Name


@dataclass(frozen=True)
class Span:
    """The most seconds between two moments of a route.

    Parameters
    ----------
    kind : str
        Word of the rule.
    robot : str
        Id of the robot whose route it is.
    after : Name or None
        Stop whose end is the first moment; None: the robot leaves its start.
    before : str or None
        Task whose begin is the second moment; None: the route ends, the way to its end included.
    most : float
        Most seconds between the two.
    said : str
        What takes that time, for people.
    """

    kind: str
    robot: str
    after: Name | None
    before: str | None
    most: float
    said: str

    def text(self, seconds: float) -> str:
        """Return what is wrong with routes that cannot keep the limit; `seconds` it takes at the earliest times."""
        return f"{self.said} takes {seconds:,.10g} s at the earliest times, and at none at most {self.most:,.10g} s"


class SpanRule(LimitRule):
    """A rule that sets limits to the time between two moments of a route."""

    relies_on: ClassVar[str | None] = None
    """The rule without which this one says nothing."""

    @abstractmethod
    def spans(self, route: MeasuredRoute) -> Iterator[Span]:
        """Yield the limits of a route that has stops."""

    def holds(self, ignored: Collection[str]) -> bool:
        """Return whether the rule holds where others are ignored."""
        return self.kind not in ignored and self.relies_on not in ignored
