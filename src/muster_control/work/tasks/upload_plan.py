"""The task that prepares an uploaded plan for storage."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from muster.allocation.allocator import routes_of
from muster.allocation.reasons.explanations import unassigned
from muster.mission.model import Mission
from muster.mission.plan import Plan, Unassigned
from muster.model.problem import Problem
from muster.verification import Verdict, verify
from muster_control.work.missions import mission_of, plan_of


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission", "plan"}` -> `{"plan"}`: the plan, with the judge's figures where it has none."""
    mission, plan = mission_of(arguments["mission"]), plan_of(arguments["plan"])
    verdict = verify(mission, plan, objective=plan.objective)
    figures = _figures(verdict)
    missing: dict[str, Any] = {name: value for name, value in figures.items() if getattr(plan, name) is None}
    if len(missing) == len(figures) and not plan.unassigned:  # it says nothing of what it leaves out
        missing["unassigned"] = _left_out(mission, plan, verdict)
    return {"plan": replace(plan, mission=plan.mission or mission.name, **missing).as_dict()}


def _left_out(mission: Mission, plan: Plan, verdict: Verdict) -> tuple[Unassigned, ...]:
    """The unassigned tasks, with reasons if the plan is valid."""
    if verdict.valid:
        problem = Problem.compile(mission, plan.objective)
        return unassigned(problem, routes_of(problem, plan))
    done = {task for route in verdict.routes for task in route.tasks}
    return tuple(Unassigned(task.id, ()) for task in mission.tasks if task.id not in done)


def _figures(verdict: Verdict) -> dict[str, Any]:
    """The figures under the names of a plan."""
    same = (
        "usage_unit",
        "total_cost",
        "max_usage",
        "makespan_s",
        "equality_index",
        "tasks_completed",
        "tasks_total",
        "weight_completed",
    )
    figures = {name: getattr(verdict, name) for name in same}
    return {**figures, "objective_value": verdict.value(), "objective": verdict.objective_name}
