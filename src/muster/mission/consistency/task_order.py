"""Prerequisites of a mission: tasks that exist, each once, and no cycle, also through tasks that start together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from muster.mission.mission_data import MissionData
from muster.mission.task_relations import tied_by, wrong_names
from muster.mission.tasks import Task
from muster.mission.value_types import Fault


def order_faults(mission: MissionData) -> Iterator[Fault]:
    """What is wrong with the prerequisites of a mission."""
    yield from wrong_names(mission, ("prerequisites",), once="each prerequisite once", itself=True)
    yield from _cycles(mission.tasks)


def _cycles(tasks: Sequence[Task]) -> Iterator[Fault]:
    """One cycle of each knot of prerequisites, named in the order in which the tasks wait.

    Tasks that start together are one node, named by the first of them. Not all cycles are named: there can be more than
    anyone could read, and the others go when one task of theirs is set right, or are found when it was.
    """
    if not any(_awaits(task) for task in tasks):
        return
    index = {t.id: k for k, t in reversed(list(enumerate(tasks)))}
    node = tied_by("starts_with", tasks)
    before: list[list[int]] = [[] for _ in tasks]
    for k, task in enumerate(tasks):
        before[node[k]] += [node[index[name]] for name in _awaits(task) if name in index]
    state = [0] * len(before)  # 0: not visited, 1: on the way, 2: done
    named: set[int] = set()
    for start in range(len(before)):
        way, steps = [start], [iter(before[start])] if state[start] == 0 else []
        while steps:
            state[way[-1]] = 1
            following = next(steps[-1], None)
            if following is None:
                state[way.pop()] = 2
                steps.pop()
            elif state[following] == 1:
                knot = way[way.index(following) :]
                if named.isdisjoint(knot):
                    yield _cycle(tasks, node, knot)
                named.update(knot)
            elif state[following] == 0:
                way.append(following)
                steps.append(iter(before[following]))


def _awaits(task: Task) -> tuple[str, ...]:
    """The tasks that must be done before a task: its prerequisites, and the one that takes on what it delivers."""
    return task.prerequisites if task.delivers is None else (*task.prerequisites, task.delivers)


def _cycle(tasks: Sequence[Task], node: Sequence[int], knot: list[int]) -> Fault:
    """The fault of a cycle: its tasks, where one starts with the task before it said so."""
    index = {t.id: k for k, t in reversed(list(enumerate(tasks)))}
    words: list[str] = []
    reached = first = None
    for here, there in zip(knot, [*knot[1:], knot[0]], strict=True):
        waits, reaches = next(
            (k, index[name])
            for k, task in enumerate(tasks)
            if node[k] == here
            for name in _awaits(task)
            if name in index and node[index[name]] == there
        )
        words += _reached(tasks, reached, waits)
        first = waits if first is None else first
        reached = reaches
    assert first is not None
    words += _reached(tasks, reached, first)
    key = "prerequisites" if tasks[first].prerequisites else "delivers"
    return Fault(("tasks", first, key), f"cycle {' -> '.join(words)}", "prerequisites without a cycle")


def _reached(tasks: Sequence[Task], reached: int | None, waits: int) -> list[str]:
    """The task that waits next; with the one that was reached, where that only starts with it."""
    if reached is None or reached == waits:
        return [tasks[waits].id]
    return [f"{tasks[reached].id}, which starts with {tasks[waits].id}"]
