"""Which events of a robot's executor it reports: those that nobody else knows of."""

from __future__ import annotations

from muster.execution import ExecutionEvent
from muster.state.task_events import MISSED

MISSES = frozenset(event.kind for event in MISSED.values())
ITS_OWN = {
    "sets_out",
    "arrives",
    "starts",
    "ends",
    "returns",
    "robot_at_end",
    "no_way_to_end",
    "robot_sent_again",
    "robot_runs_low",
    "robot_stuck",
    "robot_stands_aside",
    "robot_goes_round",
    "robot_makes_room",
    "way_closed",
    "waits_in_traffic",
    "goes_on",
    "traffic_jam",
    "task_refused",
    "waits",
    "work_broken_off",
    *MISSES,
}
"""Events that nobody else knows of."""

REFUSALS = {"task_refused", *MISSES}
"""Of these, those that say why a robot does not do a task."""


def is_back(event: ExecutionEvent) -> bool:
    """Whether a robot that was stuck takes part again because it moves: no operator has told that."""
    return event.kind == "robot_returns" and "reason" in event.data
