"""The paths of a mission's robots over its map, as they are driven and as they are paid for: shortest or straight."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from muster.mission.errors import MissionError
from muster.mission.lanes import Lanes
from muster.mission.model import Mission, Point
from muster.mission.records import findings
from muster.mission.value_types import Fault, shown
from muster.mission.values.arrays import Floats
from muster.motion.free_space import PrismSpace, Space
from muster.motion.map_world import Body, World, body_of
from muster.motion.path import NoPath, Path
from muster.motion.paths import PathFinder
from muster.motion.paths.lane_paths import LanePaths
from muster.motion.smoothing import Smoothed, smoothed
from muster.motion.straight_ways import StraightWays
from muster.motion.unreachable_places import checked_world, why_blocked

_MOST_LEGS = 100_000  # that are kept: a standing fleet is asked for new ones for ever


@dataclass(eq=False)
class RobotPaths:
    """Paths for each body over one map, whose doors close and open.

    Along a path in the plane the height changes evenly.

    Parameters
    ----------
    world
        the map.
    straight
        whether paths are straight, and there is none where a closed area is in the way; else they are the shortest.
    lanes
        to which robots keep whose body has `times`.
    """

    world: World
    straight: bool = False
    lanes: Lanes | None = None
    _finders: dict[Body, PathFinder | StraightWays | LanePaths] = field(default_factory=dict, init=False, repr=False)
    _legs: dict[tuple[Body, Point, Point], float] = field(default_factory=dict, init=False, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        """What is pickled: the map and the lengths found so far; path finders are made again."""
        return {**self.__dict__, "_finders": {}}

    @classmethod
    def of(cls, mission: Mission) -> RobotPaths:
        """The paths over the map of a mission, by its rule of travel.

        Raises
        ------
        MissionError
            for a map that is wrong; with shortest paths, for robots that start or end where they cannot stand; with
            lanes, for those from which no straight way leads to a lane that they can drive.
        MissingExtraError
            if the extra `map` is not installed.
        """
        straight = mission.travel_off_lanes == "euclidean"
        made = cls(World.of_travel(mission) if straight else checked_world(mission), straight, mission.driven_lanes)
        faults = list(made._unjoined(mission))
        if faults:
            raise MissionError(findings(faults, mission.source))
        return made

    def close(self, closed: Collection[str]) -> None:
        """From now on these doors are closed, and the others open."""
        self.world = self.world.with_closed(closed)
        self._finders.clear()
        self._legs.clear()

    def path(self, body: Body, start: Sequence[float], goal: Sequence[float]) -> Path | NoPath:
        """The path between two points of the map frame, or the reason why there is none."""
        found = self._finder(body).path(start, goal)
        if isinstance(found, NoPath):
            return self._told(found, body, tuple(start), tuple(goal))
        return with_heights(found, start, goal)

    def driven(self, body: Body, start: Sequence[float], goal: Sequence[float]) -> tuple[Path, list[float]] | NoPath:
        """Return the path with the greatest speed on each of its pieces, m/s; inf where the robot alone decides."""
        finder = self._finder(body)
        found = finder.driven(start, goal) if isinstance(finder, LanePaths) else self.path(body, start, goal)
        if isinstance(found, Path):
            return found, [math.inf] * (len(found.points) - 1)
        return found if isinstance(found, NoPath) else (with_heights(found[0], start, goal), found[1])

    def leg_s(self, body: Body, start: Point, goal: Point) -> float:
        """Return how long a way along lanes takes from rest to rest, seconds; inf where there is none."""
        exits, entries = (np.array([(*point, 0.0)[:3]], dtype=np.float64) for point in (start, goal))
        seconds = self.measured(body, exits, entries, 1)[1]
        assert seconds is not None, "a body that keeps to lanes"
        return float(seconds[0, 0])

    def leg_m(self, body: Body, start: Point, goal: Point) -> float:
        """The length of the path, metres; inf where there is none. Cached: actions ask for legs repeatedly."""
        leg = (body, start, goal)
        if leg not in self._legs:
            if len(self._legs) >= _MOST_LEGS:
                self._legs.clear()
            found = self.path(body, start, goal)
            self._legs[leg] = math.inf if isinstance(found, NoPath) else found.length_m
        return self._legs[leg]

    def smoothed(self, body: Body, path: Path, radius_m: float) -> Smoothed:
        """A path with its corners rounded by a radius where the map leaves room."""
        return smoothed(path, self._finder(body).clear, radii_m=(radius_m,))

    def clear(self, body: Body, points: npt.ArrayLike) -> bool:
        """Whether a body can move straight from each point of the map frame, (k, d) metres, to the next."""
        return self._finder(body).clear(np.array(points, dtype=np.float64))

    def is_open(self, body: Body, points: Floats) -> bool:
        """Whether no closed area can cross a straight leg between any of the points (k, 3)."""
        finder = self._finder(body)
        return isinstance(finder, StraightWays) and finder.is_open(points)

    def stands(self, body: Body, place: Sequence[float]) -> bool:
        """Whether a body can stand at a place, of which the map's coordinates count."""
        at = place[: self.world.dimensions]
        return self.clear(body, [at, at])

    def _told(self, found: NoPath, body: Body, start: Point, goal: Point) -> NoPath:
        """The same reason with what blocks an end of the path, or with the width of the body that has no path."""
        if self.straight or body.times is not None:
            return found
        for blocked, point in (("start blocked", start), ("goal blocked", goal)):
            if found.reason == blocked:
                place = ", ".join(f"{c:g}" for c in point)
                return NoPath(blocked, f"({place}): {why_blocked(self.world, point, body)}")
        return NoPath(found.reason, f"{found.detail}, radius {body.radius_m:g} m") if body.radius_m else found

    def lengths(self, body: Body, exits: Floats, entries: Floats, threads: int) -> Floats:
        """The lengths (n, m), metres, from exits (n, 3) to entries (m, 3); inf where there is no path."""
        return self.measured(body, exits, entries, threads)[0]

    def measured(self, body: Body, exits: Floats, entries: Floats, threads: int) -> tuple[Floats, Floats | None]:
        """Return the lengths, and the seconds that they take along lanes; None where the lengths tell these."""
        finder, seconds = self._finder(body), None
        if isinstance(finder, LanePaths):
            metres, seconds = finder.lengths(exits, entries, threads=threads)
        else:
            metres = finder.lengths(exits, entries, threads=threads)
            if self.straight or isinstance(self._space(body), PrismSpace):
                return metres, None
        return np.hypot(metres, exits[:, None, 2] - entries[None, :, 2]), seconds

    def _finder(self, body: Body) -> PathFinder | StraightWays | LanePaths:
        if body not in self._finders:
            self._finders[body] = self._made(body)
        return self._finders[body]

    def _made(self, body: Body) -> PathFinder | StraightWays | LanePaths:
        if self.lanes is None or body.times is None:
            return StraightWays(self.world, body) if self.straight else PathFinder(self._space(body))
        sees = now = None
        if not self.world.is_empty:
            sees = self._finder(body.off_lanes).clear
            if self.world.closed:
                now, sees = sees, RobotPaths(self.world.with_closed(()))._finder(body.off_lanes).clear
        return LanePaths(self.lanes, body.radius_m, body.times, sees, now, self.world.closed)

    def _unjoined(self, mission: Mission) -> Iterator[Fault]:
        """Robots that start or end where they are joined to no lane."""
        for k, robot in enumerate(mission.robots if self.lanes is not None else ()):
            finder = self._finder(body_of(robot, mission))
            for key, place in (("position", robot.position), ("end_position", robot.end_position)):
                if isinstance(finder, LanePaths) and place is not None and not finder.joins(place):
                    expected = f"a place from which a straight way leads to a lane for radius {robot.radius_m:g} m"
                    yield Fault(("robots", k, key), shown(list(place)), expected)

    def _space(self, body: Body) -> Space:
        return self.world.free_space(body.radius_m, body.kind)


def with_heights(found: Path, start: Sequence[float], goal: Sequence[float]) -> Path:
    """A planar path in space, between ends with heights: its height changes evenly."""
    if found.points.shape[1] == len(start):
        return found
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(found.points, axis=0), axis=1))])
    share = along / along[-1] if along[-1] > 0 else np.linspace(0.0, 1.0, len(along))
    if len(share) == 1 and start[2] != goal[2]:  # straight up
        return Path(np.array([start, goal], dtype=np.float64))
    return Path(np.column_stack([found.points, start[2] + share * (goal[2] - start[2])]))
