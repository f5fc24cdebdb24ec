"""What robots did over time, from a record's events: travel, waiting, work, service at stations, waiting in traffic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from muster.mission.stations import station_sign
from muster.state import ExecutionEvent
from muster.state.robots import OUT

TRAVEL, WAITING, WORK, TRAFFIC, SERVICE = "travel", "waiting", "work", "traffic", "service"
_BEGINS = {
    "sets_out": TRAVEL,
    "arrives": WAITING,
    "starts": WORK,
    "returns": TRAVEL,
    "goes_to_station": TRAVEL,
    "arrives_at_station": WAITING,
    "service_begins": SERVICE,
}
WAITS_IN_TRAFFIC, GOES_ON = "waits_in_traffic", "goes_on"
_ENDS = ("ends", "robot_at_end", "service_ends")
_BREAKS_OFF = (*OUT, "cancel_task", "lost", "work_broken_off")


@dataclass(frozen=True)
class Span:
    """What a robot does, for which task or station, from when until when, seconds.

    Both are empty on the way to the route's end.
    """

    robot: str
    task: str
    kind: str
    from_s: float
    until_s: float
    station: str = ""

    @property
    def goal(self) -> str:
        """The task, or the station in brackets."""
        return station_sign(self.station) if self.station else self.task


class _Goal(NamedTuple):
    task: str = ""
    station: str = ""


def spans(events: Sequence[ExecutionEvent], duration_s: float) -> list[Span]:
    """The spans in a record's events, in the order of their ends; of those without length only work and service.

    Waiting in traffic interrupts travel, and lies upon work. A span ends when the robot begins something else, ends the
    task or fails, when the task is cancelled, lost, or given to another robot or to none by a new plan, and at the
    latest with the record.
    """
    activities = _Activities()
    for event in events:
        activities.take(event)
    return activities.ended(duration_s)


class _Activities:
    """What robots do as events tell it, and the spans that are over."""

    def __init__(self) -> None:
        self._found: list[Span] = []
        self._doing: dict[str, tuple[_Goal, str, float]] = {}  # robot: goal, kind, since when; inf while it is held up
        self._held_up: dict[str, tuple[_Goal, float]] = {}  # robot: goal, since when
        self._ended_s: dict[str, float] = {}  # when travel ended of a robot that was held up until then, or so

    def take(self, event: ExecutionEvent) -> None:
        if event.kind == WAITS_IN_TRAFFIC:
            self._hold_up(str(event.data["robot"]), float(event.data["since_s"]))
        elif event.kind == GOES_ON:
            self._let_go(str(event.data["robot"]), float(event.data["until_s"]))
        else:
            self._begin_or_end(event)

    def ended(self, duration_s: float) -> list[Span]:
        """All spans, of a record that ends then."""
        for robot in list(self._held_up):
            self._let_go(robot, duration_s)
        for robot in list(self._doing):
            self._close(robot, duration_s)
        return self._found

    def _begin_or_end(self, event: ExecutionEvent) -> None:
        task, station = event.data.get("task"), event.data.get("station")
        goal = _Goal("" if task is None else str(task), "" if station is None else str(station))
        for robot in event.data.get("team") or [str(event.data.get("robot"))]:
            if event.kind in _BEGINS:
                self._begin(robot, goal, _BEGINS[event.kind], event.time_s)
            elif event.kind in _ENDS:
                self._close(robot, event.time_s)
        for one in [name for name, (of, kind, _) in self._doing.items() if _breaks_off(event, name, of.task, kind)]:
            self._close(one, event.time_s)

    def _begin(self, robot: str, goal: _Goal, kind: str, now: float) -> None:
        self._close(robot, now)
        still_held_up = kind == TRAVEL and robot in self._held_up
        if still_held_up:
            self._ended_s.pop(robot, None)
        self._doing[robot] = goal, kind, math.inf if still_held_up else now

    def _close(self, robot: str, until_s: float) -> None:
        if robot not in self._doing:
            return
        goal, kind, from_s = self._doing.pop(robot)
        if from_s == math.inf:
            self._ended_s[robot] = until_s
        elif until_s > from_s or kind in (WORK, SERVICE):
            self._found.append(Span(robot, goal.task, kind, from_s, until_s, goal.station))

    def _hold_up(self, robot: str, from_s: float) -> None:
        goal, kind, since_s = self._doing.get(robot, (_Goal(), WORK, 0.0))
        self._held_up[robot] = goal, max(since_s, from_s)
        if kind == TRAVEL:
            self._close(robot, max(since_s, from_s))
            self._doing[robot] = goal, TRAVEL, math.inf

    def _let_go(self, robot: str, until_s: float) -> None:
        """It goes on with its travel, if that did not end meanwhile."""
        if robot not in self._held_up:
            return
        goal, from_s = self._held_up.pop(robot)
        ended_s = self._ended_s.pop(robot, until_s)
        self._found.append(Span(robot, goal.task, TRAFFIC, from_s, max(from_s, min(until_s, ended_s)), goal.station))
        if robot in self._doing and self._doing[robot][2] == math.inf:
            self._doing[robot] = *self._doing[robot][:2], until_s
        elif ended_s > until_s:
            self._found.append(Span(robot, goal.task, TRAVEL, until_s, ended_s, goal.station))


def _breaks_off(event: ExecutionEvent, robot: str, task: str, kind: str) -> bool:
    """Whether an event ends what a robot does for a task."""
    if event.kind in _BREAKS_OFF:
        who = event.data.get("robot")
        of_task = who is None or event.kind == "work_broken_off"
        return who == robot or (of_task and event.data.get("task") == task)
    if event.kind == "replanned" and kind != WORK:
        return task in event.data.get("dropped", {}) or event.data.get("moved", {}).get(task, [""])[0] == robot
    return False
