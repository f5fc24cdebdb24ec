"""What is to happen while a mission is carried out: the events of its file, and orders as a source tells them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from muster.execution.changes import may_bring_work
from muster.mission.errors import ParameterError
from muster.mission.model import Event
from muster.mission.value_types import shown

_ROUNDING = 1e-9  # of a batch, by which an order may be past its end


class Script:
    """Events in order of time. A source of orders is read one order ahead, so it may be endless.

    Parameters
    ----------
    events
        of the mission file.
    orders
        events in order of time; one that comes late happens when it is read.
    batch_s
        orders are due together, at whole multiples of so many seconds; 0: each when it comes.
    since_s
        what was due by this time has happened before.
    until_s
        orders after it are not taken, and none is read after the first of them.

    Raises
    ------
    ParameterError
        if an order is no event, when it is read: the first here, the next ones by `due`.
    """

    def __init__(
        self,
        events: Sequence[Event],
        orders: Iterable[Event] = (),
        *,
        batch_s: float = 0.0,
        since_s: float = -math.inf,
        until_s: float = math.inf,
    ) -> None:
        self._batch_s, self._until_s = batch_s, until_s
        self._events = sorted((e for e in events if e.at_s > since_s), key=lambda event: event.at_s)
        self._orders = (order for order in checked_orders(orders) if order.at_s > since_s)
        self._not_taken_from_s: float | None = None
        self._next = self._read()

    @property
    def not_taken_from_s(self) -> float | None:
        """When the first order comes that is not taken, as far as orders have been read; None: none so far."""
        return self._not_taken_from_s

    @property
    def next_s(self) -> float:
        """When the next event is due; inf if there is none."""
        return min([self._order_due_s, *(event.at_s for event in self._events[:1])])

    def due(self, now: float) -> Iterator[Event]:
        """Take the events that are due."""
        while self._events and self._events[0].at_s <= now:
            yield self._events.pop(0)
        while self._next is not None and self._order_due_s <= now:
            order, self._next = self._next, self._read()
            yield order

    def may_bring_work(self, *, open_tasks: bool, cut_off: bool) -> bool:
        """Whether anything to come can bring work, a robot for what is open, or one that is cut off to its end.

        An order left can: what comes after it is not known before it is taken.
        """
        if self._next is not None:
            return True
        return any(may_bring_work(event, open_tasks=open_tasks, cut_off=cut_off) for event in self._events)

    def _read(self) -> Event | None:
        """The next order that is taken; None: there is none."""
        order = next(self._orders, None)
        if order is None or order.at_s <= self._until_s:
            return order
        self._not_taken_from_s = order.at_s
        return None

    @property
    def _order_due_s(self) -> float:
        if self._next is None:
            return math.inf
        if self._batch_s == 0:
            return self._next.at_s
        return math.ceil(self._next.at_s / self._batch_s - _ROUNDING) * self._batch_s


def checked_orders(orders: Iterable[Event]) -> Iterator[Event]:
    """The orders, each checked when it is read.

    Raises
    ------
    ParameterError
        if one is no event: which, counted from 1.
    """
    for number, order in enumerate(orders, 1):
        if not isinstance(order, Event):
            raise ParameterError(f"orders: number {number}: {shown(order)}; expected an Event")
        yield order
