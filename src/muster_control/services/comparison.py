"""Compares two plans of one mission: their figures, and which robot does which task."""

from __future__ import annotations

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
    task that another robot does, or none, `task`, `a` and `b`; `same`: how many tasks stay with their robot.
    """
    doers = [_doers(verdict) for verdict in (verdict_a, verdict_b)]
    tasks = list(doers[0] | doers[1])
    moved = [
        {"task": t, "a": doers[0].get(t), "b": doers[1].get(t)} for t in tasks if doers[0].get(t) != doers[1].get(t)
    ]
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


def _doers(verdict: Mapping[str, Any]) -> dict[str, str]:
    """Which robot does each task."""
    return {task: route["robot"] for route in verdict["routes"] for task in route["tasks"]}


def _figure(name: str, a: float | None, b: float | None, best: str) -> dict[str, Any]:
    change = None if a is None or b is None else b - a
    better = None
    if change and abs(change) > 1e-9 * max(abs(a or 0.0), abs(b or 0.0)):
        better = "b" if (change < 0) == (best == "least") else "a"
    return {"name": name, "a": a, "b": b, "change": change, "better": better}
