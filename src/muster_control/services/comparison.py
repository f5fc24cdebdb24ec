"""Compares two plans of one mission: their figures, and which robot does which task."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from muster_control.contract import PlanEntry

_FIGURES = {
    "objective": "least",
    "total_cost": "least",
    "max_usage": "least",
    "average": "least",
    "makespan_s": "least",
    "waiting_s": "least",
    "equality_index": "most",
    "tasks_completed": "most",
    "weight_completed": "most",
}
"""What is compared, and whether the least or the most is best."""


def compared(a: PlanEntry, verdict_a: Mapping[str, Any], b: PlanEntry, verdict_b: Mapping[str, Any]) -> dict[str, Any]:
    """Compare two plans.

    Returns
    -------
    `plans`: of each `id`, `version`, `mission_version`, `allocator`, `valid`, `objective_name`; `figures`: of each
    `name`, `a`, `b`, `change` (b - a; None where one is not known) and `better` (`a`, `b` or None); `moved`: of each
    task that other robots do, or none, `task`, `a` and `b`; `same`: how many tasks stay with their robots.
    """
    who = [doers(verdict) for verdict in (verdict_a, verdict_b)]
    tasks = list(who[0] | who[1])
    moved = [{"task": t, "a": who[0].get(t), "b": who[1].get(t)} for t in tasks if who[0].get(t) != who[1].get(t)]
    one_objective = verdict_a["objective_name"] == verdict_b["objective_name"]
    return {
        "plans": {"a": _head(a, verdict_a), "b": _head(b, verdict_b)},
        "figures": [
            _figure(name, verdict_a[name], verdict_b[name], best)
            for name, best in _FIGURES.items()
            if one_objective or name != "objective"
        ],
        "moved": moved,
        "same": len(tasks) - len(moved),
    }


def _head(entry: PlanEntry, verdict: Mapping[str, Any]) -> dict[str, Any]:
    own = {"id": entry.id, "version": entry.version, "mission_version": entry.mission_version}
    judged = {"valid": verdict["valid"], "objective_name": verdict["objective_name"]}
    return {**own, "allocator": entry.plan.get("allocator"), **judged}


def doers(plan: Mapping[str, Any]) -> dict[str, str]:
    """Return which robot does each task of a plan or verdict; the robots of a team in the order of the routes."""
    robots = defaultdict[str, list[str]](list)
    for route in plan["routes"]:
        for task in route["tasks"]:
            robots[str(task)].append(route["robot"])
    return {task: ", ".join(names) for task, names in robots.items()}


def _figure(name: str, a: float | None, b: float | None, best: str) -> dict[str, Any]:
    change = None if a is None or b is None else b - a
    better = None
    if change and abs(change) > 1e-9 * max(abs(a or 0.0), abs(b or 0.0)):
        better = "b" if (change < 0) == (best == "least") else "a"
    return {"name": name, "a": a, "b": b, "change": change, "better": better}
