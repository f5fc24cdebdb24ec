"""The orders of a standing fleet: tasks that come while it is on duty, from their arrival to their end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from muster.state.quantiles import Quantiles

KEPT_REFUSED = 20
"""How many refused orders are listed: the last ones."""


@dataclass(frozen=True)
class RefusedOrder:
    """An order that did not fit.

    Parameters
    ----------
    at_s
        when it was refused, seconds by the mission's clock.
    kind, id
        what it was, as in a mission file, such as `cancel_task`; and of which task.
    reason
        field, value, and what was expected.
    """

    at_s: float
    kind: str
    id: str
    reason: str

    @classmethod
    def of(cls, event: Mapping[str, Any], reason: str, now: float) -> RefusedOrder:
        """From an event as in a mission file."""
        kind, what = next((key, value) for key, value in event.items() if key != "at_s")
        if isinstance(what, Mapping):
            what = next(what[key] for key in ("id", "task", "robot") if key in what)
        return cls(now, kind, what, reason)


@dataclass(frozen=True)
class Seconds:
    """How long something took: what half and 95 % of all did not exceed, and the longest; seconds."""

    median_s: float
    p95_s: float
    most_s: float

    @classmethod
    def of(cls, quantiles: Quantiles) -> Seconds:
        return cls(*(round(value, 4) for value in (quantiles.at(0.5), quantiles.at(0.95), quantiles.most)))


@dataclass(frozen=True, kw_only=True)
class OrdersReport:
    """Figures of the orders that came while a mission was carried out.

    Parameters
    ----------
    taken, done, cancelled, lost, refused
        how many came; of them were done, cancelled, lost; and how many more did not fit the mission.
    open
        how many are neither yet.
    most_open
        how many were open at once.
    done_per_hour
        by the mission's clock.
    until_in_route
        from its arrival until an order was in a route, by the mission's clock.
    until_done
        from its arrival until it was done.
    improved
        how often routes that a search in the background had found were taken over.
    clock_lag
        by how much the mission's clock was behind the wall clock, in a run in real time; None in another.
    not_taken_from_s
        when the first order comes that is not taken, as the fleet is on duty no longer then, seconds by the mission's
        clock; None: no such order is known.
    last_refused
        the last orders that were refused, at most 20, in order of time; why orders were lost is in `Report.tasks_lost`.
    """

    taken: int
    done: int
    cancelled: int
    lost: int
    refused: int
    open: int
    most_open: int
    done_per_hour: float
    until_in_route: Seconds
    until_done: Seconds
    improved: int
    clock_lag: Seconds | None = None
    not_taken_from_s: float | None = None
    last_refused: tuple[RefusedOrder, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


@dataclass
class Orders:
    """Counts orders by the events of a mission. What it keeps does not grow but with the orders that are open."""

    taken: int = 0
    done: int = 0
    cancelled: int = 0
    lost: int = 0
    refused: int = 0
    most_open: int = 0
    improved: int = 0
    until_in_route: Quantiles = field(default_factory=Quantiles)
    until_done: Quantiles = field(default_factory=Quantiles)
    last_refused: list[RefusedOrder] = field(default_factory=list)
    open_since: dict[str, float] = field(default_factory=dict)  # by order when it came
    waiting_since: dict[str, float] = field(default_factory=dict)  # those that have been in no route yet

    def come(self, task: str, came_s: float) -> None:
        """A task was ordered."""
        self.taken += 1
        self.open_since[task] = self.waiting_since[task] = came_s
        self.most_open = max(self.most_open, len(self.open_since))

    def route(self, task: str, now: float) -> None:
        """A robot has a task in its route."""
        if task in self.waiting_since:
            self.until_in_route.add(now - self.waiting_since.pop(task))

    def refuse(self, event: Mapping[str, Any], reason: str, now: float) -> None:
        """An order does not fit."""
        self.refused += 1
        self.last_refused = [*self.last_refused, RefusedOrder.of(event, reason, now)][-KEPT_REFUSED:]

    def close(self, task: str, how: str, now: float) -> None:
        """A task is over: done, cancelled or lost."""
        if task not in self.open_since:
            return
        came_s = self.open_since.pop(task)
        self.waiting_since.pop(task, None)
        setattr(self, how, getattr(self, how) + 1)
        if how == "done":
            self.until_done.add(now - came_s)

    def report(
        self, over_s: float, not_taken_from_s: float | None = None, clock_lag: Quantiles | None = None
    ) -> OrdersReport | None:
        """Figures after so many seconds of the mission's clock; None if there was no order."""
        if not self.taken and not self.refused and not_taken_from_s is None:
            return None
        return OrdersReport(
            taken=self.taken,
            done=self.done,
            cancelled=self.cancelled,
            lost=self.lost,
            refused=self.refused,
            open=len(self.open_since),
            most_open=self.most_open,
            done_per_hour=round(3600 * self.done / over_s, 2) if over_s > 0 else 0.0,
            until_in_route=Seconds.of(self.until_in_route),
            until_done=Seconds.of(self.until_done),
            improved=self.improved,
            clock_lag=Seconds.of(clock_lag) if clock_lag is not None and clock_lag.count else None,
            not_taken_from_s=not_taken_from_s,
            last_refused=tuple(self.last_refused),
        )
