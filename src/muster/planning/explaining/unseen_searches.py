"""Raster searches that leave parts of their squares unseen: by the robots that may do them, and in a plan."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from muster.allocation.bounds.feasibility import usable_pairs
from muster.mission.errors import Finding
from muster.mission.model import Camera, Mission, Task
from muster.mission.plan import Plan
from muster.mission.records import findings
from muster.mission.value_types import Fault
from muster.model.problem import Problem
from muster.motion.actions.raster_search import RasterSearch
from muster.motion.actions.unseen_places import Unseen, unseen


def unseen_searches(problem: Problem) -> tuple[Unseen, ...]:
    """For each raster search the robots that may do it and would not see all of it, in mission order."""
    searches = [task for task in problem.mission.tasks if _has_spacing(task)]
    if not searches:
        return ()
    usable = usable_pairs(problem)
    found: list[Unseen] = []
    for task in searches:
        known: dict[tuple[str, Camera], Unseen | None] = {}
        judged: list[tuple[str, Unseen | None]] = []
        for robot in problem.mission.robots:
            if robot.camera is None or not usable[problem.robot_index[robot.id], problem.task_index[task.id]]:
                continue
            key = robot.kind, robot.camera
            if key not in known:
                known[key] = unseen(task, robot)
            judged.append((robot.id, known[key]))
        never = all(result is not None for _, result in judged)
        found += [replace(one, robot=robot, never_seen=never) for robot, one in judged if one is not None]
    return tuple(found)


def unseen_in_plan(mission: Mission, plan: Plan) -> Iterator[Unseen]:
    """The raster searches of a plan of which the robots that do them do not see all."""
    robots = {robot.id: robot for robot in mission.robots}
    tasks = {task.id: task for task in mission.tasks if _has_spacing(task)}
    for route in plan.routes:
        for name in route.tasks:
            if name in tasks and (one := unseen(tasks[name], robots[route.robot])) is not None:
                yield one


def unseen_findings(mission: Mission, found: tuple[Unseen, ...]) -> list[Finding]:
    """The errors among them: searches that no robot sees all of, each with the first robot that may do it."""
    at = {task.id: k for k, task in enumerate(mission.tasks)}
    first = {one.task: one for one in reversed(found) if one.never_seen}
    faults = [
        Fault(("tasks", at[task], "action", "spacing_m"), f"{one.spacing_m:g} ({one.detail})", one.expected)
        for task, one in first.items()
    ]
    return findings(sorted(faults, key=lambda fault: fault.path[1]), mission.source)


def _has_spacing(task: Task) -> bool:
    action = task.action
    return action is not None and action.name == RasterSearch.name and action.spacing_m is not None
