"""A run's report as rows of tables: planned beside flown, for each robot and each task."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from muster.state.reasons import is_no_loss, was_cancelled

UNKNOWN = "not told"
ROBOT_HEADS = ("robot", "planned", "flown", "more or less")
TASK_HEADS = ("task", "robot", "planned", "flown", "more or less", "waited, s", "began, s", "ended, s")


def objective(report: Mapping[str, Any]) -> str:
    """`213.6 planned, 214.6 flown`."""
    planned, flown = report["objective"]["planned"], report["objective"]["flown"]
    return f"{UNKNOWN if planned is None else f'{planned:.1f}'} planned, {flown:.1f} flown"


def robot_rows(report: Mapping[str, Any]) -> list[Sequence[str]]:
    """For `ROBOT_HEADS`."""
    return [(one["robot"], *_compared(one)) for one in report["robots"]]


def task_rows(report: Mapping[str, Any]) -> list[Sequence[str]]:
    """For `TASK_HEADS`: tasks that were done, in the order in which they ended."""
    starts, ends = report["starts_s"], report["ends_s"]
    return [
        (
            one["task"],
            one["robot"],
            *_compared(one),
            f"{one['waiting_s']:.1f}",
            *(f"{times[one['task']]:.1f}" if one["task"] in times else "" for times in (starts, ends)),
        )
        for one in report["tasks"]
    ]


def lost_rows(report: Mapping[str, Any]) -> list[Sequence[str]]:
    """Each task that was lost though it was wanted, and why."""
    return [(one["task"], one["reason"]) for one in report["tasks_lost"] if not is_no_loss(one["reason"])]


def cancelled_rows(report: Mapping[str, Any]) -> list[Sequence[str]]:
    """Each task that was cancelled, and when: `cancelled at 3 s`."""
    return [(one["task"], one["reason"]) for one in report["tasks_lost"] if was_cancelled(one["reason"])]


def seconds(value: float) -> str:
    """`251.7 s`."""
    return f"{value:.1f} s"


def _compared(one: Mapping[str, Any]) -> tuple[str, str, str]:
    planned, flown = one["usage_planned"], one["usage_flown"]
    return f"{planned:.2f}", f"{flown:.2f}", f"{flown - planned:+.2f}"
