"""Marks on the ground of a film: stations, tasks, trails, and rings around robots.

A task is white with a grey rim while it is open, white with the robot's colour around it while a robot works on it, and
wholly in the colour of the robot that has done it; lost tasks are red, cancelled ones grey. The ring around a robot is
as wide as the space that it must keep clear, and red if the robot is out; drones have a pole down to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from muster.mission.model import Station, Task
from muster.motion.grid import Floats
from muster.report.figures.styles import ALARM, LEFT_OUT, SERVICE, SERVICE_EDGE, robot_style
from muster.state.mission_state import CANCELLED, DONE, LOST, OPEN, UNDER_WAY
from muster.state.robots import KnownRobot
from muster_physics.buildings import Rgba
from muster_physics.film.interpolation import RunInterpolation
from muster_physics.visual_marks import Mark, ball, disc, strip

TASK_PX, RING_PX, TRAIL_PX, STATION_PX = 7.0, 7.0, 2.2, 9.0
"""Least sizes in pixels of a film: radii of tasks, rings and stations, width of trails."""
_LEVEL_M = 0.0015
"""Between what lies upon each other, as a share of a pixel's size where this is more."""
_STANDS_M = 0.3
"""Tasks higher than this above the ground are balls on poles."""
_BEND_RAD, _PIECE_PX, _MOST_PIECES = 0.12, 40.0, 6000


def rgba(color: str, opaque: float = 1.0, *, faded: float = 0.0) -> Rgba:
    """Of "#rrggbb"; `faded` is the share of white in it."""
    red, green, blue = ((1 - faded) * int(color[k : k + 2], 16) / 255 + faded for k in (1, 3, 5))
    return red, green, blue, opaque


