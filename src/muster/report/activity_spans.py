"""What robots did over time, from a record's events: spans of travel, waiting and work."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from muster.report.record import ExecutionEvent
from muster.report.record.mission_state import OUT

TRAVEL, WAITING, WORK = "travel", "waiting", "work"
_BEGINS = {"sets_out": TRAVEL, "arrives": WAITING, "starts": WORK, "returns": TRAVEL}
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

    A span ends when the robot begins something else, ends the task or fails, when the task is cancelled, lost, or given
    to another robot or to none by a new plan, and at the latest with the record.
    """
    found: list[Span] = []
    doing: dict[str, tuple[str, str, float]] = {}

    def close(robot: str, until_s: float) -> None:
        if robot in doing:
            task, kind, from_s = doing.pop(robot)
            if until_s > from_s or kind == WORK:
                found.append(Span(robot, task, kind, from_s, until_s))

    for event in events:
        task = event.data.get("task")
        for robot in event.data.get("team") or [str(event.data.get("robot"))]:
            if event.kind in _BEGINS:
                close(robot, event.time_s)
                doing[robot] = ("" if task is None else str(task), _BEGINS[event.kind], event.time_s)
            elif event.kind in _ENDS:
                close(robot, event.time_s)
        for one in [name for name, (of, kind, _) in doing.items() if _breaks_off(event, name, of, kind)]:
            close(one, event.time_s)
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
