"""The problem of a mission with the changes of a remedy."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

from muster.allocation.allocator import Routes
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.remedies.remedy import Before, Remedy
from muster.mission.model import Task
from muster.model.problem import Problem
from muster.model.rules.capacity import CapacityChange


def as_they_are(problem: Problem, routes: Routes, j: int, robots: Iterable[int]) -> Iterator[Remedy]:
    """For each robot what stands between it and the task by themselves, and the prerequisites that are left out."""
    done, own, task = {k for route in routes for k in route}, problem.with_partner(j), problem.tasks[j]
    awaited = problem.closed([before for k in own for before in problem.prerequisites[k]])
    missing = [problem.tasks[k].id for k in awaited if k not in done and k not in own]
    never = {item.task for item in impossible(problem)} if missing else set()
    for i in robots:
        robot = problem.robots[i]
        changes = {rule.word: rule.change(problem, robot, task) for rule in problem.rules if rule.key is not None}
        yield Remedy(
            robot=robot.id,
            changes={word: change for word, change in changes.items() if change is not None},
            before=tuple(Before(name, name not in never) for name in missing),
            unable=problem.action_refusal(i, j) or "",
            capacity=CapacityChange(now=None if math.isinf(problem.capacity[i]) else robot.work_capacity),
        )


def changed(problem: Problem, remedy: Remedy, i: int, j: int) -> Problem:
    """The problem with the changes of the remedy, and its capacity."""
    robot, task, suitability = problem.robots[i], problem.tasks[j], problem.mission.suitability
    enough = remedy.capacity.enough
    capacity = robot.work_capacity if remedy.capacity.now is None or enough is None else enough
    abler, freer = replace(robot, work_capacity=capacity), task
    for change in remedy.changes.values():
        abler, freer = change.robot(abler), change.task(freer, robot)
        suitability = None if suitability is None else change.suitability(suitability)
    more = tuple(one for change in remedy.changes.values() for one in change.more_robots())
    others = {one.id: _beside(remedy, one, task) for one in problem.mission.tasks}
    mission = replace(
        problem.mission,
        robots=(*(abler if one.id == robot.id else one for one in problem.mission.robots), *more),
        tasks=tuple(freer if one.id == task.id else others[one.id] for one in problem.mission.tasks),
        suitability=suitability,
    )
    return Problem.compile(mission, problem.objective, problem.ignored)


def _beside(remedy: Remedy, other: Task, task: Task) -> Task:
    """Another task with the changes of the remedy for a task."""
    for change in remedy.changes.values():
        other = change.other(other, task)
    return other


def with_capacity(problem: Problem, i: int, capacity: float | None) -> Problem:
    """The problem with another work capacity of robot i."""
    robots = list(problem.robots)
    robots[i] = replace(robots[i], work_capacity=capacity)
    return replace(problem, robots=tuple(robots))
