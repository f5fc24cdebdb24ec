"""What the lidars of a simulated team measure: each scans where it is, and enters that where it takes itself to be.

Where other robots say that they are there is no obstacle, nor on the border of a zone that is closed by rule.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.model import Robot
from muster.motion.grid import Bools, Floats
from muster.motion.map_world import Body, World, body_of
from muster.perception.laser import LIDAR
from muster.perception.occupancy_map import Scan
from muster.perception.sphere_scanner import SPHERE_LIDAR
from muster.perception.voxel_map import SpaceScan
from muster.running.team_ground import APART_CELLS
from muster.simulation import SimulatedWorld

if TYPE_CHECKING:
    from muster.motion.port import Telemetry

LOOK_S = 0.5
"""Seconds between two scans of robots that move."""
_NARROW_LOOK_S = 0.1
"""Seconds between two scans of a team with narrow robots."""
_WIDE_S = 0.05
"""Seconds in which a robot that is not narrow drives no farther than its radius."""
_ON_BORDER_M = 0.02
"""From the border of a zone in which a beam ends there."""


def room_m(robots: Iterable[Robot]) -> float:
    """Return how far narrow robots keep off what lidars meet, in metres; 0 where there are none.

    Between two scans a robot drives on by what it knows: round a corner into what it has not seen, or where a wall that
    it drives along is met by few beams. One that is wide keeps far enough off the corner and the wall. A narrow one is
    one that drives farther than its radius in a twentieth of a second.
    """
    rooms_m = [(robot.speed_mps * _WIDE_S, robot.radius_m) for robot in robots]
    return max((least_m for least_m, radius_m in rooms_m if radius_m < least_m), default=0.0)


def look_s(least_m: float) -> float:
    """Return the seconds between two scans of robots that keep off walls by what `room_m` returns."""
    return _NARROW_LOOK_S if least_m else LOOK_S


@dataclass(frozen=True)
class LidarScans:
    """The scans of the robots of a world.

    Parameters
    ----------
    world : SimulatedWorld
        The simulated world.
    truth : World
        The world of the mission, with its obstacles.
    rules : callable
        Returns what is closed by rule now.
    cell_m : float
        Side of a cell of the map that is built, metres.
    robot : callable
        Returns a robot by its id.
    """

    world: SimulatedWorld
    truth: World
    rules: Callable[[], World]
    cell_m: float
    robot: Callable[[str], Robot]

    def around(
        self, robot: Robot, number: int, told: Telemetry | None, said: Mapping[str, Telemetry | None]
    ) -> SpaceScan:
        """Return one scan all around; the arguments are those of `in_plane`."""
        eye, heading = self.world.positions[number].copy(), float(self.world.headings[number])
        if told is not None:
            eye, heading = np.array(told.position), told.heading
        seen = self.world.scan_space(robot.id, SPHERE_LIDAR)
        scan = SpaceScan(eye, heading, seen.ranges, np.isfinite(seen.ranges) & ~seen.on_ground, seen.on_ground)
        ends, _ = scan.points(SPHERE_LIDAR)
        scan.hits[scan.hits] = self._are_things(robot.id, ends, said)
        return scan

    def in_plane(self, robot: Robot, number: int, told: Telemetry | None, said: Mapping[str, Telemetry | None]) -> Scan:
        """Return one scan in the plane from where the robot truly is.

        Parameters
        ----------
        robot, number : Robot, int
            The robot, and its number in the world.
        told : Telemetry, optional
            The pose that it takes for its own; None: where it truly is.
        said : mapping of str to Telemetry
            What each robot says of where it is, as far as it is heard.
        """
        (x, y), heading = self.world.positions[number, :2], float(self.world.headings[number])
        if told is not None:
            (x, y), heading = told.position[:2], told.heading
        ranges = self.world.scan(robot.id, LIDAR)
        scan = Scan.of((float(x), float(y), heading), ranges)
        angles = heading + LIDAR.bearings[scan.hits]
        ends = np.column_stack([x + ranges[scan.hits] * np.cos(angles), y + ranges[scan.hits] * np.sin(angles)])
        is_ruled = self._on_ruled_borders(body_of(robot), ends)
        scan.hits[scan.hits] = self._are_things(robot.id, ends, said) & ~is_ruled
        return scan

    def _are_things(self, robot: str, places: Floats, said: Mapping[str, Telemetry | None]) -> Bools:
        """Return which places (n, d) at which a robot met something are not where other robots say that they are."""
        is_thing = np.ones(len(places), dtype=np.bool_)
        margin_m = APART_CELLS * self.cell_m
        for one, other in said.items():
            if other is not None and one != robot:
                away = np.linalg.norm(places - np.array(other.position)[: places.shape[1]], axis=1)
                is_thing &= away > self.robot(one).radius_m + margin_m
        return is_thing

    def _on_ruled_borders(self, body: Body, places: Floats) -> Bools:
        """Return whether places (n, 2) are on the border of a zone that is closed to a body by rule."""
        import shapely

        image = self.truth.image
        within_m = _ON_BORDER_M if image is None else image.resolution_m
        on = np.zeros(len(places), dtype=np.bool_)
        for area in self.rules().stopping(body, self.truth.dimensions == 3):
            on |= shapely.distance(area.polygon.exterior, shapely.points(places)) <= within_m
        return on


def is_heard(said: Telemetry | None, now: float, dt_s: float) -> bool:
    """Return whether what a robot said last is of now, up to half a step of the world."""
    return said is not None and said.time_s >= now - dt_s / 2
