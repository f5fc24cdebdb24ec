"""The figures and routes of a plan as lists, tables, and lines for the map."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from typing import Any

from nicegui import ui

from muster.mission.plan import gap
from muster.mission.stations import station_sign
from muster.mission.texts.counting import counted

Choose = Callable[[str, str], None]
"""Told `robot`, `task` or `station` and an id, when somebody clicks it."""

_COLORS = 8
_CLICKED = """(event) => {
  const one = event.target.closest("[data-id]");
  if (one) emit(one.dataset.what, one.dataset.id);
}"""


_MEANINGS = {
    "Tasks done": "how many of the mission's tasks the plan has",
    "Objective": "what planning makes as small as it can, once as many tasks as possible are done",
    "Lower bound": "no plan can be below it; the gap is how much better one might be at most",
    "Total cost": "what all robots use together for travel and work",
    "Greatest usage": "what the robot uses that is used most",
    "Ends after": "when the last robot has done its last task",
    "At stations": "how often robots charge, swap batteries or unload, and what that adds to all batteries",
    "Equality": "how evenly usage is shared: 1 where all robots are used alike, less where some do most",
    "Rules ignored": "whoever had this planned wanted it without these rules of the mission",
    "The judge says": "the plan was checked against every rule of the mission by a part that had no hand in making it",
}
LESS_IS_BETTER = ("Objective", "Total cost", "Greatest usage", "Ends after")


def figures_of(plan: Mapping[str, Any], verdict: Mapping[str, Any] | None = None) -> list[tuple[str, str]]:
    """Names and values, from the judge's verdict if there is one."""
    judged = verdict or {}
    unit = plan.get("usage_unit") or ""
    objective = plan.get("objective") or {}
    own_unit = objective_unit(plan)
    bound = plan.get("lower_bound")
    value = objective.get("value")
    rows = [
        ("Tasks done", f"{plan.get('tasks_completed', '')} of {plan.get('tasks_total', '')}"),
        (f"Objective, {objective.get('name', '')}", _number(value, own_unit)),
        ("Lower bound", _bound(value, bound, own_unit)),
        ("Total cost", _number(judged.get("total_cost", plan.get("total_cost")), unit)),
        ("Greatest usage", _number(judged.get("max_usage", plan.get("max_usage")), unit)),
        ("Ends after", _number(judged.get("makespan_s", plan.get("makespan_s")), "s")),
        ("With traffic", _number(plan.get("time_with_traffic_s"), "s")),
        ("At stations", _at_stations(judged, unit)),
        ("Cut short", "planning did not come to all tasks that are left out" if plan.get("cut_short") else ""),
        ("Equality", _number(plan.get("equality_index"), "")),
    ]
    if verdict is not None:
        wrong = verdict["violations"]
        if verdict["ignored"]:
            rows.append(("Rules ignored", ", ".join(verdict["ignored"])))
        rows.append(("The judge says", "admissible" if verdict["valid"] else f"not admissible: {_wrong(wrong)}"))
    return [(name, text) for name, text in rows if text and text != " of "]


def objective_unit(plan: Mapping[str, Any]) -> str:
    """The unit of a plan's objective: seconds of a makespan, else that of usage."""
    return (
        "s"
        if (plan.get("objective") or {}).get("name") in ("makespan", "lateness")
        else str(plan.get("usage_unit") or "")
    )


def meaning_of(name: str) -> str:
    """The meaning of a figure, for its tooltip."""
    return _MEANINGS.get(name.partition(",")[0], "")


def figures_list(rows: Sequence[tuple[str, str]]) -> None:
    """Show figures with their meanings as tooltips."""
    with ui.element("dl").classes("figures"):
        for name, text in rows:
            box = ui.element("div")
            box.props["title"] = meaning_of(name)
            with box:
                with ui.element("dt"):
                    ui.label(name)
                with ui.element("dd").classes("alarm" if text.startswith("not admissible") else ""):
                    ui.label(text)


def robots_table(routes: Sequence[Mapping[str, Any]], unit: str, choose: Choose) -> None:
    """Which robot does what: tasks in order, usage, and how much of the capacity that is."""
    usage = f"Usage, {escape(unit)}" if unit else "Usage"
    head = f'<th scope="col">Robot</th><th scope="col">Tasks in order</th><th scope="col" class="number">{usage}</th>'
    rows = "".join(_robot_row(k, route) for k, route in enumerate(routes))
    table = f'<table class="plain robots"><tr>{head}</tr>{rows}</table>'
    _choosing(ui.html(table, sanitize=False).classes("scrolling"), choose)


