"""The problem of a mission with the changes of a remedy."""

from __future__ import annotations

from dataclasses import replace

from muster.allocation.remedies.remedy import Remedy
from muster.mission.model import Task
from muster.model.problem import Problem


def changed(problem: Problem, remedy: Remedy, i: int, j: int) -> Problem:
    """The problem with the changes of the remedy, and its capacity."""
    robot, task, mission = problem.robots[i], problem.tasks[j], problem.mission
    abler, freer = remedy.capacity.robot(robot), task
    for change in remedy.changes.values():
        abler, freer, mission = change.robot(abler), change.task(freer, robot), change.mission(mission)
    mission = replace(
        mission,
        robots=tuple(abler if one.id == robot.id else one for one in mission.robots),
        tasks=tuple(freer if one.id == task.id else _beside(remedy, one, task) for one in mission.tasks),
    )
    return Problem.compile(mission, problem.objective, problem.ignored)


def _beside(remedy: Remedy, other: Task, task: Task) -> Task:
    """Another task with the changes of the remedy for a task."""
    for change in remedy.changes.values():
        other = change.other(other, task)
    return other
