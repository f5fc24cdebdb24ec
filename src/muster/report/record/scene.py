"""The scene of a mission for 3-D viewers: foxglove.SceneUpdate with map, tasks, stations, robots and planned routes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from muster.mission.model import Map, Point, Robot, Station, Task, Zone
from muster.mission.stations import station_sign
from muster.report.figures.styles import ALARM, FRAME, LEFT_OUT, SERVICE_EDGE, robot_style
from muster.report.record.json_messages import MAP_FRAME, body_frame, pose, stamp
from muster.state import ExecutionEvent
from muster.state.mission_state import CANCELLED, DONE, LOST, OPEN, UNDER_WAY, MissionState

_LEAST_RADIUS_M = 0.1  # so that a robot without a radius is seen
_TASK_RADIUS_M = 0.12
_FONT_PX = 12.0
_TASK_COLORS = {OPEN: "#E69F00", UNDER_WAY: "#0072B2", DONE: "#009E73", LOST: ALARM, CANCELLED: LEFT_OUT}


def update(entities: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """A foxglove.SceneUpdate with entities that are new or replace those of the same id."""
    return {"deletions": [], "entities": list(entities)}


def map_entities(chart: Map | None) -> list[dict[str, Any]]:
    """Boundary and zones, as outlines at the heights that they have."""
    if chart is None:
        return []
    outlines = [] if chart.boundary is None else [_entity("boundary", lines=[_outline(chart.boundary, 0.0)])]
    return outlines + [_entity(f"zone/{k}", lines=_zone_lines(zone)) for k, zone in enumerate(chart.zones)]


def robot_entity(now: float, robot: Robot, index: int) -> dict[str, Any]:
    """A robot: a cylinder as wide as its body, with its id, attached to its frame."""
    side = 2 * max(robot.radius_m, _LEAST_RADIUS_M)
    drum = {
        "pose": pose((0.0, 0.0, side / 4)),
        "size": {"x": side, "y": side, "z": side / 2},
        "bottom_scale": 1.0,
        "top_scale": 0.7,
        "color": _color(robot_style(index).color),
    }
    text = _text(robot.id, (0.0, 0.0, side))
    return _entity(f"robot/{robot.id}", now, frame=body_frame(robot.id), cylinders=[drum], texts=[text])


def task_entity(now: float, task: Task, state: str) -> dict[str, Any]:
    """A task: a sphere in the colour of its state, with its id."""
    place = _in_space(task.position)
    side = 2 * _TASK_RADIUS_M
    ball = {"pose": pose(place), "size": {"x": side, "y": side, "z": side}, "color": _color(_TASK_COLORS[state])}
    text = _text(task.id, (place[0], place[1], place[2] + 2 * side))
    return _entity(f"task/{task.id}", now, {"state": state}, spheres=[ball], texts=[text])


def station_entity(station: Station) -> dict[str, Any]:
    """A station: a flat drum with its id in brackets."""
    place, side = _in_space(station.position), 4 * _TASK_RADIUS_M
    drum = {
        "pose": pose(place),
        "size": {"x": side, "y": side, "z": side / 8},
        "bottom_scale": 1.0,
        "top_scale": 1.0,
        "color": _color(SERVICE_EDGE),
    }
    text = _text(station_sign(station.id), (place[0], place[1], place[2] + side / 2))
    notes = {"services": " ".join(station.services)}
    return _entity(f"station/{station.id}", 0.0, notes, cylinders=[drum], texts=[text])


def route_entity(now: float, robot: str, index: int, points: Sequence[Point]) -> dict[str, Any]:
    """A robot's planned route as a line; it replaces that of the previous plan."""
    line = _line(0, points, robot_style(index).color, 2.0)
    return _entity(f"route/{robot}", now, lines=[line] if len(points) > 1 else [])


def _entity(
    name: str, now: float = 0.0, notes: Mapping[str, str] | None = None, frame: str = MAP_FRAME, **shapes: Any
) -> dict[str, Any]:
    kinds = ("arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models")
    return {
        "timestamp": stamp(now),
        "frame_id": frame,
        "id": name,
        "lifetime": {"sec": 0, "nsec": 0},
        "frame_locked": True,
        "metadata": [{"key": key, "value": value} for key, value in (notes or {}).items()],
        **{kind: shapes.get(kind, []) for kind in kinds},
    }


def _zone_lines(zone: Zone) -> list[dict[str, Any]]:
    levels = [zone.floor_m or 0.0]
    if zone.ceiling_m is not None:
        levels.append(zone.ceiling_m)
    return [_outline(zone.polygon, level) for level in levels]


def _outline(polygon: Iterable[Point], level: float) -> dict[str, Any]:
    return _line(1, [(corner[0], corner[1], level) for corner in polygon], FRAME, 1.5)


def _line(kind: int, points: Iterable[Point], color: str, pixels: float) -> dict[str, Any]:
    return {
        "type": kind,
        "pose": pose(),
        "thickness": pixels,
        "scale_invariant": True,
        "points": [dict(zip("xyz", _in_space(point), strict=True)) for point in points],
        "color": _color(color),
        "colors": [],
        "indices": [],
    }


def _text(text: str, place: Sequence[float]) -> dict[str, Any]:
    return {
        "pose": pose(place),
        "billboard": True,
        "font_size": _FONT_PX,
        "scale_invariant": True,
        "color": _color(FRAME),
        "text": text,
    }


def _in_space(point: Point) -> Point:
    return (*point, 0.0)[:3]


def _color(hexadecimal: str) -> dict[str, float]:
    red, green, blue = (int(hexadecimal[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return {"r": red, "g": green, "b": blue, "a": 1.0}


def changed_entities(now: float, mission_state: MissionState, event: ExecutionEvent) -> list[dict[str, Any]]:
    """Apply an event; return the entities of the tasks that it has brought on or moved, and of robots that join."""
    before = len(mission_state.robots)
    changed = mission_state.apply(event)
    tasks = [task_entity(now, mission_state.tasks[name], mission_state.stage(name)) for name in changed]
    robots = list(mission_state.robots.values())
    return [*tasks, *(robot_entity(now, robots[k].robot, k) for k in range(before, len(robots)))]
