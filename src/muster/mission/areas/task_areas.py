"""The areas of a mission's tasks: where tasks with areas are, and what is wrong with their polygons."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from importlib.util import find_spec
from itertools import pairwise
from typing import Any

from muster.mission.areas.polygons import polygon_fault
from muster.mission.errors import MissingExtraError
from muster.mission.mission_data import MissionData
from muster.mission.mission_parts import all_work, rules_of_tags
from muster.mission.site import Point
from muster.mission.tasks import Action, Task, Work
from muster.mission.value_types import INVALID, Fault, Path, shown
from muster.mission.values.raw_records import robots_in, tasks_in

Ring = tuple[Point, ...]

FARTHEST_M = 1e8
"""From the origin of the map frame: farther away rounding shows."""
_TOUCHES = 1e-9
"""Of an area: what a hole has beyond it, if no more, is rounding."""


def put_in_positions(data: object) -> None:
    """Give each task in plain data that has an area and no position the middle of its area, on the ground."""
    spatial = any(len(robot["position"]) == 3 for _, robot in robots_in(data) if _is_place(robot.get("position")))
    for _, task in tasks_in(data):
        action = task.get("action")
        area = action.get("area") if isinstance(action, dict) else None
        if area is None or "position" in task:
            continue
        if isinstance(area, list) and area and all(map(_is_place, area)):
            task["position"] = [*_middle([corner[:2] for corner in area]), *([0.0] if spatial else [])]
        else:
            task["position"] = INVALID  # the area is wrong, and the reader says so


def _is_place(value: Any) -> bool:
    return isinstance(value, list | tuple) and len(value) in (2, 3) and all(type(c) in (int, float) for c in value)


def _middle(corners: Sequence[Sequence[float]]) -> tuple[float, float]:
    """The centre of gravity of a polygon; of its corners where it has no surface."""
    east, north = corners[0]
    moved = [(x - east, y - north) for x, y in corners]
    crosses = [(a[0] * b[1] - b[0] * a[1], a, b) for a, b in pairwise([*moved, moved[0]])]
    doubled = math.fsum(cross for cross, _, _ in crosses)
    if not doubled or not math.isfinite(doubled):
        return sum(x for x, _ in corners) / len(corners), sum(y for _, y in corners) / len(corners)
    x, y = (math.fsum(cross * (a[k] + b[k]) for cross, a, b in crosses) / (3 * doubled) for k in (0, 1))
    return east + x, north + y


def area_faults(mission: MissionData) -> Iterator[Fault]:
    """What is wrong with the areas of tasks, and with what they are split into.

    Raises
    ------
    MissingExtraError
        if there are areas and Shapely is not installed.
    """
    for k, found in rules_of_tags(mission):
        if _action_over_area(found.becomes) is not None:
            expected = "an action without an area: tags lie anywhere"
            yield Fault(("found", k, "becomes", "action"), shown("coverage"), expected)
    ids = {task.id for task in mission.tasks} | {station.id for station in mission.stations}
    for at, work in all_work(mission):
        action = _action_over_area(work)
        if action is None or at[0] == "found":
            continue
        if not find_spec("shapely"):
            raise MissingExtraError("map", "an area")
        assert action.area is not None
        for key, value, expected in _polygon_faults(action.area, action.holes, action.cross_holes, action.width_m):
            yield Fault((*at, "action", *key), value, expected)
        if isinstance(work, Task) and is_split(work):
            yield from _split_faults(at, work, mission, ids)
    with_area = {task.id for task in mission.tasks if _action_over_area(task) is not None}
    for k, event in enumerate(mission.events):
        if event.move_task is not None and event.move_task.task in with_area:
            yield Fault(("events", k, "move_task", "task"), shown(event.move_task.task), "a task without an area")


def is_split(task: Task) -> bool:
    """Whether a task stands for several, one for each part of its area."""
    return task.action is not None and task.action.split is not None and task.action.part is None


def part_ids(task: Task) -> tuple[str, ...]:
    """The ids of the tasks into which one is split; its own where it is not."""
    if not is_split(task):
        return (task.id,)
    assert task.action is not None
    return tuple(f"{task.id}.{k}" for k in range(1, (task.action.split or 1) + 1))


def whole_id(task: Task) -> str:
    """The id of the task of whose parts a task is one; its own where it is none."""
    return task.id.rpartition(".")[0] if task.action is not None and task.action.part is not None else task.id


def _action_over_area(work: Work) -> Action | None:
    return work.action if work.action is not None and work.action.area is not None else None


@lru_cache(maxsize=1024)
def _polygon_faults(
    area: Ring, holes: tuple[Ring, ...], cross_holes: bool, width_m: float | None
) -> tuple[tuple[Path, str, str], ...]:
    """What is wrong with an area and its holes: key, value, what was expected."""
    found = tuple(_wrong_rings(area, holes))
    return found or tuple(_wrong_holes(area, holes, cross_holes)) or tuple(_too_narrow(area, width_m))


def _wrong_rings(area: Ring, holes: tuple[Ring, ...]) -> Iterator[tuple[Path, str, str]]:
    rings: list[tuple[Path, Ring]] = [(("area",), area), *((("holes", k), hole) for k, hole in enumerate(holes))]
    for at, ring in rings:
        if (wrong := polygon_fault(ring, FARTHEST_M)) is not None:
            yield at, *wrong


def _wrong_holes(area: Ring, holes: tuple[Ring, ...], cross_holes: bool) -> Iterator[tuple[Path, str, str]]:
    import shapely

    whole = shapely.Polygon(area)
    left: Any = whole
    for k, hole in enumerate(map(shapely.Polygon, holes)):
        beyond = shapely.difference(hole, whole)
        if beyond.area > _TOUCHES * whole.area:
            x, y = beyond.representative_point().coords[0]
            yield ("holes", k), f"outside the area at ({x:g}, {y:g})", "a polygon inside the area"
        left = shapely.difference(left, hole)
    if left.area <= _TOUCHES * whole.area:
        yield ("holes",), "holes that leave nothing of the area", "holes that leave something to be seen"
    elif not cross_holes and left.geom_type != "Polygon":
        parts = f"holes that cut the area into {len(left.geoms)} parts"
        yield ("holes",), parts, "holes around which a robot gets everywhere, or cross_holes: true"


def _too_narrow(area: Ring, width_m: float | None) -> Iterator[tuple[Path, str, str]]:
    import shapely

    if width_m is None:
        return
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(shapely.Polygon(area)))
    narrow = min(math.dist(corners[0], corners[1]), math.dist(corners[1], corners[2]))
    if narrow < width_m * (1 - _TOUCHES):
        yield ("width_m",), f"{width_m:g}, of an area that is {narrow:.4g} m wide", "a tool narrower than its area"


def _split_faults(at: Path, task: Task, mission: MissionData, ids: set[str]) -> Iterator[Fault]:
    assert task.action is not None
    for key in ("duration_s", "load", "delivers"):
        if getattr(task, key) is not None:
            yield Fault((*at, key), shown(getattr(task, key)), "nothing here beside split: each part is a task")
    for name in part_ids(task):
        if name in ids:
            yield Fault((*at, "id"), shown(task.id), f"an id whose parts have ids of their own: there is a {name}")
    action = task.action
    if action.width_m is None and action.fov_deg is None:
        robots = [r for r in mission.robots if task.is_open_to(r.id)]
        cameras = {robot.camera: robot.id for robot in reversed(robots) if robot.camera is not None}
        if len(cameras) > 1:
            names = " and ".join(list(cameras.values())[::-1][:2])
            expected = "fov_deg, or only_robots with one camera: all parts are made of the same lanes"
            yield Fault((*at, "action", "split"), f"robots with different cameras: {names}", expected)
