"""A task over an area that is split, as the tasks that are its parts: `field` as `field.1`, `field.2`, ...

Whatever names the task names all of its parts then. Nothing above this knows of tasks that are split.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from muster.mission.areas.task_areas import is_split, part_ids
from muster.mission.events import Event
from muster.mission.mission_data import MissionData
from muster.mission.source import IN_PYTHON
from muster.mission.task_relations import RELATIONS
from muster.mission.tasks import Found, Task, Work

Parts = Mapping[str, tuple[str, ...]]
W = TypeVar("W", bound=Work)


def with_parts(mission: MissionData) -> Mapping[str, Any]:
    """The fields of a mission that change where each split task becomes its parts; none where no task is split."""
    parts = {task.id: part_ids(task) for task in mission.tasks if is_split(task)}
    if not parts:
        return {}
    tasks = [(k, part) for k, task in enumerate(mission.tasks) for part in _parts_of(_naming_parts(task, parts))]
    events = [(k, one) for k, event in enumerate(mission.events) for one in _events_of(event, parts)]
    source = mission.source
    if source is not IN_PYTHON:
        source = source.renumbered({"tasks": [k for k, _ in tasks], "events": [k for k, _ in events]})
    return {
        "tasks": tuple(task for _, task in tasks),
        "events": tuple(event for _, event in events),
        "found": tuple(_found(found, parts) for found in mission.found),
        "source": source,
    }


def _parts_of(task: Task) -> Iterator[Task]:
    if not is_split(task):
        yield task
        return
    assert task.action is not None
    for k, name in enumerate(part_ids(task), 1):
        yield replace(task, id=name, action=replace(task.action, part=k))


def _naming_parts(work: W, parts: Parts) -> W:
    """The same work, with the parts of a task wherever it names the task."""
    names = (*work.prerequisites, *(name for relation in RELATIONS for name in getattr(work, relation)))
    if parts.keys().isdisjoint(names):
        return work
    changes: dict[str, Any] = {relation: _named(getattr(work, relation), parts) for relation in RELATIONS}
    changes["prerequisites"] = _named(work.prerequisites, parts)
    changes["lags"] = {one: lag for name, lag in work.lags.items() for one in parts.get(name, (name,))}
    return replace(work, **changes)


def _named(names: Sequence[str], parts: Parts) -> tuple[str, ...]:
    return tuple(dict.fromkeys(one for name in names for one in parts.get(name, (name,))))


def _events_of(event: Event, parts: Parts) -> Iterator[Event]:
    if event.cancel_task is not None and event.cancel_task in parts:
        yield from (replace(event, cancel_task=name) for name in parts[event.cancel_task])
    elif event.delay_task is not None and event.delay_task.task in parts:
        delay = event.delay_task
        yield from (replace(event, delay_task=replace(delay, task=name)) for name in parts[delay.task])
    elif event.new_task is not None:
        yield replace(event, new_task=_naming_parts(event.new_task, parts))
    else:
        yield event


def _found(found: Found, parts: Parts) -> Found:
    return replace(found, becomes=_naming_parts(found.becomes, parts))
