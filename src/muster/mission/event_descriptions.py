"""The events of a mission file, each described in one line for people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_CANCELLED = "cancelled at "


def cancelled_at(at_s: float) -> str:
    """Why a task is not done that was cancelled."""
    return f"{_CANCELLED}{round(at_s, 1):g} s"


def was_cancelled(reason: object) -> bool:
    """Whether a task is not done because it was cancelled; reports and events have it with those that are lost."""
    return str(reason).startswith(_CANCELLED)


def tells_cancelled(kind: str, data: Mapping[str, Any]) -> bool:
    """Whether an event tells at the end that a task was cancelled."""
    return kind == "lost" and was_cancelled(data.get("reason"))


def event_line(kind: str, data: Mapping[str, Any]) -> str:
    """An event in a line for people: `starts: robot r_0, task 7`."""
    if kind == "replanned":
        return _replanned(data)
    if kind == "found":
        return found_line(data)
    if kind == "waits":
        return f"waits: robot {data.get('robot')}, task {data.get('task')}, {data.get('words')}"
    if tells_cancelled(kind, data):
        return f"not done: task {data.get('task')}, {data['reason']}"
    if kind in _SPECIAL:
        return _SPECIAL[kind](data)
    parts = [f"{key} {_short(value)}" for key, value in data.items() if value not in ({}, [], ())]
    return f"{kind.replace('_', ' ')}: {', '.join(parts)}" if parts else kind.replace("_", " ")


def found_line(data: Mapping[str, Any]) -> str:
    """`found: tag 5 at 4.02, 0.31 by r_0, sure to 0.05 m; becomes found-5`."""
    place = ", ".join(f"{value + 0.0:.2f}" for value in data.get("position", ()))
    robots, task = " ".join(data.get("robots", ())), data.get("task")
    line = f"found: tag {data.get('tag')} at {place} by {robots}, sure to {data.get('deviation_m', 0.0):.2f} m"
    return f"{line}; becomes {task}" if task else line


def _replanned(data: Mapping[str, Any]) -> str:
    """`replanned after robot_fails a: t from a to b, n to c; given up: x; nobody can do: y`."""
    causes = ", ".join(
        " ".join(_short(of) for of in cause.values() if of is not None) for cause in data.get("causes", ())
    )
    moved = [f"{task} from {robots[0]} to {robots[1]}" for task, robots in data.get("moved", {}).items()]
    added = [f"{task} to {robot}" for task, robot in data.get("added", {}).items()]
    line = f"replanned after {causes}: {', '.join([*moved, *added]) or 'no task changes robot'}"
    for words, tasks in (("given up", data.get("dropped", {})), ("nobody can do", data.get("left_out", {}))):
        line += f"; {words}: {', '.join(tasks)}" if tasks else ""
    return line


def _waits_in_traffic(data: Mapping[str, Any]) -> str:
    return f"waits in traffic: robot {data.get('robot')}, for {data.get('waits_for')}, at {_place(data)}"


def _goes_on(data: Mapping[str, Any]) -> str:
    """`goes on: robot r_0, after 12.5 s for r_1, 3.0 s for r_2`."""
    waits = [f"{seconds:.1f} s for {robot}" for robot, seconds in data.get("waited_s", {}).items()]
    return f"goes on: robot {data.get('robot')}, after {', '.join(waits)}"


def _traffic_jam(data: Mapping[str, Any]) -> str:
    since_s = data.get("since_s", 0.0)
    return (
        f"traffic jam: {', '.join(data.get('robots', ()))} hold each other up at {_place(data)} since {since_s:.1f} s"
    )


def _mission_begins(data: Mapping[str, Any]) -> str:
    """`mission begins, 300 s before its start at 2027-03-01T08:00: robots wait`."""
    after_s, start = data.get("after_s", 0.0), f"its start at {data.get('starts_at')}"
    if after_s < 0:
        return f"mission begins, {-after_s:.0f} s before {start}: robots wait"
    return f"mission begins, {after_s:.0f} s after {start}" if after_s >= 1 else "mission begins"


def _final_states(data: Mapping[str, Any]) -> str:
    """`at the end: r_0: hovers, armed; at (9.54, 0.00, 4.77)`."""
    return f"at the end: {' | '.join(str(one.get('words')) for one in data.get('robots', ()))}"


def _place(data: Mapping[str, Any]) -> str:
    return ", ".join(f"{value + 0.0:.2f}" for value in data.get("position", ()))


_SPECIAL = {
    "waits_in_traffic": _waits_in_traffic,
    "goes_on": _goes_on,
    "traffic_jam": _traffic_jam,
    "mission_begins": _mission_begins,
    "final_states": _final_states,
}


def _short(value: Any) -> str:
    if isinstance(value, Mapping):
        if "id" in value:
            return str(value["id"])
        return ", ".join(
            _short(of) if key in ("kind", "task", "robot") else f"{key} {_short(of)}" for key, of in value.items()
        )
    if isinstance(value, float):
        return f"{value:.2f}"
    if isinstance(value, list | tuple):
        return " ".join(map(_short, value))
    return str(getattr(value, "id", value))
