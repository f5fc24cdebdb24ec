"""Relations between the tasks of a mission: known tasks, and none that exclude each other."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, combinations
from operator import attrgetter

from muster.mission.mission_data import MissionData
from muster.mission.mission_parts import new_tasks, unknown_id, work_that
from muster.mission.tasks import Task, Work
from muster.mission.value_types import Fault, Path, shown

IN_ITS_PLACE = "done in its place"
"""How a task is named that is done in place of another, behind its id and "is"."""
RELATIONS = ("same_robot_as", "other_robot_than", "starts_with", "either_or")
_tasks_named_by = attrgetter(*RELATIONS)


def tasks_named_by(work: Work) -> tuple[str, ...]:
    """The tasks that one refers to: its prerequisites, those of its relations, and the one that it delivers for."""
    carried = () if work.delivers is None else (work.delivers,)
    return tuple(chain(work.prerequisites, *_tasks_named_by(work), carried))


def relation_faults(mission: MissionData) -> Iterator[Fault]:
    """What is wrong with the relations between tasks."""
    yield from wrong_names(mission, RELATIONS, once="each task once")
    yield from _contradictions(mission.tasks)
    yield from _needed_together(mission.tasks)
    yield from _split_alternatives(mission)


def tied_by(relation: str, tasks: Sequence[Task]) -> list[int]:
    """By task the number of the first task that a relation ties it to, directly or through others; else its own."""
    if not any(map(attrgetter(relation), tasks)):
        return list(range(len(tasks)))
    index = {t.id: k for k, t in reversed(list(enumerate(tasks)))}
    named = ((k, name) for k, task in enumerate(tasks) for name in getattr(task, relation))
    return joined(((k, index[name]) for k, name in named if name in index), len(tasks))


def joined(pairs: Iterable[tuple[int, int]], size: int) -> list[int]:
    """For each of so many things the first one that pairs join it to, directly or through others; else itself."""
    first = list(range(size))

    def found(k: int) -> int:
        while first[k] != k:
            first[k] = first[first[k]]
            k = first[k]
        return k

    for one, other in pairs:
        low, high = sorted((found(one), found(other)))
        first[high] = low
    return [found(k) for k in range(size)]


def units_of(tasks: Collection[Task]) -> dict[str, tuple[str, ...]]:
    """For each task all tasks that begin at the same moment, itself included, in the order given."""
    listed = list(tasks)
    tied = tied_by("starts_with", listed)
    units: dict[int, list[str]] = {}
    for task, first in zip(listed, tied, strict=True):
        units.setdefault(first, []).append(task.id)
    return {task.id: tuple(units[first]) for task, first in zip(listed, tied, strict=True)}


def beginning_apart(task: Task, others: Collection[str]) -> Task:
    """The task, which does not begin together with others."""
    left = tuple(name for name in task.starts_with if name not in others)
    return task if left == task.starts_with else replace(task, starts_with=left)


def alternatives_of(tasks: Collection[Task]) -> list[tuple[str, ...]]:
    """The sets of tasks of which at most one is done, in the order given; most tasks are alone in theirs."""
    listed = list(tasks)
    if not any(task.either_or for task in listed):
        return [(task.id,) for task in listed]
    sets: dict[int, list[str]] = {}
    for task, first in zip(listed, tied_by("either_or", listed), strict=True):
        sets.setdefault(first, []).append(task.id)
    return [tuple(names) for names in sets.values()]


def wrong_names(mission: MissionData, keys: Sequence[str], *, once: str, itself: bool = False) -> Iterator[Fault]:
    """Names of tasks under some keys that no task has, or that stand there twice; or the task's own, unless allowed."""
    ids = [t.id for t in mission.tasks]
    with_new = [*ids, *(t.id for _, t in new_tasks(mission))]
    own, all_of_them = set(ids), set(with_new)
    for path, task in work_that(lambda work: any(getattr(work, key) for key in keys), mission):
        known, among = (ids, own) if path[0] == "tasks" else (with_new, all_of_them)
        for key in keys:
            seen: set[str] = set()
            for n, name in enumerate(getattr(task, key)):
                at: Path = (*path, key, n)
                if name == getattr(task, "id", None) and not itself:
                    yield Fault(at, shown(name), "another task than itself")
                elif name not in among:
                    yield unknown_id(at, name, known, "task")
                elif name in seen:
                    yield Fault(at, shown(name), once)
                seen.add(name)


