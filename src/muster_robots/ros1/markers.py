"""The mission for RViz, on `/muster/markers` (visualization_msgs/MarkerArray): tasks, routes and robots."""

from __future__ import annotations

import colorsys
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.motion.port import Telemetry
from muster_robots.ros1.node import publish
from muster_robots.ros1.ros import Point, rospy
from muster_robots.ros1.sensor_messages import Marker, MarkerArray

_EVERY_S = 0.5
"""Seconds of the mission's clock between two pictures, where nothing happens before."""
_SIZE_M = 0.3
_OPEN, _DONE, _WORDS = (0.6, 0.6, 0.6), (0.2, 0.75, 0.3), (0.1, 0.1, 0.1)

Rgb = tuple[float, float, float]
Place = Sequence[float]


class Markers:
    """A `Recorder`. The namespaces of the markers are `tasks`, `routes`, `robots` and `names`.

    Parameters
    ----------
    frame
        of the mission, in tf's words.
    """

    def __init__(self, mission: Mission, frame: str) -> None:
        self._frame = frame
        self._publisher = rospy.Publisher("/muster/markers", MarkerArray, queue_size=2, latch=True)
        self._tasks: dict[str, Place] = {task.id: task.position for task in mission.tasks}
        self._robots = [robot.id for robot in mission.robots]
        self._routes: Mapping[str, Sequence[str]] = {}
        self._done: set[str] = set()
        self._poses: dict[str, tuple[Place, float]] = {}
        self._drawn_s = -math.inf
        publish(self._publisher, MarkerArray([_deleting()]))

    def on_plan(self, now: float, plan: Plan) -> None:
        """See `Observer`."""
        self._routes = {route.robot: route.tasks for route in plan.routes}
        self._drawn_s = -math.inf

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """See `Observer`: tasks that are done, new, moved or cancelled, and robots that join."""
        if kind == "ends":
            self._done.add(data["task"])
        elif kind == "new_task":
            self._tasks[data["task"]["id"]] = data["task"]["position"]
        elif kind == "move_task":
            self._tasks[data["task"]] = data["position"]
        elif kind == "cancel_task":
            self._tasks.pop(data["task"], None)
        elif kind == "robot_joins":
            self._robots.append(data["robot"]["id"])
        self._drawn_s = -math.inf

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        """See `Observer`: `on_step` has the poses."""

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """See `Recorder`."""
        for robot, position, heading in zip(self._robots, positions.tolist(), headings.tolist(), strict=False):
            if all(map(math.isfinite, position)):
                self._poses[robot] = (position, heading)
        if now >= self._drawn_s + _EVERY_S:
            self._drawn_s = now
            publish(self._publisher, MarkerArray([_deleting(), *self._all()]))

    def on_report(self, report: Mapping[str, Any]) -> None:
        """See `Recorder`: what was drawn last stays."""

    def _all(self) -> Iterator[Any]:
        colors = {robot: _color(k) for k, robot in enumerate(self._robots)}
        whose = {task: robot for robot, tasks in self._routes.items() for task in tasks}
        for k, (task, place) in enumerate(self._tasks.items()):
            color = _DONE if task in self._done else colors.get(whose.get(task, ""), _OPEN)
            yield self._marker("tasks", k, Marker.SPHERE, place, color)
            yield self._name(k, task, place)
        for k, robot in enumerate(self._robots):
            if robot not in self._poses:
                continue
            place, heading = self._poses[robot]
            body = self._marker("robots", k, Marker.ARROW, place, colors[robot])
            body.scale.x, body.scale.y, body.scale.z = 2 * _SIZE_M, _SIZE_M / 2, _SIZE_M / 2
            body.pose.orientation.z, body.pose.orientation.w = math.sin(heading / 2), math.cos(heading / 2)
            yield body
            yield self._name(len(self._tasks) + k, robot, place)
            left = [self._tasks[task] for task in self._routes.get(robot, ()) if self._is_left(task)]
            yield self._line(k, [place, *left], colors[robot])

    def _is_left(self, task: str) -> bool:
        return task not in self._done and task in self._tasks

    def _marker(self, namespace: str, number: int, kind: int, place: Place, color: Rgb) -> Any:
        marker = Marker()
        marker.header.frame_id, marker.header.stamp = self._frame, rospy.Time.now()
        marker.ns, marker.id, marker.type, marker.action = namespace, number, kind, Marker.ADD
        at = marker.pose.position
        at.x, at.y, at.z = map(float, (*place, 0.0)[:3])
        marker.pose.orientation.w = 1.0
        marker.scale.x = marker.scale.y = marker.scale.z = _SIZE_M
        marker.color.r, marker.color.g, marker.color.b, marker.color.a = (*color, 1.0)
        return marker

    def _name(self, number: int, text: str, place: Place) -> Any:
        x, y, z = (*place, 0.0)[:3]
        marker = self._marker("names", number, Marker.TEXT_VIEW_FACING, (x, y, z + 1.5 * _SIZE_M), _WORDS)
        marker.text = text
        return marker

    def _line(self, number: int, places: Sequence[Place], color: Rgb) -> Any:
        marker = self._marker("routes", number, Marker.LINE_STRIP, (0.0, 0.0, 0.0), color)
        marker.scale.x = _SIZE_M / 6
        marker.points = [Point(*map(float, (*place, 0.0)[:3])) for place in places]
        return marker


def _deleting() -> Any:
    """Takes all markers away that were drawn before."""
    marker = Marker()
    marker.action = Marker.DELETEALL
    return marker


def _color(number: int) -> Rgb:
    """Hues that are far apart for robots that are near in order."""
    return colorsys.hsv_to_rgb((0.58 + 0.381966 * number) % 1.0, 0.75, 0.85)
