"""A robot with a laser among obstacles that no map shows: a bug algorithm with Dubins paths ([tcf-thesis], 2.2.1).

The robot scans and finds the obstacles of the scan (median, clusters, shapes). Where one is in its way to the goal, it
goes to the left or the right edge of that obstacle, inflated by a safe distance (Figure 2.1), on the side that promises
the shorter way, and keeps to that side until the goal is in sight and nearer than when it chose. It drives the shortest
Dubins path to that intermediate pose (Figure 2.2) that is clear of what it sees, a step of it, and scans again.

(2.12) and (2.14) place the pose so that the obstacle's outermost point is passed at the safe distance; `Obstacle.edges`
is that place. The heading there is (2.13). It is printed for one side; for the other the arcsine is added.
A robot without memory is not always led to the goal, though there is a path: then it ends after a length.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive
from muster.motion.map_world import Body, World
from muster.motion.path import NoPath, Path
from muster.motion.paths.dubins_words import Pose, words
from muster.perception.laser import NO_DISCS, Scanner, faces_at
from muster.perception.obstacles import Detection, Obstacle, obstacles
from muster.simulation.walls import faces_and_slabs

_LASER_M = 0.1
"""Height of the laser of a robot on the ground."""
_LOOKED_AT = 8
"""Obstacles between the robot and an edge that may give way to the next, at most."""


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """How the robot goes.

    Parameters
    ----------
    scanner, detection
        its laser, and the rules by which obstacles are found.
    turning_radius_m, safe_m
        r_turn and r_safe; the latter from the robot's centre.
    step_m
        that it drives between two scans.
    arrival_m
        from the goal.
    patience
        how many times the straight distance, and as many metres, it drives at most.
    """

    scanner: Scanner = field(default_factory=lambda: Scanner(step_rad=math.radians(1.0)))
    detection: Detection = field(default_factory=lambda: Detection(gap_m=0.2))
    turning_radius_m: float = 0.1
    safe_m: float = 0.3
    step_m: float = 0.1
    arrival_m: float = 0.05
    patience: float = 5.0

    def __post_init__(self) -> None:
        require_finite_positive(turning_radius_m=self.turning_radius_m, safe_m=self.safe_m, step_m=self.step_m)
        require_finite_positive(arrival_m=self.arrival_m, patience=self.patience)


@dataclass(frozen=True, eq=False)
class Drive:
    """What the robot drove.

    Parameters
    ----------
    poses
        (k, 3): x, y in metres of the map frame, heading.
    edges
        (m, 2): the edges that it went to, in the order of the scans.
    scans
        how many it took.
    """

    poses: Floats
    edges: Floats
    scans: int

    @property
    def path(self) -> Path:
        return Path(self.poses[:, :2])


def walls_of(world: World, body: Body) -> Floats:
    """The walls (k, 4) of a map that the laser of a body sees."""
    return faces_at(faces_and_slabs(world, body)[0], _LASER_M)


def drive(
    walls: Floats, start: Pose, goal: tuple[float, float], params: Parameters, *, seed: int = 0
) -> Drive | NoPath:
    """Go from a pose to a place among walls (k, 4) that only the laser sees: both ends' x and y, metres."""
    random = np.random.default_rng(seed)
    poses, edges = [start], []
    most = params.patience * (math.dist(start[:2], goal) + 1)
    driven, scans, course = 0.0, 0, _Course()
    while math.dist(poses[-1][:2], goal) > params.arrival_m:
        if driven > most:
            return NoPath(
                "not found", f"after {driven:.1f} m at {_shown(poses[-1])}: what is seen at once does not suffice"
            )
        here = poses[-1]
        ranges = params.scanner.measured(params.scanner.ranges(here, walls, NO_DISCS), random)
        seen = obstacles(ranges, params.scanner.bearings, params.detection)
        scans += 1
        aim, edge = course.aim(here, goal, seen, params)
        if edge:
            edges.append(aim[0])
        step = _step(here, aim, np.concatenate([np.empty((0, 2)), *(one.points for one in seen)]), params)
        if step is None:
            return NoPath(
                "not found", f"no way on at {_shown(here)} with a turning radius of {params.turning_radius_m:g} m"
            )
        driven += max(math.dist(here[:2], step[:2]), params.step_m)  # at an edge that hides another it stands
        poses.append(step)
    return Drive(np.array(poses), np.array(edges).reshape(-1, 2), scans)


Aim = tuple[tuple[float, float], tuple[float, ...]]
"""A place in the map frame, and headings there that are tried."""


