"""Events and other entries of logs in words for people, and whether somebody should look at them.

Each kind of event says at its class what it says (`muster.state.event.happens`); what is no event is listed here.
Words are made of plain data, of whatever form: an entry of a log has words also where a field is missing.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from typing import Any

from muster.mission.texts.counting import counted
from muster.state.reasons import is_no_loss, was_cancelled

Data = Mapping[str, Any]
Says = str | Callable[[Data], str]
"""Words with the names of fields in braces, after which a `reason` follows; or what makes a line of the data."""
Mark = str | Callable[[Data], str]
ALARM, CHANGE, DETAIL = "alarm", "change", "detail"
"""Marks: somebody should look; the plan or the mission is changed; of interest to programs alone, and not shown."""

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
    "station_fails": "takes station {station} out",
    "station_returns": "brings station {station} back",
    "robot_fails": "takes {robot} out",
    "robot_silent": "lets {robot} fall silent",
    "robot_returns": "brings {robot} back",
    "robot_removed": "takes {robot} away",
    "robot_moved": "moves {robot} to {position}",
    "robot_joins": "lets {robot} join",
}
"""What somebody had done, by the verb, or by the kind of the event."""


def line_of(kind: str, data: Data) -> str:
    """Return what an event or another entry of a log says: `r_0 begins task 7`, `ada takes r_1 out`."""
    says = SAYS.get(kind)
    if says is None:
        return _other(kind, data)
    if callable(says):
        return says(data)
    return _filled(says, data) + _because(data.get("reason"))


def mark_of(kind: str, data: Data) -> str:
    """Return the mark of an event or another entry of a log; empty: none."""
    mark = MARKS.get(kind, "")
    return mark(data) if callable(mark) else mark


def words_of(kind: str, data: Data) -> dict[str, str]:
    """Return the line and the mark, as messages have them."""
    return {"line": line_of(kind, data), "mark": mark_of(kind, data)}


def deed_of(verb: str, data: Data) -> str:
    """Return what a command does, after the name of whoever gave it: `takes r_1 out`."""
    if verb == "speed":
        speed = data.get("speed")
        return "lets it go as fast as it goes" if speed is None else f"sets the speed to {speed:g} times"
    if verb == "orders":
        return f"gives {counted(len(data.get('orders', ())), 'order')}"
    if verb != "event" or not data:
        return _DOES.get(verb, verb)
    kind, what = next((item for item in data.items() if item[0] != "at_s"), ("", None))
    return _filled(_DOES[kind], _named(kind, what)) if kind in _DOES else kind.replace("_", " ")


def amount(value: Any) -> str:
    """Return a value in short: a thing by its id, numbers with two decimals."""
    if isinstance(value, Mapping):
        return str(value.get("id", ""))
    if isinstance(value, list | tuple):
        return ", ".join(map(amount, value))
    return f"{value + 0.0:.2f}" if isinstance(value, float) else str(value)


def _filled(words: str, data: Data) -> str:
    return words.format_map(defaultdict(lambda: "?", {key: amount(value) for key, value in data.items()}))


def _because(reason: object) -> str:
    return f": {reason}" if reason else ""


def _named(kind: str, what: Any) -> Data:
    """An event's robot, task, station or door by its name: in a mission file it may be the value itself."""
    return what if isinstance(what, Mapping) and "id" not in what else {_ABOUT.get(kind.split("_")[0], "task"): what}


_ABOUT = {"robot": "robot", "station": "station", "door": "door"}


def _other(kind: str, data: Data) -> str:
    """`no such kind: task 7, robots a, b`."""
    told = [f"{key} {amount(value)}".strip() for key, value in data.items() if value not in ({}, [], ())]
    return f"{kind.replace('_', ' ')}: {', '.join(told)}" if told else kind.replace("_", " ")


# Tasks


def lost(data: Data) -> str:
    """`task 7 is lost: no robot takes part`; of one that is no loss that it is not done."""
    how = "not done" if is_no_loss(data.get("reason")) else "lost"
    return _filled(f"task {{task}} is {how}", data) + _because(data.get("reason"))


def lost_mark(data: Data) -> str:
    return "" if is_no_loss(data.get("reason")) else ALARM


def missed_mark(data: Data) -> str:
    """Where it can be begun later nobody needs to look."""
    return "" if data.get("next_s") is not None else ALARM


def refused(data: Data) -> str:
    """`r_0 cannot do task 7: unreachable`; also of other tasks and robots for the same reason."""
    now = " with what it has on board" if data.get("for_now") else ""
    others = [f"{amount(robots)} do {task}" for task, robots in data.get("others", {}).items()]
    line = _filled(f"{{robot}} cannot do task {{task}}{now}", data) + _because(data.get("reason"))
    return f"{line}; nor can {', '.join(others)}" if others else line


def way_closed(data: Data) -> str:
    """`an obstacle is in the way of r_0, which goes round it, 3.10 m longer`."""
    longer_m = data.get("longer_m")
    how = "which has no other" if longer_m is None else _filled("which goes round it, {longer_m} m longer", data)
    return _filled("an obstacle is in the way of {robot}", data) + f", {how}"


def map_grows(data: Data) -> str:
    """`the map grows: 12.50 m2 explored`."""
    return _filled("the map grows: {explored_m2} m2 explored", data)


