"""Tasks that appear while a mission goes on: as bytes that all robots keep, and as a part of their problem."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from muster.allocation.problem import Problem
from muster.mission.errors import MissionError, ParameterError
from muster.mission.kinds import Fault, Record, shown
from muster.mission.model import Task, findings
from muster.mission.source import IN_PYTHON
from muster.mission.yaml_writer import plain


def content_of(task: Task) -> bytes:
    """The task as bytes; equal tasks, equal bytes."""
    return json.dumps(plain(task), sort_keys=True, separators=(",", ":")).encode()


@cache
def task_of(content: bytes) -> Task:
    """The task of these bytes.

    Raises
    ------
    MissionError
        if they are no task.
    """
    faults: list[Fault] = []
    try:
        data = json.loads(content)
    except ValueError:
        raise MissionError(findings([Fault((), shown(content), "a task as JSON")], IN_PYTHON)) from None
    task = Record(Task, "a task").read(data, (), faults)
    if faults:
        raise MissionError(findings(faults, IN_PYTHON))
    assert isinstance(task, Task)
    return task


def with_tasks(problem: Problem, contents: Sequence[bytes]) -> Problem:
    """The problem with more tasks, behind all that it has: ties go to those that were there before.

    Raises
    ------
    MissionError
        if a task does not fit into the mission.
    ParameterError
        if there is a task of its name.
    """
    if not contents:
        return problem
    new = tuple(task_of(content) for content in contents)
    for task in new:
        if task.id in problem.task_index:
            raise ParameterError(f"new task: {shown(task.id)}; expected an id that no task has")
    mission = replace(problem.mission, tasks=(*problem.mission.tasks, *new))
    compiled = Problem.compile(mission, problem.objective, problem.ignored)
    return replace(compiled, tasks=(*problem.tasks, *new))
