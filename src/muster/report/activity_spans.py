"""What robots did over time, from a record's events: spans of travel, waiting, work, and waiting in traffic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from muster.report.record import ExecutionEvent
from muster.report.record.mission_state import OUT

TRAVEL, WAITING, WORK, TRAFFIC = "travel", "waiting", "work", "traffic"
_BEGINS = {"sets_out": TRAVEL, "arrives": WAITING, "starts": WORK, "returns": TRAVEL}
WAITS_IN_TRAFFIC, GOES_ON = "waits_in_traffic", "goes_on"
_ENDS = ("ends", "robot_at_end")
_BREAKS_OFF = (*OUT, "cancel_task", "lost", "work_broken_off")


@dataclass(frozen=True)
class Span:
    """What a robot does, for which task, from when until when, seconds; no task on the way to the route's end."""

    robot: str
    task: str
    kind: str
    from_s: float
    until_s: float


def spans(events: Sequence[ExecutionEvent], duration_s: float) -> list[Span]:
    """The spans in a record's events, in the order of their ends; of spans without length only work is included.

    Waiting in traffic interrupts travel, and lies upon work. A span ends when the robot begins something else, ends the task or fails, when the task is cancelled, lost, or given
    to another robot or to none by a new plan, and at the latest with the record.
    """
    found: list[Span] = []
    held_up: dict[str, tuple[str, float]] = {}  # for which task, since when
    meanwhile: dict[str, float] = {}  # when what was held up ended
    doing: dict[str, tuple[str, str, float]] = {}

    def close(robot: str, until_s: float) -> None:
        if robot in doing:
            task, kind, from_s = doing.pop(robot)
            if from_s == math.inf:
                meanwhile[robot] = until_s
            if until_s > from_s or kind == WORK:
                found.append(Span(robot, task, kind, from_s, until_s))

    def hold_up(robot: str, from_s: float) -> None:
        task, kind, since_s = doing.get(robot, ("", WORK, 0.0))
        held_up[robot] = task, from_s
        if kind == TRAVEL:
            close(robot, max(since_s, from_s))
            doing[robot] = task, TRAVEL, math.inf  # goes on when it is let go

    def let_go(robot: str, until_s: float) -> None:
        task, from_s = held_up.pop(robot)
        found.append(Span(robot, task, TRAFFIC, from_s, until_s))
        ended_s = meanwhile.pop(robot, until_s)
        if robot in doing and doing[robot][2] == math.inf:
            doing[robot] = *doing[robot][:2], until_s
        elif ended_s > until_s:
            found.append(Span(robot, task, TRAVEL, until_s, ended_s))

    for event in events:
        if event.kind == WAITS_IN_TRAFFIC:
            hold_up(str(event.data["robot"]), float(event.data["since_s"]))
            continue
        if event.kind == GOES_ON and event.data["robot"] in held_up:
            let_go(str(event.data["robot"]), float(event.data["until_s"]))
            continue
        task = event.data.get("task")
        for robot in event.data.get("team") or [str(event.data.get("robot"))]:
            if event.kind in _BEGINS:
                close(robot, event.time_s)
                doing[robot] = ("" if task is None else str(task), _BEGINS[event.kind], event.time_s)
            elif event.kind in _ENDS:
                close(robot, event.time_s)
        for one in [name for name, (of, kind, _) in doing.items() if _breaks_off(event, name, of, kind)]:
            close(one, event.time_s)
    for one in list(held_up):
        let_go(one, duration_s)
    for one in list(doing):
        close(one, duration_s)
    return found


def _breaks_off(event: ExecutionEvent, robot: str, task: str, kind: str) -> bool:
    """Whether an event ends what a robot does for a task."""
    if event.kind in _BREAKS_OFF:
        who = event.data.get("robot")
        of_task = who is None or event.kind == "work_broken_off"
        return who == robot or (of_task and event.data.get("task") == task)
    if event.kind == "replanned" and kind != WORK:
        return task in event.data.get("dropped", {}) or event.data.get("moved", {}).get(task, [""])[0] == robot
    return False
