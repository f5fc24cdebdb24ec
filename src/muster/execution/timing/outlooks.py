"""Where robots will go after what they do now: for who plans their traffic."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.task_motion import Work
from muster.execution.stations.slots import AT_STATION
from muster.execution.timing.beginning import Beginning
from muster.execution.timing.forecast import Forecast
from muster.motion.outlook import Outlook, Visit
from muster.state.robot_events import RobotFails, RobotRemoved, RobotSilent
from muster.state.task_ledger import Ledger


@dataclass(frozen=True)
class Outlooks:
    """Outlooks of an executor's robots.

    A robot's outlook ends before the first task that may have to wait for others or for the clock: until when it stays
    there nobody knows.
    """

    ledger: Ledger
    crew: Mapping[str, RobotState]
    beginning: Beginning
    forecast: Forecast

    def __call__(self, robot: str) -> Outlook:
        """Where a robot will go after where its last order leads."""
        state = self.crew[robot]
        if state.out == RobotRemoved.kind:
            return Outlook(gone=True, removed=True)
        if state.out in (RobotFails.kind, RobotSilent.kind):
            return Outlook(gone=True)
        at_home = state.home is not None and state.at_home and not state.route
        if state.activity in (Activity.WAITING, Activity.RETURNING, *AT_STATION) or (at_home and not state.calls):
            return Outlook(stays=True)
        if state.activity is Activity.IDLE or not state.route:
            return Outlook()
        if state.limits.spans:
            return Outlook()  # it may rest before each leg and work
        if state.activity is not Activity.WORKING and self._must_wait(state, state.route[0], state.done):
            return Outlook()
        visits, done = list[Visit](), [*state.done, state.route[0]]
        for task in state.route[1:]:
            work = self.forecast.work(state, task)
            if work is None or self._must_wait(state, task, done) or any(call.before == task for call in state.calls):
                return Outlook(tuple(visits))
            visits += _visits(work, self.ledger.delays_s.get(task, 0.0))
            done.append(task)
        if state.home is None or any(call.before is None for call in state.calls):
            return Outlook(tuple(visits))
        return Outlook((*visits, Visit(state.home, 0.0)), stays=True)

    def _must_wait(self, state: RobotState, task: str, done: list[str]) -> bool:
        return self.beginning.must_ask(task, state.robot) or any(name not in done for name in self.ledger.missing(task))


def _visits(work: Work, delay_s: float) -> Iterator[Visit]:
    """The stops of a task; those at one place are one."""
    at, hold_s = work.entry, 0.0
    for waypoint in work.waypoints:
        if waypoint.via:
            continue
        if waypoint.position != at:
            yield Visit(at, hold_s)
            at, hold_s = waypoint.position, 0.0
        hold_s += waypoint.hold_s
    yield Visit(at, hold_s + delay_s)