def standstill(data: Data) -> str:
    """`no robot gets on: task 7 waits for 6; it is given up: ...`."""
    given_up = data.get("given_up")
    return _filled("no robot gets on: task {task} {words}", data) + (
        f"; it is given up: {given_up}" if given_up else ""
    )


# Robots


def goes_on(data: Data) -> str:
    """`r_0 goes on, after 12.5 s for r_1, 3.0 s for r_2`."""
    waits = [f"{seconds:.1f} s for {robot}" for robot, seconds in data.get("waited_s", {}).items()]
    return _filled("{robot} goes on", data) + (f", after {', '.join(waits)}" if waits else "")


def final_states(data: Data) -> str:
    """`at the end: r_0: hovers, armed; at (9.54, 0.00, 4.77)`."""
    return f"at the end: {' | '.join(str(one.get('words')) for one in data.get('robots', ()))}"


# The run


def mission_begins(data: Data) -> str:
    """`the mission begins, 300 s before its start at 2027-03-01T08:00: robots wait`."""
    after_s, start = data.get("after_s", 0.0), f"its start at {data.get('starts_at')}"
    if after_s < 0:
        return f"the mission begins, {-after_s:.0f} s before {start}: robots wait"
    return f"the mission begins, {after_s:.0f} s after {start}" if after_s >= 1 else "the mission begins"


def plan(data: Data) -> str:
    """`plan: 31 tasks, 6 robots`, whose stations are not counted; of a later one `plan: other ways for 2 robots`."""
    if "plan" not in data:
        return f"plan: other ways for {counted(len(data.get('routes', ())), 'robot')}"
    routes = [route for route in data["plan"].get("routes", ()) if route.get("tasks")]
    stops = (stop.get("station") for route in routes for stop in route.get("stops", ()))
    stations = {*data.get("stations", ()), *stops}
    tasks = sum(name not in stations for route in routes for name in route["tasks"])
    return f"plan: {counted(tasks, 'task')}, {counted(len(routes), 'robot')}"


def replanned(data: Data) -> str:
    """`replanned, as r_1 is out: 3 from r_1 to r_0, 4 to r_2; given up: 5 (why); nobody can do: 6 (why)`."""
    causes = ", ".join(line_of(cause["kind"], {**cause, "reason": ""}) for cause in data.get("causes", ()))
    moved = [f"{task} from {robots[0]} to {robots[1]}" for task, robots in data.get("moved", {}).items()]
    added = [f"{task} to {robot}" for task, robot in data.get("added", {}).items()]
    line = f"replanned, as {causes}: {', '.join([*moved, *added]) or 'no task changes robot'}"
    for words, tasks in (("given up", data.get("dropped")), ("nobody can do", data.get("left_out"))):
        told = ", ".join(f"{task} ({why})" if why else task for task, why in (tasks or {}).items())
        line += f"; {words}: {told}" if told else ""
    return line


def replanned_mark(data: Data) -> str:
    return ALARM if data.get("dropped") or data.get("left_out") else CHANGE


def event_refused(data: Data) -> str:
    """`refused: adds task 7: id "7"; expected ...`."""
    what = data.get("event") or {}
    return "refused" + _because(deed_of("event", what) if what else "") + _because(data.get("reason"))


def resumed(data: Data) -> str:
    return f"resumed after a stop: {data.get('how', '')}".rstrip(": ")


def _command(data: Data) -> str:
    outcome = data.get("outcome", "done")
    line = f"{data.get('who', '')} {deed_of(data['verb'], data.get('data') or {})}".lstrip()
    return line if outcome == "done" else f"{line}; refused: {outcome}"


def _report(data: Data) -> str:
    """`report: 7 tasks done, 1 cancelled, 120.0 s`."""
    reasons = [one["reason"] for one in data["tasks_lost"]]
    gone = {"lost": len(reasons) - sum(map(is_no_loss, reasons)), "cancelled": sum(map(was_cancelled, reasons))}
    told = "".join(f", {count} {words}" for words, count in gone.items() if count)
    return f"report: {counted(len(data['tasks_done']), 'task')} done{told}, {data['mission_time_s']:.1f} s"


def _found(data: Data) -> str:
    """`found: tag 5 at 4.02, 0.31 by r_0, sure to 0.05 m; becomes found-5`."""
    line = _filled("found: tag {tag} at {position} by {robots}, sure to {sure_to_m} m", data)
    return f"{line}; becomes {data['task']}" if data.get("task") else line


def _without_effect(data: Data) -> str:
    """`cancels task 7: this changes nothing any more`."""
    return f"{deed_of('event', data)}: this changes nothing any more"


SAYS: dict[str, Says] = {
    "command": _command,
    "report": _report,
    "found": _found,
    "without_effect": _without_effect,
    "contact": "{robots} touch each other",
    "off_place": "{robot} takes task {task} for done, {off_m} m off its place",
    "agreed": "robots have agreed",
    "new_agreement": "robots have agreed anew",
    "improved": "a search has found better routes",
}
"""By kind what it says: here kinds that are no event of the state, or causes of a new plan."""
MARKS: dict[str, Mark] = {"command": CHANGE, "contact": ALARM, "off_place": ALARM}
"""By kind its mark, likewise."""
