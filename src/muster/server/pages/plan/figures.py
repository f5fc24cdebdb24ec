"""Figures of a plan, and who does what: as lists, tables, and lines for the map."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from nicegui import ui

_COLORS = 8


_MEANINGS = {
    "Tasks done": "how many of the mission's tasks the plan has",
    "Objective": "what planning makes as small as it can, once as many tasks as possible are done",
    "Lower bound": "no plan can be below it; the gap is how much better one might be at most",
    "Total cost": "what all robots use together for travel and work",
    "Greatest usage": "what the robot uses that is used most",
    "Ends after": "when the last robot has done its last task",
    "Equality": "how evenly usage is shared: 1 where all robots are used alike, less where some do most",
    "The judge says": "the plan was checked against every rule of the mission by a part that had no hand in making it",
}
LESS_IS_BETTER = ("Objective", "Total cost", "Greatest usage", "Ends after")


def figures_of(plan: Mapping[str, Any], verdict: Mapping[str, Any] | None = None) -> list[tuple[str, str]]:
    """Names and values; from the judge where it has judged."""
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
        ("Equality", _number(plan.get("equality_index"), "")),
    ]
    if verdict is not None:
        wrong = verdict["violations"]
        rows.append(("The judge says", "admissible" if verdict["valid"] else f"not admissible: {_wrong(wrong)}"))
    return [(name, text) for name, text in rows if text and text != " of "]


def objective_unit(plan: Mapping[str, Any]) -> str:
    """The unit of a plan's objective: seconds of a makespan, else that of usage."""
    return "s" if (plan.get("objective") or {}).get("name") == "makespan" else str(plan.get("usage_unit") or "")


def meaning_of(name: str) -> str:
    """What a figure is, for a person who asks."""
    return _MEANINGS.get(name.partition(",")[0], "")


def figures_list(rows: Sequence[tuple[str, str]]) -> None:
    """Show figures; each says what it is where one points at it."""
    with ui.element("dl").classes("figures"):
        for name, text in rows:
            box = ui.element("div")
            box.props["title"] = meaning_of(name)
            with box:
                with ui.element("dt"):
                    ui.label(name)
                with ui.element("dd").classes("alarm" if text.startswith("not admissible") else ""):
                    ui.label(text)


def robots_table(
    routes: Sequence[Mapping[str, Any]],
    unit: str,
    choose_robot: Callable[[str], None],
    choose_task: Callable[[str], None],
) -> None:
    """Who does what: tasks in order, usage, and how much of the capacity that is."""
    with ui.element("div").classes("scrolling"), ui.element("table").classes("plain robots"):
        with ui.element("tr"):
            for name, classes in (
                ("Robot", ""),
                ("Tasks in order", ""),
                (f"Usage, {unit}" if unit else "Usage", "number"),
            ):
                with ui.element("th").classes(classes).props('scope="col"'):
                    ui.label(name)
        for k, route in enumerate(routes):
            _robot_row(k, route, choose_robot, choose_task)


def left_out(plan: Mapping[str, Any], choose_task: Callable[[str], None]) -> None:
    """The tasks that a plan leaves out, if there are any."""
    missing = [str(item["task"]) for item in plan.get("unassigned") or ()]
    if missing:
        with ui.element("div").classes("bar"):
            ui.label(f"Left out ({len(missing)})").classes("alarm")
            _chips(missing, choose_task)


def _chips(tasks: Sequence[str], choose_task: Callable[[str], None]) -> None:
    with ui.element("div").classes("chips"):
        for task in tasks:
            chip = ui.element("button").props('type="button"').classes("chip")
            chip.props["aria-label"] = f"task {task}"
            with chip:
                ui.label(task)
            chip.on("click", lambda task=task: choose_task(task))


def _robot_row(
    k: int, route: Mapping[str, Any], choose_robot: Callable[[str], None], choose_task: Callable[[str], None]
) -> None:
    robot = route["robot"]
    with ui.element("tr"):
        with ui.element("td"):
            button = ui.element("button").props('type="button"').classes("bare robot-name")
            with button:
                ui.element("i").classes("swatch").style(f"background: var(--c{k % _COLORS})")
                ui.label(robot)
            button.on("click", lambda: choose_robot(robot))
        with ui.element("td"):
            _chips([str(task) for task in route["tasks"]], choose_task)
        with ui.element("td").classes("number"):
            capacity = route.get("capacity")
            ui.label(f"{route['usage']:.2f}" + (f" of {capacity:g}" if capacity is not None else ""))
            if capacity:
                share = min(route["usage"] / capacity, 1.0)
                with ui.element("div").classes("meter").props('aria-hidden="true"'):
                    ui.element("div").style(f"width: {share:.0%}; background: var(--c{k % _COLORS})")


def lines_of(plan: Mapping[str, Any], verdict: Mapping[str, Any]) -> dict[str, Any]:
    """What the map shows of a plan that the judge has looked at."""
    routes = [
        {"robot": route["robot"], "tasks": list(route["tasks"]), "lines": verdict["lines"].get(route["robot"])}
        for route in verdict["routes"]
    ]
    return {"routes": routes, "left_out": [item["task"] for item in plan.get("unassigned") or ()]}


def _number(value: object, unit: str) -> str:
    return f"{value:.2f} {unit}".strip() if isinstance(value, (int, float)) else ""


def _bound(value: object, bound: object, unit: str) -> str:
    if not isinstance(bound, (int, float)):
        return "none was found"
    gap = (value - bound) / bound if isinstance(value, (int, float)) and bound else None
    return _number(bound, unit) + (f" (gap {gap:.1%})" if gap is not None else "")


def _wrong(violations: Sequence[Mapping[str, Any]]) -> str:
    words = [f"{v['kind']} {v.get('task') or v.get('robot') or ''}".strip() for v in violations[:4]]
    return ", ".join(words) + (f" and {len(violations) - 4} more" if len(violations) > 4 else "")
