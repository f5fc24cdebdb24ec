"""Entries of a run's log as lines for people."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from typing import Any

from muster.mission.counting import counted
from muster.mission.event_descriptions import event_line, tells_cancelled, was_cancelled
from muster.mission.stations import station_sign

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
    "station_fails": "station {station} fails",
    "station_returns": "station {station} serves again",
    "station_unreachable": "{robot} has no way to station {station}",
    "robot_charged": "{robot} is charged",
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
    return _SPECIAL[kind](data) if kind in _SPECIAL else _happens(kind, data)


def deed_of(verb: str, data: Mapping[str, Any]) -> str:
    """What a command does, after the name of whoever gave it: `takes r_1 out`."""
    if verb == "speed":
        speed = data.get("speed")
        return "lets it go as fast as it goes" if speed is None else f"sets the speed to {speed:g} times"
    if verb == "orders":
        count = len(data.get("orders", ()))
        return f"gives {counted(count, 'order')}"
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
    line = _filled("task {task} is not done" if tells_cancelled(kind, data) else _HAPPENS[kind], data)
    return f"{line}: {data['reason']}" if data.get("reason") else line


def _replanned(data: Mapping[str, Any]) -> str:
    """`replanned, as r_1 is out: 3 from r_1 to r_0, 4 to r_2; given up: 5 (why); nobody can do: 6 (why)`."""
    causes = ", ".join(line_of(cause["kind"], {**cause, "reason": ""}) for cause in data.get("causes", ()))
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


def _goes_to_station(data: Mapping[str, Any]) -> str:
    return f"{data.get('robot')} goes to {_station(data)}{_charge(data)}"


def _arrives_at_station(data: Mapping[str, Any]) -> str:
    return f"{data.get('robot')} is at {_station(data)}{_charge(data)}"


def _waits_for_slot(data: Mapping[str, Any]) -> str:
    """`r_1 waits for a slot at [dock]: r_0 is served there`."""
    served = [str(robot) for robot in data.get("served", ())]
    line = f"{data.get('robot')} waits for a slot at {_station(data)}"
    return f"{line}: {', '.join(served)} {'is' if len(served) == 1 else 'are'} served there" if served else line


def _service_begins(data: Mapping[str, Any]) -> str:
    """`r_0 is served at [dock]: charge, 58.5 s (48 % in its battery)`."""
    services, takes_s = ", ".join(data.get("services", ())), data.get("takes_s", 0.0)
    return f"{data.get('robot')} is served at {_station(data)}: {services}, {takes_s:.1f} s{_charge(data)}"


def _service_ends(data: Mapping[str, Any]) -> str:
    """`r_0 has been served at [dock]: unloaded kg 3 (100 % in its battery)`."""
    line = f"{data.get('robot')} has been served at {_station(data)}"
    gone = data.get("unloaded") or {}
    told = ", ".join(f"{name} {_short(amount)}".strip() for name, amount in gone.items())
    return f"{line}{f': unloaded {told}' if told else ''}{_charge(data)}"


def _energy_low(data: Mapping[str, Any]) -> str:
    return f"{data.get('robot')} has too little in its battery for what lies ahead{_charge(data)}"


def _station(data: Mapping[str, Any]) -> str:
    return station_sign(str(data.get("station")))


def _charge(data: Mapping[str, Any]) -> str:
    share = data.get("charge")
    return f" ({100 * share:.0f} % in its battery)" if isinstance(share, int | float) else ""


def _plan(data: Mapping[str, Any]) -> str:
    """`plan: 31 tasks, 6 robots`: its stations are not counted; of a later plan `plan: other ways for 2 robots`."""
    if "plan" not in data:
        return f"plan: other ways for {counted(len(data['routes']), 'robot')}"
    routes = [route for route in data["plan"].get("routes", ()) if route.get("tasks")]
    stops = (stop.get("station") for route in routes for stop in route.get("stops", ()))
    stations = {*data.get("stations", ()), *stops}
    tasks = sum(name not in stations for route in routes for name in route["tasks"])
    return f"plan: {counted(tasks, 'task')}, {counted(len(routes), 'robot')}"


def _report(data: Mapping[str, Any]) -> str:
    """`report: 7 tasks done, 1 cancelled, 120.0 s`."""
    cancelled = sum(was_cancelled(one["reason"]) for one in data["tasks_lost"])
    gone = {"lost": len(data["tasks_lost"]) - cancelled, "cancelled": cancelled}
    told = "".join(f", {count} {words}" for words, count in gone.items() if count)
    return f"report: {counted(len(data['tasks_done']), 'task')} done{told}, {data['mission_time_s']:.1f} s"


def _resumed(data: Mapping[str, Any]) -> str:
    return f"resumed after a stop: {data.get('how', '')}".rstrip(": ")


_SPECIAL: Mapping[str, Callable[[Mapping[str, Any]], str]] = {
    "plan": _plan,
    "command": _command,
    "report": _report,
    "resumed": _resumed,
    "replanned": _replanned,
    "goes_to_station": _goes_to_station,
    "arrives_at_station": _arrives_at_station,
    "waits_for_slot": _waits_for_slot,
    "service_begins": _service_begins,
    "service_ends": _service_ends,
    "energy_low": _energy_low,
}
"""What is more than words with names filled in, by the kind of its entry."""
