"""All robots, work and positions of a mission, also those that come later, with their paths."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from muster.mission.events import Event
from muster.mission.mission_data import MissionData
from muster.mission.robots import Robot
from muster.mission.site import Point
from muster.mission.tasks import Found, Task, Work
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import Fault, Path, shown


def new_tasks(mission: MissionData) -> list[tuple[Path, Task]]:
    """The tasks of events."""
    return [(("events", k, "new_task"), e.new_task) for k, e in enumerate(mission.events) if e.new_task]


def robots_that_join(mission: MissionData) -> list[tuple[Path, Robot]]:
    """The robots of events."""
    return [(("events", k, "robot_joins"), e.robot_joins) for k, e in enumerate(mission.events) if e.robot_joins]


def all_work(mission: MissionData) -> Iterator[tuple[Path, Work]]:
    """Tasks, those that come later, and what becomes of tags."""
    yield from ((("tasks", k), task) for k, task in enumerate(mission.tasks))
    yield from new_tasks(mission)
    yield from ((("found", k, "becomes"), found.becomes) for k, found in rules_of_tags(mission))


def work_that(says: Callable[[Work], object], mission: MissionData) -> Iterator[tuple[Path, Work]]:
    """Those of all work that say something; quickly where no task does."""
    if any(map(says, mission.tasks)) or mission.events or mission.found:
        yield from (each for each in all_work(mission) if says(each[1]))


def all_robots(mission: MissionData) -> list[tuple[Path, Robot]]:
    """Robots, and those that come later."""
    return [*((("robots", k), robot) for k, robot in enumerate(mission.robots)), *robots_that_join(mission)]


def unknown_id(at: Path, name: str, known: Sequence[str], what: str) -> Fault:
    """The fault of an id that no robot, task or door has; `what` is one of these words."""
    return Fault(at, shown(name), f"the id of a {what}{did_you_mean(name, known)}", relies_on=f"{what}s")


def rules_of_tags(mission: MissionData) -> list[tuple[int, Found]]:
    """What becomes of tags, by number; one without a task is on the list of faults already."""
    return [(k, found) for k, found in enumerate(mission.found) if found.becomes is not None]


def _event_places(k: int, event: Event) -> Iterator[tuple[Path, Point]]:
    if event.robot_joins is not None:
        yield ("events", k, "robot_joins", "position"), event.robot_joins.position
    if event.new_task is not None:
        yield from _places(("events", k, "new_task"), event.new_task)
    for key, moved in (("move_task", event.move_task), ("robot_moved", event.robot_moved)):
        if moved is not None:
            yield ("events", k, key, "position"), moved.position


def positions(mission: MissionData) -> Iterator[tuple[Path, Point]]:
    """Every position that a mission names, also in its events."""
    for k, robot in enumerate(mission.robots):
        yield ("robots", k, "position"), robot.position
        if robot.end_position is not None:
            yield ("robots", k, "end_position"), robot.end_position
    for k, task in enumerate(mission.tasks):
        yield from _places(("tasks", k), task)
    for k, station in enumerate(mission.stations):
        yield ("stations", k, "position"), station.position
    for k, event in enumerate(mission.events):
        yield from _event_places(k, event)
    yield from _marks(mission)
    for k, found in rules_of_tags(mission):
        if found.becomes.action is not None:
            for key, point in found.becomes.action.places.items():
                yield ("found", k, "becomes", "action", key), point


def _marks(mission: MissionData) -> Iterator[tuple[Path, Point]]:
    for k, tag in enumerate(mission.tags):
        yield ("tags", k, "position"), tag.position
    for k, landmark in enumerate(mission.landmarks):
        yield ("landmarks", k, "position"), landmark.position


def _places(at: Path, task: Task) -> Iterator[tuple[Path, Point]]:
    yield (*at, "position"), task.position
    if task.entry is not None:
        yield (*at, "entry"), task.entry
    if task.exit is not None:
        yield (*at, "exit"), task.exit
    if task.action is not None:
        yield from (((*at, "action", key), point) for key, point in task.action.places.items())