def _contradictions(tasks: Sequence[Task]) -> Iterator[Fault]:
    """Tasks that the same robot does and that start together, or that other robots do."""
    if not any(task.same_robot_as for task in tasks):
        return
    index = {t.id: k for k, t in reversed(list(enumerate(tasks)))}
    robot = tied_by("same_robot_as", tasks)
    for k, task in enumerate(tasks):
        for n, name in enumerate(task.other_robot_than):
            other = index.get(name)
            if other not in (None, k) and robot[other] == robot[k]:
                yield _contradiction(tasks, ("tasks", k, "other_robot_than", n), k, other)
    yield from _started_by_one_robot(tasks, robot)


def _started_by_one_robot(tasks: Sequence[Task], robot: Sequence[int]) -> Iterator[Fault]:
    """The first two tasks of each start together that the same robot does."""
    together = tied_by("starts_with", tasks)
    seen: dict[tuple[int, int], int] = {}
    for k, key in enumerate(zip(together, robot, strict=True)):
        if key in seen and seen[key] >= 0:
            tied = next(t for t in (k, seen[key], *range(len(tasks))) if tasks[t].starts_with and together[t] == key[0])
            yield _contradiction(tasks, ("tasks", tied, "starts_with"), seen[key], k)
            seen[key] = -1
        seen.setdefault(key, k)


def _contradiction(tasks: Sequence[Task], at: Path, one: int, other: int) -> Fault:
    chain = ", ".join(tasks[k].id for k in _chain(tasks, one, other))
    value = shown(tasks[other].id) if len(at) > 3 else f"{tasks[one].id} with {tasks[other].id}"
    return Fault(at, value, f"tasks of different robots: by same_robot_as one robot does {chain}")


def _chain(tasks: Sequence[Task], start: int, end: int) -> list[int]:
    """The shortest chain of tasks that the same robot does, from one to another that is tied to it."""
    index = {t.id: k for k, t in reversed(list(enumerate(tasks)))}
    beside: dict[int, list[int]] = {}
    for k, task in enumerate(tasks):
        for name in task.same_robot_as:
            if name in index:
                beside.setdefault(k, []).append(index[name])
                beside.setdefault(index[name], []).append(k)
    ways = {start: [start]}
    for here in (queue := [start]):
        for there in beside.get(here, ()):
            if there not in ways:
                ways[there] = [*ways[here], there]
                queue.append(there)
    return ways[end]


def _needed_together(tasks: Sequence[Task]) -> Iterator[Fault]:
    """For two alternatives that one task needs the first such task: it can never be done."""
    sets = [names for names in alternatives_of(tasks) if len(names) > 1]
    if not sets:
        return
    needing, number = _needing(tasks), {task.id: k for k, task in enumerate(tasks)}
    for names in sets:
        after = {name: _reached(needing, name) for name in names}
        for one, other in combinations(names, 2):
            both = [tasks[number[name]] for name in after[one] & after[other]]
            keyed = [(task, key) for task in both for key in _KEYS_OF_NEEDS if getattr(task, key)]
            if keyed:
                task, key = min(keyed, key=lambda found: (found[0].id not in (one, other), number[found[0].id]))
                first = task.id
                value = f"{first} is done only together with {' and '.join(n for n in (one, other) if n != first)}"
                expected = f"tasks that a plan may do together: by either_or it does at most one of {', '.join(names)}"
                yield Fault(("tasks", number[first], key), value, expected)


_KEYS_OF_NEEDS = ("prerequisites", "starts_with", "delivers", "either_or")


def _needing(tasks: Sequence[Task]) -> Mapping[str, set[str]]:
    """For each task those that are done only together with it."""
    needing: dict[str, set[str]] = {task.id: set() for task in tasks}
    for task in tasks:
        for name in (*task.prerequisites, *task.starts_with, task.delivers):
            if name in needing:
                needing[name].add(task.id)
                if name not in task.prerequisites:
                    needing[task.id].add(name)
    return needing


def _reached(needing: Mapping[str, set[str]], start: str) -> set[str]:
    found = {start}
    for name in (waiting := [start]):
        waiting += needing[name] - found
        found |= needing[name]
    return found


def _split_alternatives(mission: MissionData) -> Iterator[Fault]:
    """Areas that are split into tasks of which all are to be done, and not one."""
    split = {task.id for task in mission.tasks if task.action is not None and task.action.split is not None}
    for path, work in work_that(_has_alternatives, mission):
        at, whole = (*path, "either_or"), (getattr(work, "id", ""), *work.either_or)
        for name in (name for name in whole if name in split):
            yield Fault(at, f"{shown(name)}, whose area is split", "tasks whose areas are not split")


def _has_alternatives(work: Work) -> bool:
    return bool(work.either_or)
