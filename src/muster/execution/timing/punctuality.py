"""Punctuality: notices tasks that cannot begin in time any more, and counts how long robots wait, and why."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from muster.execution.record import Tell
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.timing.beginning import Beginning
from muster.execution.timing.forecast import Forecast
from muster.model.under_way import Missed
from muster.state.task_events import MISSED
from muster.state.task_ledger import Ledger


@dataclass
class Punctuality:
    """Compares the clock with the times by which tasks must begin and end.

    Parameters
    ----------
    ledger, crew, beginning
        of the executor.
    emit, ask
        receive every event; those that ask for a new plan.
    waits_s
        by cause for how long robots have waited at tasks, in all.
    """

    ledger: Ledger
    crew: Mapping[str, RobotState]
    beginning: Beginning
    emit: Tell
    ask: Tell
    waits_s: dict[str, float] = field(default_factory=dict)
    _planned_s: dict[str, float] = field(default_factory=dict)
    _in_time_until_s: dict[str, float] = field(default_factory=dict)  # until when each task need not be looked at
    _revision: int = -1  # of the ledger, when that was found
    _timed: bool = False

    def expect(self, forecast: Forecast, now: float) -> None:
        """Note when tasks are going to begin by the routes as they are now."""
        self._timed = self.ledger.model.is_timed or any(state.limits.spans for state in self.crew.values())
        self._planned_s = (forecast.begins(now) or {}) if self._timed else {}
        self._in_time_until_s = {}

    def look(self, now: float) -> None:
        """Tasks that were not begun in time: those of routes ask for a new plan."""
        if not self._timed:
            return
        if self._revision != self.ledger.revision:
            self._in_time_until_s, self._revision = {}, self.ledger.revision
        barred = self.ledger.barred
        for task in list(self.ledger.tasks.values()):
            if now <= self._in_time_until_s.get(task.id, -math.inf):
                continue
            if task.id in self.ledger.starts_s or task.id in barred or not self.ledger.is_open(task.id):
                continue
            missed = self.beginning.missed(task.id, now)
            if missed is None:
                self._in_time_until_s[task.id] = self.beginning.in_time_until_s(task.id, now)
                missed = self._missed_opening(task.id, now)
            if missed is not None:
                tell = self.ask if self._is_routed(task.id) else self.emit
                tell(MISSED[missed.limit](task=task.id, reason=missed.reason, next_s=missed.next_s))

    def count_waits(self, seconds: float) -> None:
        """Robots have waited for so long, each for what it said last."""
        if not self._timed or seconds <= 0:
            return
        for state in self._waiting:
            cause = state.wait_cause or "prerequisite"
            self.waits_s[cause] = self.waits_s.get(cause, 0.0) + seconds

    def times(self, now: float) -> Iterator[float]:
        """When the clock alone lets a robot that waits begin, or one is about to arrive where it must ask."""
        if not self._timed:
            return
        for state in self.crew.values():
            if state.out or not state.route:
                continue
            if state.activity is Activity.WAITING:
                wait = self.beginning.wait(state.route[0], now)
                yield math.inf if wait is None else wait.until_s
            elif state.activity is Activity.DRIVING and not state.works:
                yield now + state.travel_left_m / state.robot.speed_mps

    def waits_for_clock(self, now: float) -> bool:
        """Whether some robot sets out or begins when time goes on, or a task that it waits for is given up then."""
        if any(state.rests_until_s > now and not state.out for state in self.crew.values()):
            return True
        if not self._timed:
            return False
        waits = [self.beginning.wait(state.route[0], now) for state in self._waiting]
        return any(wait is None or wait.until_s < math.inf for wait in waits)

    @property
    def _waiting(self) -> list[RobotState]:
        return [state for state in self.crew.values() if state.activity is Activity.WAITING and not state.out]

    def _is_routed(self, task: str) -> bool:
        return any(task in state.route for state in self.crew.values() if not state.out)

    def _missed_opening(self, task: str, now: float) -> Missed | None:
        """That a task was not begun when it was meant to, and may begin later."""
        planned_s = self._planned_s.get(task)
        missed = None if planned_s is None else self.ledger.model.missed_opening(task, planned_s, now)
        if missed is not None:
            del self._planned_s[task]
        return missed