class GroundMarks:
    """Makes the marks of a moment.

    Parameters
    ----------
    moments
        the interpolated run.
    ground_m
        height of the ground.
    pixel_m
        the width of the film's pixel, metres.
    """

    def __init__(self, moments: RunInterpolation, ground_m: float, pixel_m: float) -> None:
        self._moments, self._ground_m, self._pixel_m = moments, ground_m, pixel_m
        self._level_m = max(_LEVEL_M, 0.03 * pixel_m)
        self._trails: list[list[Mark | None]] = [[] for _ in range(moments.poses.shape[1])]
        count = moments.poses.shape[1]
        most = max(1, _MOST_PIECES // max(1, count))
        self._bends = [_bends(moments.poses[:, k, :3], _PIECE_PX * pixel_m, most) for k in range(count)]

    def at(self, now: float, poses: Floats) -> Iterator[Mark]:
        """Marks, trails last: of these there may be more than a scene has room for.

        Parameters
        ----------
        poses
            (n, 7) of the bodies now.
        """
        mission_state = self._moments.mission_state
        colors = {name: robot_style(k).color for k, name in enumerate(mission_state.robots)}
        for station in mission_state.mission.stations:
            yield from self._station(station)
        for name, task in mission_state.tasks.items():
            who = colors.get(self._moments.busy_with.get(name, ""), LEFT_OUT)
            yield from self._task(task, mission_state.stage(name), who)
        yield from self._rings(mission_state.robots, colors, poses)
        for k in range(len(poses)):
            yield from self._trail(k, now, poses[k])

    def _trail(self, robot: int, now: float, pose: Floats) -> Iterator[Mark]:
        """The way so far; on the ground, or in the air."""
        bends, drawn = self._bends[robot], self._trails[robot]
        while len(drawn) + 1 < len(bends) and self._moments.times_s[bends[len(drawn) + 1][0]] <= now:
            drawn.append(self._piece(robot, bends[len(drawn)][1], bends[len(drawn) + 1][1]))
        yield from (piece for piece in drawn if piece is not None)
        if bends and np.isfinite(pose).all():
            piece = self._piece(robot, bends[len(drawn)][1], pose[:3])
            if piece is not None:
                yield piece

    def _piece(self, robot: int, start: Floats, end: Floats) -> Mark | None:
        lift, color = (0.0, 0.0, self._level_m), rgba(robot_style(robot).color, faded=0.45)
        return strip(start + lift, end + lift, TRAIL_PX * self._pixel_m, self._level_m, color)

    def _station(self, station: Station) -> Iterator[Mark]:
        """A cross on the ground below it."""
        middle = np.array([*station.position[:2], self._ground_m + 2 * self._level_m])
        arm = STATION_PX * self._pixel_m
        for along in (np.array([arm, 0.0, 0.0]), np.array([0.0, arm, 0.0])):
            for grown, color, lift in ((1.15, SERVICE_EDGE, 0.0), (1.0, SERVICE, self._level_m)):
                end, width = along * grown, arm * (0.72 if lift == 0.0 else 0.5)
                at = middle + np.array([0.0, 0.0, lift])
                band = strip(at - end, at + end, width, self._level_m, rgba(color))
                if band is not None:
                    yield band

    def _task(self, task: Task, state: str, who: str) -> Iterator[Mark]:
        rim, core = {
            OPEN: (rgba("#5A5F66"), rgba("#FFFFFF")),
            UNDER_WAY: (rgba(who), rgba("#FFFFFF")),
            DONE: (rgba(who), rgba(who)),
            LOST: (rgba(ALARM), rgba(ALARM, faded=0.5)),
            CANCELLED: (rgba(LEFT_OUT), rgba(LEFT_OUT, faded=0.5)),
        }[state]
        radius = TASK_PX * self._pixel_m * (1.35 if state == UNDER_WAY else 1.0)
        inner = radius * (0.6 if state == UNDER_WAY else 0.72)
        x, y, z = (*task.position, 0.0)[:3]
        foot = np.array([x, y, self._ground_m + 3 * self._level_m])
        if z < self._ground_m + _STANDS_M:
            yield disc(foot, radius, rim)
            yield disc(np.array([x, y, foot[2] + self._level_m]), inner, core)
            return
        top = np.array([x, y, z])
        pole = strip(foot, top, 1.5 * self._pixel_m, 1.5 * self._pixel_m, rgba("#9AA0A8"))
        yield disc(foot, radius / 2, rgba("#9AA0A8"))
        if pole is not None:
            yield pole
        yield disc(top, radius * 1.15, rim)
        yield ball(top, radius * 0.8, core)

    def _rings(self, robots: Mapping[str, KnownRobot], colors: Mapping[str, str], poses: Floats) -> Iterator[Mark]:
        for (name, known), pose in zip(robots.items(), poses, strict=False):
            robot = known.robot
            if not np.isfinite(pose).all():
                continue
            color = ALARM if name in self._moments.out else colors[name]
            large = robot.radius_m > RING_PX * self._pixel_m
            radius = robot.radius_m if large else RING_PX * self._pixel_m
            foot = np.array([pose[0], pose[1], self._ground_m + 6 * self._level_m])
            yield disc(foot, radius, rgba(color, 0.3 if large else 0.6))
            if robot.kind == "air":
                pole = strip(foot, pose[:3], self._pixel_m, self._pixel_m, rgba(color, 0.5))
                if pole is not None:
                    yield pole


def _bends(way: Floats, piece_m: float, most: int) -> list[tuple[int, Floats]]:
    """The rows of a path (m, 3) at which it bends, or goes on straight for long, with the places; at most `most`."""
    there = np.flatnonzero(np.isfinite(way).all(axis=1)).tolist()
    if not there:
        return []
    kept = [(there[0], way[there[0]])]
    ahead, tip = np.zeros(3), kept[0]
    for row in there[1:]:
        (step, far), reached = _from(kept, way[row]), _from(kept, tip[1])[1]
        if far < reached - piece_m / 20:  # it has turned back, maybe just as it came
            kept.append(tip)
            step, far = _from(kept, way[row])
        turned = not ahead.any() or float(ahead @ step) < far * np.cos(_BEND_RAD)
        if far > piece_m / 20 and (turned or far > piece_m):
            kept.append((row, way[row]))
            ahead = step / far
        if far >= reached or kept[-1][0] >= tip[0]:
            tip = (row, way[row])
    return kept[:: -(-len(kept) // most) or 1]


def _from(kept: list[tuple[int, Floats]], place: Floats) -> tuple[Floats, float]:
    """The step to a place from the last one kept, and how far that is."""
    step = place - kept[-1][1]
    return step, float(np.linalg.norm(step))
