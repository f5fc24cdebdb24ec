"""A robot with a laser among obstacles that no map shows builds the map, and plans its way by it ([tcf-thesis], 2.2.1).

The robot scans, enters the scan into its map (`perception.occupancy_map`), and goes the shortest way by what it knows,
as if all that it has not seen were free. Where an obstacle appears on the way it plans anew. The turns of such a way
are where the line of sight touches inflated obstacles, as Figure 2.1 and (2.14) want the intermediate goal.

With a turning radius it drives the shortest Dubins path to the next turn (Figure 2.2) that is clear of what it knows;
the heading there is (2.13). It is printed for one side; for the other the arcsine is added. Without one it turns on the
spot.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive, require_positive
from muster.motion.frames import wrapped
from muster.motion.map_world import Body, World
from muster.motion.path import NoPath, Path
from muster.motion.paths.dubins_words import Pose, words
from muster.perception.explored_ground import CERTAIN, PASSES, ExploredGround, map_to_build, ruled_world
from muster.perception.laser import LIDAR, NO_DISCS, Scanner, faces_at
from muster.perception.occupancy_map import Scan
from muster.simulation.walls import faces_and_slabs

_LASER_M = 0.1
"""Height of the laser of a robot on the ground."""
_BESIDE = 0.25
"""Share of the field of view, to each side, in which the robot sees where it goes wide enough to go there."""


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """How the robot goes.

    Parameters
    ----------
    scanner : Scanner
        Its laser.
    turning_radius_m : float, optional
        The radius r_turn of its Dubins paths; without it the robot turns on the spot.
    step_m : float
        The way that it drives between two scans.
    arrival_m : float
        The distance from the goal at which it has arrived.
    patience : float
        How many times the straight distance, and as many metres, it drives at most.
    """

    scanner: Scanner = LIDAR
    turning_radius_m: float | None = None
    step_m: float = 0.1
    arrival_m: float = 0.05
    patience: float = 50.0

    def __post_init__(self) -> None:
        require_positive(turning_radius_m=self.turning_radius_m)
        require_finite_positive(step_m=self.step_m, arrival_m=self.arrival_m, patience=self.patience)


@dataclass(frozen=True, eq=False)
class Drive:
    """What the robot drove.

    Parameters
    ----------
    poses : ndarray, shape (k, 3)
        x, y in metres of the map frame, heading.
    ways : int
        How many ways it planned.
    scans : int
        How many scans it took.
    ground : ExploredGround
        The ground as the robot knows it at the end.
    """

    poses: Floats
    ways: int
    scans: int
    ground: ExploredGround

    @property
    def path(self) -> Path:
        return Path(self.poses[:, :2])


def drive(
    world: World, body: Body, start: Pose, goal: tuple[float, float], params: Parameters, *, seed: int = 0
) -> Drive | NoPath:
    """Go from a pose to a place in a world whose obstacles only the laser sees: both ends' x and y, metres."""
    ground = ExploredGround(ruled_world(world), map_to_build(world, [body.radius_m]))
    driver = _Driver(ground, body, goal, params)
    walls, random = faces_at(faces_and_slabs(world, body)[0], _LASER_M), np.random.default_rng(seed)
    poses, driven = [start], 0.0
    most = params.patience * (math.dist(start[:2], goal) + 1)
    while math.dist(poses[-1][:2], goal) > params.arrival_m:
        if driven > most:
            return NoPath("not found", f"after {driven:.1f} m at {_shown(poses[-1])}")
        exact = params.scanner.ranges(poses[-1], walls, NO_DISCS)
        step = driver.step(poses[-1], params.scanner.measured(exact, random))
        if isinstance(step, NoPath):
            return step
        driven += max(math.dist(poses[-1][:2], step[:2]), 1e-3 * params.step_m)
        poses.append(step)
    return Drive(np.array(poses), driver.ways, len(poses) - 1, ground)


@dataclass(eq=False)
class _Driver:
    """The robot's mind: its map, and the way that it is on."""

    ground: ExploredGround
    body: Body
    goal: tuple[float, float]
    params: Parameters
    ways: int = 0
    _ahead: list[Floats] = field(default_factory=list)
    """Turns of the way that are not reached yet."""
    _certainty: int = CERTAIN

    def step(self, here: Pose, ranges: Floats) -> Pose | NoPath:
        """Return the pose after the next step, given a scan here."""
        fresh, changed = self.ground.seen.see(Scan.of(here, ranges), self.params.scanner)
        if changed:
            self.ground.grown()
        if self._ahead:
            left = np.array([here[:2], *self._ahead])
            if not self.ground.is_clear(self.body, left, self._certainty, fresh):
                self._ahead = []
        if not self._ahead:
            way, self._certainty = self.ground.sure_way(self.body, here[:2], self.goal)
            if isinstance(way, NoPath):
                return way
            self.ways += 1
            self._ahead = list(way.turns[1:])
        return self._turning_on_the_spot(here) if self.params.turning_radius_m is None else self._on_curves(here)

    def _turning_on_the_spot(self, here: Pose) -> Pose:
        to = self._ahead[0]
        away = math.dist(here[:2], to)
        heading = math.atan2(to[1] - here[1], to[0] - here[0]) if away > 0 else here[2]
        if abs(wrapped(heading - here[2])) > _BESIDE * self.params.scanner.field_rad:
            return here[0], here[1], heading  # it looks first where it goes
        if away <= self.params.step_m:
            self._ahead.pop(0)
            return float(to[0]), float(to[1]), heading
        share = self.params.step_m / away
        return here[0] + share * float(to[0] - here[0]), here[1] + share * float(to[1] - here[1]), heading

    def _on_curves(self, here: Pose) -> Pose | NoPath:
        """Step along the shortest Dubins path to the next turn that is clear; the way is planned anew at each turn."""
        radius_m = self.params.turning_radius_m
        assert radius_m is not None
        place = self._ahead[0]
        paths = [
            path
            for heading in _headings(here, place, self._ahead[1] if len(self._ahead) > 1 else None, radius_m)
            for path in words(here, (float(place[0]), float(place[1]), heading), radius_m)
        ]
        paths.sort(key=lambda path: path.length_m)
        seen, step_m = np.argwhere(self.ground.seen.occupied), self.params.step_m
        for certainty in PASSES:
            for path in paths:
                near = path.poses(step_m / 2)[:, :2]
                if self.ground.is_clear(self.body, _first(near, 4 * step_m), certainty, seen):
                    if path.length_m <= step_m:
                        self._ahead.pop(0)
                    return path.after(min(step_m, path.length_m))
        return NoPath("not found", f"no way on at {_shown(here)} with a turning radius of {radius_m:g} m")


def _headings(here: Pose, place: Floats, onward: Floats | None, radius_m: float) -> tuple[float, ...]:
    """Headings at a place: (2.13) for a turn to the left and to the right on to the next, straight on, and any."""
    straight = math.atan2(place[1] - here[1], place[0] - here[0])
    around = tuple(straight + k * math.pi / 4 for k in range(8))
    if onward is None:
        return around
    away = math.dist(place, onward)
    bearing = math.atan2(onward[1] - place[1], onward[0] - place[0])
    turn = math.asin(min(1.0, radius_m / away)) if away > 0 else 0.0
    return bearing - turn, bearing + turn, *around


def _first(places: Floats, length: float) -> Floats:
    """The first metres of a line of places (n, 2)."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    first: Floats = places[along <= length]
    return first


def _shown(pose: Pose) -> str:
    return f"({pose[0]:.2f}, {pose[1]:.2f})"