def left_out(plan: Mapping[str, Any], choose: Choose) -> None:
    """The tasks that a plan leaves out, if there are any."""
    missing = [str(item["task"]) for item in plan.get("unassigned") or ()]
    if missing:
        with ui.element("div").classes("bar"):
            ui.label(f"Left out ({len(missing)})").classes("alarm")
            _choosing(ui.html(_chips(missing), sanitize=False), choose)


def _choosing(shown: ui.html, choose: Choose) -> None:
    """Let named tasks be chosen by a click; one listener for all, as there may be 20,000."""
    shown.on("click", lambda event: choose(*event.args), js_handler=_CLICKED)


def _named(what: str, name: str, inner: str, classes: str, label: str) -> str:
    named = f'data-what="{what}" data-id="{escape(name)}" aria-label="{escape(label)}"'
    return f'<button type="button" class="{classes}" {named}>{inner}</button>'


def _chips(tasks: Iterable[str]) -> str:
    chips = "".join(_named("task", task, escape(task), "chip", f"task {task}") for task in tasks)
    return f'<div class="chips">{chips}</div>'


def _stop_chips(route: Mapping[str, Any]) -> str:
    """The tasks of a route and, in brackets, its stations in order; without a schedule its tasks alone."""
    stops = [(stop["name"], stop["is_station"]) for stop in route["stops"]]
    stops = stops or [(name, False) for name in route["tasks"]]
    chips = [
        _named("station", name, escape(station_sign(name)), "chip station", f"station {name}")
        if is_station
        else _named("task", name, escape(name), "chip", f"task {name}")
        for name, is_station in stops
    ]
    return f'<div class="chips">{"".join(chips)}</div>'


def _at_stations(judged: Mapping[str, Any], unit: str) -> str:
    """How often robots are at stations, and what is charged there; empty where none is."""
    visits, charged = judged.get("station_visits", 0), judged.get("charged", 0.0)
    if not visits:
        return ""
    return counted(visits, "time") + (f", {_number(charged, unit)} charged" if charged else "")


def _robot_row(k: int, route: Mapping[str, Any]) -> str:
    robot, capacity, color = str(route["robot"]), route.get("capacity"), f"background: var(--c{k % _COLORS})"
    swatch = f'<i class="swatch" style="{color}"></i>'
    name = _named("robot", robot, swatch + escape(robot), "bare robot-name", f"robot {robot}")
    usage = f"{route['usage']:.2f}" + (f" of {capacity:g}" if capacity is not None else "")
    if capacity:
        share = min(route["usage"] / capacity, 1.0)
        usage += f'<div class="meter" aria-hidden="true"><div style="width: {share:.0%}; {color}"></div></div>'
    tasks = _stop_chips(route)
    return f'<tr><td>{name}</td><td>{tasks}</td><td class="number">{usage}</td></tr>'


def lines_of(plan: Mapping[str, Any], verdict: Mapping[str, Any]) -> dict[str, Any]:
    """The routes of a judged plan for the map."""
    routes = [
        {
            "robot": route["robot"],
            "tasks": list(route["tasks"]),
            "order": list(route["order"]),
            "lines": verdict["lines"].get(route["robot"]),
        }
        for route in verdict["routes"]
    ]
    return {"routes": routes, "left_out": [item["task"] for item in plan.get("unassigned") or ()]}


def _number(value: object, unit: str) -> str:
    return f"{value:.2f} {unit}".strip() if isinstance(value, (int, float)) else ""


def _bound(value: object, bound: object, unit: str) -> str:
    if not isinstance(bound, (int, float)):
        return "none was found"
    return _number(bound, unit) + (f" (gap {gap(value, bound):.1%})" if isinstance(value, (int, float)) else "")


def _wrong(violations: Sequence[Mapping[str, Any]]) -> str:
    words = [f"{v['kind']} {v.get('task') or v.get('robot') or ''}".strip() for v in violations[:4]]
    return ", ".join(words) + (f" and {len(violations) - 4} more" if len(violations) > 4 else "")
