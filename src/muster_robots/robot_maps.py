"""The maps that robots on ROS build themselves, of ROS 1 and ROS 2 alike: `nav_msgs/OccupancyGrid` on `<robot>/map`.

A map counts only if its frame is tied to the mission's (`tied_frames`). The newest of each robot counts; one that came
before its frame was tied counts from when it is.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.motion.frames import Floats, angles
from muster.perception.robot_grids import RobotGrid
from muster_robots.tied_frames import TiedFrames

_LEVEL_RAD = 0.1
"""Tilt against the mission's frame up to which a map counts as level."""


@dataclass(frozen=True, eq=False)
class MapMessage:
    """A message nav_msgs/OccupancyGrid, as far as it is used.

    Parameters
    ----------
    frame : str
        Name of its frame.
    origin : ndarray of float, shape (4, 4), optional
        Pose of the outer corner of cell (0, 0) in that frame; None: it is no pose.
    cell_m : float
        Side of a cell, metres.
    size : tuple of int
        Rows and columns.
    per_cent : ndarray of int8, shape (rows * columns,)
        Occupancy of the cells, row by row; -1 where it is not known.
    """

    frame: str
    origin: Floats | None
    cell_m: float
    size: tuple[int, int]
    per_cent: npt.NDArray[np.int8]


class RobotMaps:
    """The newest map of each robot; threads may share it.

    Parameters
    ----------
    frames : TiedFrames
        The frames that are tied to the mission's.
    warn : callable
        Is called with a line on each map that does not count, once for each reason and robot.
    """

    def __init__(self, frames: TiedFrames, warn: Callable[[str], object]) -> None:
        self._frames, self._warn = frames, warn
        self._topics: dict[str, str] = {}
        self._waiting: dict[str, MapMessage] = {}
        self._why_not: dict[str, str] = {}
        self._good: set[str] = set()
        self._come: dict[str, RobotGrid] = {}
        self._lock = threading.Lock()

    def expect(self, robot: str, topics: str) -> str:
        """Return the topic on which a robot tells its map, by its namespace, such as `/r_0`; `missing` knows of it."""
        self._topics[robot] = f"{topics}/map"
        return self._topics[robot]

    def take(self, robot: str, message: MapMessage) -> None:
        """Take in what a robot has said."""
        with self._lock:
            self._waiting[robot] = message

    def new(self) -> dict[str, RobotGrid]:
        """Return the maps that count and have come since the last call, by robot, in the mission's frame."""
        self._hear()
        come, self._come = self._come, {}
        return come

    def missing(self, robot: str) -> str:
        """Return in words why no map of a robot counts so far; empty: one does, or none is expected."""
        self._hear()
        if robot in self._good or robot not in self._topics:
            return ""
        return self._why_not.get(robot, f"nothing on {self._topics[robot]}")

    def _hear(self) -> None:
        """Place what has come in the mission's frame; what is not tied to it waits."""
        with self._lock:
            messages, self._waiting = self._waiting, {}
        for robot, message in messages.items():
            try:
                grid = self._grid(message)
            except ParameterError as error:
                self._refuse(robot, f"its map: {error}")
                continue
            if grid is None:
                self._refuse(
                    robot, f"its map is in frame {message.frame}, which tf does not tie to {self._frames.name}"
                )
                with self._lock:
                    self._waiting.setdefault(robot, message)
                continue
            self._good.add(robot)
            self._why_not.pop(robot, None)
            self._come[robot] = grid

    def _grid(self, message: MapMessage) -> RobotGrid | None:
        """Return the grid in the mission's frame; None if its frame is not tied to that.

        Raises
        ------
        ParameterError
            If the message holds no map, or one that is not level.
        """
        if message.origin is None:
            raise ParameterError("origin: no pose; expected finite numbers, and a quaternion")
        origin = self._frames.to_map(message.frame, message.origin)
        if origin is None:
            return None
        roll, pitch, yaw = angles(origin[:3, :3])
        tilt_rad = max(abs(roll), abs(pitch))
        if tilt_rad > _LEVEL_RAD:
            raise ParameterError(f"origin: tilted by {tilt_rad:.2f} rad; expected a level map")
        x, y = origin[:2, 3]
        return RobotGrid.of(message.per_cent, message.size, message.cell_m, (float(x), float(y), float(yaw)))

    def _refuse(self, robot: str, why: str) -> None:
        if self._why_not.get(robot) != why:
            self._why_not[robot] = why
            self._warn(f"robot {robot}: {why}")