@dataclass
class _Course:
    """On which side the robot goes around, and how far the goal was when it chose."""

    side: int | None = None
    hit_m: float = math.inf

    def aim(
        self, here: Pose, goal: tuple[float, float], seen: tuple[Obstacle, ...], params: Parameters
    ) -> tuple[Aim, bool]:
        """Where to go: the goal, or the edge of what is in the way; and whether it is an edge."""
        target = _in_robot_frame(here, goal)
        first = _blocking(seen, target, params.safe_m)
        away = math.hypot(*target)
        if first is None:
            if away < self.hit_m:
                self.side, self.hit_m = None, math.inf
            return (goal, _headings(here, goal, goal, params.turning_radius_m)), False
        if self.side is None:
            ways = [math.hypot(*edge) + math.dist(edge, target) for edge in first.edges(params.safe_m)]
            self.side, self.hit_m = int(np.argmin(ways)), away
        edge = self._edge(first, seen, params.safe_m)
        place = _in_map_frame(here, edge)
        return (place, _headings(here, place, goal, params.turning_radius_m)), True

    def _edge(self, obstacle: Obstacle, seen: tuple[Obstacle, ...], safe_m: float) -> tuple[float, float]:
        """The edge on the chosen side of the obstacle, or of the one that is in the way to that."""
        assert self.side is not None
        edge = obstacle.edges(safe_m)[self.side]
        for _ in range(_LOOKED_AT):
            other = _blocking(tuple(one for one in seen if one is not obstacle), edge, 0.99 * safe_m)
            if other is None:
                return edge
            obstacle, edge = other, other.edges(safe_m)[self.side]
        return edge


def _blocking(seen: tuple[Obstacle, ...], target: tuple[float, float], safe_m: float) -> Obstacle | None:
    """Of obstacles nearer than the safe distance to the line to a target, robot frame, the one that is met first."""
    length = math.hypot(*target)
    ahead = np.array(target) / max(length, 1e-9)
    found, first = None, math.inf
    for obstacle in seen:
        along, across = obstacle.points @ ahead, obstacle.points @ np.array([-ahead[1], ahead[0]])
        in_way = (along > 0) & (along < length) & (np.abs(across) < safe_m * (1 - 1e-6))
        if in_way.any() and along[in_way].min() < first:
            found, first = obstacle, float(along[in_way].min())
    return found


def _headings(here: Pose, place: tuple[float, float], goal: tuple[float, float], radius_m: float) -> tuple[float, ...]:
    """Headings at a place: (2.13) for a turn to the left and to the right, and straight on."""
    straight = math.atan2(place[1] - here[1], place[0] - here[0])
    away = math.dist(place, goal)
    if away == 0:
        return (straight, *(straight + k * math.pi / 4 for k in range(1, 8)))
    bearing, turn = math.atan2(goal[1] - place[1], goal[0] - place[0]), math.asin(min(1.0, radius_m / away))
    return straight, bearing - turn, bearing + turn


def _step(here: Pose, aim: Aim, seen: Floats, params: Parameters) -> Pose | None:
    """The pose after a step of the shortest Dubins path to the aim that is clear of what is seen; None without one."""
    (x, y), headings = aim
    paths = [path for heading in headings for path in words(here, (x, y, heading), params.turning_radius_m)]
    points = np.array([_in_map_frame(here, (float(a), float(b))) for a, b in seen]).reshape(-1, 2)
    nearest = np.linalg.norm(points - here[:2], axis=1).min(initial=math.inf)
    margin = 0.9 * min(params.safe_m, nearest)
    for path in sorted(paths, key=lambda path: path.length_m):
        poses = path.poses(params.step_m / 2)
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(poses[:, :2], axis=0), axis=1))])
        near = _dense(poses[:, :2], along, 4 * params.step_m, params.step_m / 2)
        if not len(points) or np.linalg.norm(near[:, None] - points, axis=2).min() >= margin:
            return path.after(min(params.step_m, path.length_m))
    return None


def _dense(places: Floats, along: Floats, length: float, step: float) -> Floats:
    """Places (n, 2) along the first metres of a line."""
    at = np.arange(0.0, min(length, along[-1]) + step, step)
    return np.column_stack([np.interp(at, along, axis) for axis in places.T])


def _in_robot_frame(here: Pose, place: tuple[float, float]) -> tuple[float, float]:
    east, north = place[0] - here[0], place[1] - here[1]
    c, s = math.cos(here[2]), math.sin(here[2])
    return c * east + s * north, c * north - s * east


def _in_map_frame(here: Pose, place: tuple[float, float]) -> tuple[float, float]:
    c, s = math.cos(here[2]), math.sin(here[2])
    return here[0] + c * place[0] - s * place[1], here[1] + s * place[0] + c * place[1]


def _shown(pose: Pose) -> str:
    return f"({pose[0]:.2f}, {pose[1]:.2f})"
