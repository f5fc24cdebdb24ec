"""Entries of a run's log as lines for people."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from muster.mission.event_descriptions import event_line

_HAPPENS = {
    "sets_out": "{robot} sets out for {task}",
    "arrives": "{robot} is at {task}",
    "starts": "{robot} begins {task}",
    "ends": "{robot} has done {task}",
    "returns": "{robot} goes to where its route ends",
    "robot_at_end": "{robot} is where its route ends",
    "new_task": "task {task} is added",
    "cancel_task": "task {task} is cancelled",
    "move_task": "task {task} is moved to {position}",
    "delay_task": "task {task} takes {by_s} s longer",
    "robot_fails": "{robot} is out",
    "robot_silent": "{robot} is not heard any more",
    "robot_stuck": "{robot} does not get on",
    "robot_returns": "{robot} takes part again",
    "robot_joins": "{robot} joins",
    "door_closes": "door {door} closes",
    "door_opens": "door {door} opens",
    "waits": "{robot} {words}",
    "waits_in_traffic": "{robot} waits in traffic for {waits_for}",
    "goes_on": "{robot} goes on",
    "traffic_jam": "jam: {robots} hold each other up",
    "robot_goes_round": "{robot} goes round {round}, which stands in its way",
    "robot_makes_room": "{robot} makes room for {makes_room_for}",
    "robot_stands_aside": "{robot} stands aside for {waits_for}",
    "robot_sent_again": "{robot} is sent again",
    "window_missed": "task {task} is not begun in time",
    "deadline_missed": "task {task} is not begun in time",
    "within_missed": "task {task} is not begun in time",
    "work_broken_off": "work on task {task} is broken off",
    "lost": "task {task} is lost",
    "improved": "a search has found better routes",
    "mission_ended": "the mission is over",
}
"""What happened, by the kind of its entry; a `reason` follows."""
_DOES = {
    "start": "starts the run",
    "pause": "pauses the run",
    "resume": "lets the run go on",
    "cancel": "ends the run",
    "new_task": "adds task {task}",
    "cancel_task": "cancels task {task}",
    "move_task": "moves task {task} to {position}",
    "delay_task": "delays task {task} by {by_s} s",
    "door_closes": "closes door {door}",
    "door_opens": "opens door {door}",
    "robot_fails": "takes {robot} out",
    "robot_silent": "lets {robot} fall silent",
    "robot_returns": "brings {robot} back",
    "robot_joins": "lets {robot} join",
}
"""What somebody had done, by the verb, or by the kind of the event."""


def line_of(kind: str, data: Mapping[str, Any]) -> str:
    """What a log's entry says: `r_0 begins 7`, `ada takes r_1 out`."""
    special = {"plan": _plan, "command": _command, "report": _report, "resumed": _resumed, "replanned": _replanned}
    return special[kind](data) if kind in special else _happens(kind, data)


def deed_of(verb: str, data: Mapping[str, Any]) -> str:
    """What a command does, after the name of whoever gave it: `takes r_1 out`."""
    if verb == "speed":
        speed = data.get("speed")
        return "lets it go as fast as it goes" if speed is None else f"sets the speed to {speed:g} times"
    if verb == "orders":
        count = len(data.get("orders", ()))
        return f"gives {count} order{'' if count == 1 else 's'}"
    if verb != "event" or not data:
        return _DOES.get(verb, verb)
    kind, what = next(iter(data.items()))
    return _filled(_DOES[kind], _named(kind, what)) if kind in _DOES else kind.replace("_", " ")


def _command(data: Mapping[str, Any]) -> str:
    outcome = data.get("outcome", "done")
    line = f"{data.get('who', '')} {deed_of(data['verb'], data.get('data') or {})}".lstrip()
    return line if outcome == "done" else f"{line}; refused: {outcome}"


def _happens(kind: str, data: Mapping[str, Any]) -> str:
    if kind not in _HAPPENS:
        return event_line(kind, data)
    line = _filled(_HAPPENS[kind], data)
    return f"{line}: {data['reason']}" if data.get("reason") else line


def _replanned(data: Mapping[str, Any]) -> str:
    """`replanned, as r_1 is out: 3 from r_1 to r_0, 4 to r_2; given up: 5 (why); nobody can do: 6 (why)`."""
    causes = ", ".join(_happens(cause["kind"], {**cause, "reason": ""}) for cause in data.get("causes", ()))
    moved = [f"{task} from {robots[0]} to {robots[1]}" for task, robots in data.get("moved", {}).items()]
    added = [f"{task} to {robot}" for task, robot in data.get("added", {}).items()]
    line = f"replanned, as {causes}: {', '.join([*moved, *added]) or 'no task changes robot'}"
    for words, tasks in (("given up", data.get("dropped", {})), ("nobody can do", data.get("left_out", {}))):
        line += f"; {words}: {', '.join(f'{task} ({why})' if why else task for task, why in tasks.items())}" * bool(
            tasks
        )
    return line


def _named(kind: str, what: Any) -> Mapping[str, Any]:
    """An event's robot or task by its name, as entries have it: in a mission file it may be the value itself."""
    about = "robot" if kind.startswith("robot_") else "task"
    return what if isinstance(what, Mapping) and "id" not in what else {about: what}


def _filled(words: str, data: Mapping[str, Any]) -> str:
    return words.format_map(defaultdict(lambda: "?", {key: _short(value) for key, value in data.items()}))


def _short(value: Any) -> str:
    if isinstance(value, Mapping):
        return str(value.get("id", ""))
    if isinstance(value, list | tuple):
        return ", ".join(map(_short, value))
    return f"{value:.2f}" if isinstance(value, float) else str(value)


def _plan(data: Mapping[str, Any]) -> str:
    routes = [route for route in data["plan"].get("routes", ()) if route.get("tasks")]
    tasks = sum(len(route["tasks"]) for route in routes)
    return f"plan: {tasks} tasks, {len(routes)} robots"


def _report(data: Mapping[str, Any]) -> str:
    gone = len(data["tasks_lost"])
    return f"report: {len(data['tasks_done'])} tasks done, {gone} not, {data['mission_time_s']:.1f} s"


def _resumed(data: Mapping[str, Any]) -> str:
    return f"resumed after a stop: {data.get('how', '')}".rstrip(": ")
