"""The scene of a film: bodies, walls and marks at any moment of a run, drawn from one view."""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType
from typing import Self

import cv2
import numpy as np

from muster.mission.model import Mission
from muster.mission.stations import station_sign
from muster.motion.grid import Floats
from muster.report.figures.styles import QUIET_TEXT, SERVICE_EDGE, robot_style
from muster_physics.buildings import Heights
from muster_physics.film.captions import Picture, rgb, write_names
from muster_physics.film.footage import Footage
from muster_physics.film.ground_marks import RING_PX, STATION_PX, TASK_PX, GroundMarks, rgba
from muster_physics.film.interpolation import RunInterpolation
from muster_physics.film.view import Frame, View, view_of
from muster_physics.posed_scene import PosedScene
from muster_physics.rendering import Lens, Renderer

OVERSAMPLED = 2
"""Pictures are drawn so many times as large, and made smaller: edges are smooth, more cheaply than by MuJoCo."""
WALL_PX = 13
MOST_WALL_M = 0.5
"""Walls without a height are shown so high: in pixels of the film, and metres at most."""
_MOST_NAMED = 60
_LEAST_REACH_M = 0.8
_FREE = {"left": 28, "right": 28, "top": 74, "bottom": 30}
"""What is kept free for captions, pixels of the film."""


class FilmScene:
    """Steps through a run and draws it; a context manager.

    Parameters
    ----------
    footage
        of the run.
    width, height
        of the pictures, in pixels.
    """

    def __init__(self, footage: Footage, width: int, height: int) -> None:
        self.moments = RunInterpolation(footage)
        mission = footage.mission
        places = places_of(mission, self.moments.poses)
        self.size = (width, height)
        frame = Frame(width, height, **_FREE)
        self.view: View = view_of(places, frame)
        self._tableau = tableau_of(footage, self.view.pixel_m)
        self._marks = GroundMarks(self.moments, self._tableau.ground_m, self.view.pixel_m)
        self._renderer = Renderer(self._tableau, OVERSAMPLED * width, OVERSAMPLED * height)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._renderer.close()

    def picture(self, now: float) -> Picture:
        """The picture of a moment without captions. Moments must not go back."""
        self.moments.go_on(now)
        poses = self.moments.at(now)
        self._tableau.put(poses[:, :3], poses[:, 3:])
        (width, height), view = self.size, self.view
        lens = Lens(OVERSAMPLED * width, OVERSAMPLED * height, OVERSAMPLED * view.focal_px)
        marks = self._marks.at(now, poses)
        large = self._renderer.seen_from(view.position, view.axes, lens, marks=marks, depth_m=view.depth_m)
        picture: Picture = cv2.resize(large, self.size, interpolation=cv2.INTER_AREA).astype(np.uint8, copy=False)
        name_all(picture, self.moments, poses, view.pixels, view.pixel_m, self._tableau.ground_m)
        return picture


def tableau_of(footage: Footage, pixel_m: float, *, smooth: bool = False) -> PosedScene:
    """The world of a run, its robots in their colours, those that joined included, between low walls.

    Parameters
    ----------
    pixel_m
        how many metres a pixel of the picture is across.
    """
    simulated = footage.world.replica(Heights.low(min(WALL_PX * pixel_m, MOST_WALL_M)))
    colors = [rgba(robot_style(k).color) for k in range(len(simulated.robots))]
    return PosedScene(simulated, colors, smooth=smooth)


def name_all(
    picture: Picture,
    moments: RunInterpolation,
    poses: Floats,
    pixels: Callable[[Floats], Floats],
    pixel_m: float,
    ground_m: float,
) -> None:
    """Write tasks' ids beneath them, if there are not too many, and robots' above them.

    Parameters
    ----------
    pixels, pixel_m
        the places in the picture, and the width of its pixel in metres.
    """
    tasks, robots = (
        list(moments.mission_state.tasks.values()),
        [known.robot for known in moments.mission_state.robots.values()][: len(poses)],
    )
    if len(tasks) <= _MOST_NAMED:
        places = np.array([(*task.position, ground_m)[:3] for task in tasks]).reshape(-1, 3)
        at = pixels(places)
        at[:, 1] += TASK_PX + 13.0
        write_names(picture, [(task.id, rgb(QUIET_TEXT)) for task in tasks], at, 11, 400)
    _name_stations(picture, moments.mission_state.mission, pixels, ground_m)
    names = [(robot.id, rgb(robot_style(k).color)) for k, robot in enumerate(robots)]
    rings = np.array([max(robot.radius_m / pixel_m, RING_PX) for robot in robots])
    at = pixels(poses[: len(robots), :3])
    at[:, 1] -= rings + 5.0
    write_names(picture, names, at, 13, 600)


def _name_stations(picture: Picture, mission: Mission, pixels: Callable[[Floats], Floats], ground_m: float) -> None:
    if not 0 < len(mission.stations) <= _MOST_NAMED:
        return
    at = pixels(np.array([(*station.position[:2], ground_m) for station in mission.stations]))
    at[:, 1] += STATION_PX + 13.0
    names = [(station_sign(station.id), rgb(SERVICE_EDGE)) for station in mission.stations]
    write_names(picture, names, at, 11, 400)


def places_of(mission: Mission, poses: Floats) -> Floats:
    """The places that a picture has to show, (k, 3) metres: stops, robots' tracks, the map's boundary and zones."""
    found = [place for task in mission.tasks for place in (task.position, task.entry, task.exit) if place is not None]
    found += [robot.position for robot in mission.robots]
    found += [station.position for station in mission.stations]
    found += [event.new_task.position for event in mission.events if event.new_task is not None]
    places = np.array([(*place, 0.0)[:3] for place in found]).reshape(-1, 3)
    way = poses[:, :, :3].reshape(-1, 3)
    whole = np.concatenate([places, way[np.isfinite(way).all(axis=1)], _corners(mission)])
    low, high = whole[:, :2].min(axis=0), whole[:, :2].max(axis=0)
    around = np.maximum(_LEAST_REACH_M - (high - low) / 2, 0.03 * (high - low).max())
    (west, south), (east, north), ground = low - around, high + around, whole[:, 2].min()
    return np.concatenate([whole, [(x, y, ground) for x in (west, east) for y in (south, north)]])


def _corners(mission: Mission) -> Floats:
    if mission.map is None:
        return np.empty((0, 3))
    from muster.motion.map_world import World
    from muster.report.maps.floor import map_corners

    corners = map_corners(mission.map, World.of(mission).image)
    return np.array([(*corner, 0.0)[:3] for corner in corners]).reshape(-1, 3)
