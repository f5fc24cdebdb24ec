"""Standing fleets: how long one stays on duty, which orders it gets, and what it forgets so that memory is bounded."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Real
from typing import Any, Protocol, overload

from muster.execution.record import Tell
from muster.execution.replanning.remaining_problem import RemainingMission
from muster.execution.robots.robot_state import RobotState
from muster.execution.script import checked_orders
from muster.execution.timing.forecast import Forecast
from muster.mission.errors import ParameterError
from muster.mission.model import Event
from muster.mission.value_types import shown
from muster.state import ExecutionEvent
from muster.state.task_events import Forgets, Lost
from muster.state.task_ledger import Ledger

KEEP_S, KEPT_EVENTS, KEPT_REVISIONS, LOOK_S = 300.0, 2_000, 10, 30.0
"""How long tasks that are done are remembered; how many events and plans are; seconds between two looks at them."""
BATCH_S = 0.2
"""Seconds in which orders are collected and planned for together."""


class Improver(Protocol):
    """Searches for better routes beside the executor, on a snapshot of what is left."""

    @property
    def due_s(self) -> float:
        """When, by the mission's clock, routes are to be asked for; inf while none are searched for."""
        ...

    def begin(self, rest: RemainingMission) -> None:
        """Search for better routes from this moment on."""
        ...

    def found(self, now: float) -> Mapping[str, Sequence[str]] | None:
        """The routes that were found, by robot, if it is time for them; it is idle then. Others keep theirs."""
        ...

    def close(self) -> None:
        """Search no more."""
        ...


@dataclass(frozen=True, kw_only=True)
class Standing:
    """A fleet that does not end when its tasks are done.

    Parameters
    ----------
    until_s
        until when it stays on duty and takes orders, seconds by the mission's clock; then it does what is open, and
        ends. None: until its last order; without orders until its tasks are done.
    orders
        events in order of time, read as time goes on: new tasks, and tasks cancelled, moved or delayed. Those after
        `until_s` are not taken, so they may be endless. With the objective `lateness` an order that says nothing else
        is due when it comes, so that what counts is how long each takes.
    improver
        searches in the background; None: what carries the mission out brings its own.
    searches
        whether routes are improved in the background; else orders are put into them as they come, and no more.
    keep_s
        how long tasks that are done or cancelled are remembered, and cannot be ordered again under the same id.
    batch_s
        orders that come within so many seconds are planned for together.

    Raises
    ------
    ParameterError
        if a time is no number or negative, `batch_s` is infinite, or `orders` is not iterable. Orders of a list or
        tuple that are no events are refused here, those of another iterable when they are read.
    """

    until_s: float | None = math.inf
    orders: Iterable[Event] = ()
    improver: Improver | None = None
    searches: bool = True
    keep_s: float = KEEP_S
    batch_s: float = BATCH_S

    def __post_init__(self) -> None:
        if self.until_s is not None:
            _require_seconds("until_s", self.until_s, "a number of at least 0, or None")
        _require_seconds("keep_s", self.keep_s, "a number of at least 0")
        _require_seconds("batch_s", self.batch_s, "a finite number of at least 0", finite=True)
        if not isinstance(self.orders, Iterable):
            raise ParameterError(f"orders: {shown(self.orders)}; expected an iterable of events")
        if isinstance(self.orders, list | tuple):  # an iterator must not be read ahead
            for _ in checked_orders(self.orders):
                pass

    @property
    def stays_until_s(self) -> float:
        """Until when it stays on duty though all is done; 0: only for orders to come."""
        return 0.0 if self.until_s is None else self.until_s

    @property
    def takes_orders_until_s(self) -> float:
        """Until when it takes orders; inf: to the last."""
        return math.inf if self.until_s is None else self.until_s

    @property
    def forgets(self) -> bool:
        """Whether anything is ever forgotten."""
        return self.keep_s < math.inf


def _require_seconds(name: str, value: Any, expected: str, *, finite: bool = False) -> None:
    is_number = isinstance(value, Real) and not isinstance(value, bool)
    if not is_number or not value >= 0 or (finite and value == math.inf):
        raise ParameterError(f"{name}: {shown(value)}; expected {expected}")


UNTIL_DONE = Standing(until_s=None, keep_s=math.inf)
"""No standing fleet: the mission ends when its tasks are done, and all is remembered."""


class EventLog(Sequence[ExecutionEvent]):
    """The events so far, or the last of them; each has the number under which it came.

    Parameters
    ----------
    most
        how many are kept; None: all.
    """

    def __init__(self, most: int | None = None) -> None:
        self._kept: list[ExecutionEvent] = []
        self._most, self.total = most, 0

    def append(self, event: ExecutionEvent) -> None:
        self._kept.append(event)
        self.total += 1
        if self._most is not None and len(self._kept) >= 2 * self._most:
            del self._kept[: -self._most]

    def since(self, number: int) -> list[ExecutionEvent]:
        """The events from a number on, as far as they are kept."""
        return self._kept[max(0, number - self.total + len(self._kept)) :]

    def __len__(self) -> int:
        return len(self._kept)

    @overload
    def __getitem__(self, index: int) -> ExecutionEvent: ...
    @overload
    def __getitem__(self, index: slice) -> list[ExecutionEvent]: ...
    def __getitem__(self, index: int | slice) -> ExecutionEvent | list[ExecutionEvent]:
        return self._kept[index]


@dataclass
class Forgetting:
    """Forgets tasks that were done, cancelled or lost a while ago, and that no task to come refers to.

    Parameters
    ----------
    ledger, crew, forecast
        of the executor.
    keep_s
        how long ago.
    emit
        receives events.
    """

    ledger: Ledger
    crew: Mapping[str, RobotState]
    forecast: Forecast
    keep_s: float
    emit: Tell
    _look_s: float = field(default=0.0, init=False)

    def look(self, now: float) -> None:
        """Forget what is due; what is neither done nor cancelled is lost thereby."""
        if now < self._look_s:
            return
        self._look_s = now + LOOK_S
        in_routes = {name for state in self.crew.values() for name in state.route}
        settled = self.ledger.settled(now - self.keep_s) - in_routes - self._last_done()
        gone = [name for name in self.ledger.tasks if name in settled]
        for name in gone:
            if self.ledger.is_open(name):
                self.emit(Lost(task=name, reason=self.ledger.barred[name]))
        if gone:
            self.emit(Forgets(tasks=tuple(gone)))
            self.forecast.forget()

    def _last_done(self) -> set[str]:
        """The last task of each robot, from which its way to the next is counted."""
        return {state.done[-1] for state in self.crew.values() if state.done}
