"""Tasks that are added or moved during a mission: their encoding in facts, and the mission with them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from muster.mission.errors import MissionError
from muster.mission.model import Task
from muster.mission.records import Record, findings
from muster.mission.source import IN_PYTHON
from muster.mission.value_types import Fault
from muster.mission.yaml_writer import plain
from muster.model.problem import Problem


def content_of(task: Task) -> bytes:
    """The task as bytes; equal tasks have equal bytes."""
    return json.dumps(plain(task), sort_keys=True, separators=(",", ":")).encode()


@lru_cache(maxsize=4096)
def task_of(content: bytes) -> Task:
    """The task encoded in these bytes.

    Raises
    ------
    MissionError
        if they encode no task.
    """
    faults: list[Fault] = []
    try:
        data = json.loads(content)
    except (ValueError, RecursionError):
        raise MissionError(findings([Fault((), f"{len(content)} bytes", "a task as JSON")], IN_PYTHON)) from None
    task = Record(Task, "a task").read(data, (), faults)
    if faults:
        raise MissionError(findings(faults, IN_PYTHON))
    assert isinstance(task, Task)
    return task


def with_tasks(problem: Problem, contents: Sequence[bytes]) -> Problem:
    """The problem with more tasks after its own: ties go to the tasks that were there before.

    A task whose id exists replaces that task: it has moved.

    Raises
    ------
    MissionError
        if a task does not fit into the mission.
    """
    if not contents:
        return problem
    new = {task.id: task for task in map(task_of, contents)}

    def changed(tasks: Sequence[Task]) -> tuple[Task, ...]:
        return tuple({**{task.id: task for task in tasks}, **new}.values())

    compiled = Problem.compile(
        replace(problem.mission, tasks=changed(problem.mission.tasks)), problem.objective, problem.ignored
    )
    return replace(compiled, tasks=changed(problem.tasks), mapped=problem.mapped)
