"""Cover an area with holes in lanes: with a camera, or with a tool.

The distance of lanes follows from what is seen: w_s of [tcf-thesis] (4.31) for the robot's camera, the width of the
picture of a camera that looks straight down with `fov_deg`, or the width of the tool. The lanes, their order and the
ways between them are those of `motion.areas`; the middle of the picture, or of the tool, goes along them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from muster.mission.action_keys import COVERAGE, ActionKeys
from muster.mission.model import Action, Point, Robot, Task
from muster.mission.values.arrays import Floats
from muster.motion.actions.action import Impossible, TaskMotion, along, raised
from muster.motion.actions.footprint import Footprint, footprint_of
from muster.motion.actions.raster_search import OVERLAP
from muster.motion.areas.coverage_path import MOST_LANES, CoveragePath, TooManyLanesError, coverage_path
from muster.motion.areas.region import Ring
from muster.motion.areas.split import parts_of
from muster.motion.maps.optional_parts import require_map_extra

_KEPT = 256
_SAME_M = 1e-9


@dataclass(frozen=True)
class Swath:
    """What is seen across a lane, metres; how far ahead of the body, and to its left, the middle of it is."""

    width_m: float
    ahead_m: float = 0.0
    left_m: float = 0.0


@dataclass(frozen=True)
class AreaCoverage:
    """Enters at the beginning of the first lane, leaves from the end of the last one."""

    name: str = "coverage"
    keys: ActionKeys = COVERAGE

    def plan(self, task: Task, robot: Robot) -> TaskMotion | Impossible:
        require_map_extra("an area")
        assert task.action is not None
        action, height = task.action, task.action.height_m or 0.0
        if robot.kind == "ground" and len(task.position) == 3 and height:
            return Impossible(f"a ground robot cannot cover an area from {height:g} m above the ground")
        swath = swath_of(action, robot)
        if isinstance(swath, Impossible):
            return swath
        try:
            path = path_over(action, swath.width_m)
        except TooManyLanesError as error:
            return Impossible(f"it would need {error.count:.3g} lanes; expected at most {MOST_LANES}: wider ones")
        lanes = lanes_of(action, swath.width_m)
        if not len(lanes):
            return Impossible(f"nothing is left for part {action.part}")
        passed = list(_passed(path, lanes, swath))
        if blocked := _blocked(action, swath, [place for place, _ in passed]):
            return Impossible(blocked)
        _, _, z = raised(task.position, height)
        return along(task, robot, [(*place, z) for place, _ in passed], [heading for _, heading in passed])


def swath_of(action: Action, robot: Robot) -> Swath | Impossible:
    """What a robot sees, or does, across a lane of an area, less what neighbouring lanes share."""
    if action.width_m is not None:
        return Swath((1 - (action.overlap or 0.0)) * action.width_m)
    share = 1 - (OVERLAP if action.overlap is None else action.overlap)
    assert action.height_m is not None  # Action.cross_check
    if action.fov_deg is not None:
        return Swath(share * 2 * action.height_m * math.tan(math.radians(action.fov_deg) / 2))
    if robot.camera is None:
        return Impossible("it has no camera from which the distance of lanes follows; expected one, fov_deg or width_m")
    seen = footprint_of(robot.camera, action.height_m)
    if isinstance(seen, Impossible):
        return seen
    assert isinstance(seen, Footprint)
    return Swath(share * seen.width_m, _none(seen.middle_m), _none(seen.left_m))


def path_over(action: Action, width_m: float) -> CoveragePath:
    """The way that covers the whole area of an action, in lanes so far apart.

    Raises
    ------
    TooManyLanesError
        if there would be more than `MOST_LANES`.
    """
    heading = None if action.heading_deg is None else math.radians(action.heading_deg)
    assert action.area is not None
    return coverage_path(action.area, action.holes, width_m, heading, cross_holes=action.cross_holes)


def lanes_of(action: Action, width_m: float) -> Floats:
    """(n, 2, 2) the lanes of an action that is a whole area, or of its part of one."""
    if action.part is None or action.split is None:
        return path_over(action, width_m).lanes
    whole = (action.area, action.holes, width_m, action.heading_deg, action.cross_holes)
    return _parts(*whole, action.split)[action.part - 1]


@lru_cache(maxsize=_KEPT)
def _parts(
    area: Ring, holes: tuple[Ring, ...], width_m: float, heading_deg: float | None, cross_holes: bool, split: int
) -> list[Floats]:
    heading = None if heading_deg is None else math.radians(heading_deg)
    return parts_of(coverage_path(area, holes, width_m, heading, cross_holes=cross_holes), split)


def _passed(path: CoveragePath, lanes: Floats, swath: Swath) -> Iterator[tuple[Point, float | None]]:
    """The places that the body passes, and its headings there; at bends between lanes as it arrives.

    Where one lane begins at the end of another the place comes twice: an autopilot may turn to the heading of a way
    point on the way to it, and has to keep that of its lane.
    """
    ways = lanes[:, 1] - lanes[:, 0]
    headings = np.arctan2(ways[:, 1], ways[:, 0])
    ahead = np.column_stack([np.cos(headings), np.sin(headings)])
    left = np.column_stack([-ahead[:, 1], ahead[:, 0]])
    bodies = lanes - (swath.ahead_m * ahead + swath.left_m * left)[:, None]
    for k, (begin, end) in enumerate(bodies):
        if k:
            before = bodies[k - 1, 1]
            yield from ((_point(bend), None) for bend in path.bends(before, begin))
        yield _point(begin), float(headings[k])
        yield _point(end), float(headings[k])


def _blocked(action: Action, swath: Swath, places: list[Point]) -> str | None:
    """Why the body cannot pass these places, its picture being elsewhere: they lead over a hole."""
    if action.cross_holes or not action.holes or not (swath.ahead_m or swath.left_m):
        return None
    import shapely

    way = shapely.LineString(places)
    for k, hole in enumerate(action.holes):
        if way.relate_pattern(shapely.Polygon(hole), "T********"):
            told = "expected a camera that looks straight down from the middle, or cross_holes: true"
            return f"its camera looks aside, so that it would fly over holes[{k}]; {told}"
    return None


def _point(place: Floats) -> Point:
    return float(place[0]), float(place[1])


def _none(metres: float) -> float:
    """The length, or 0 where it is rounding of a camera that looks straight down."""
    return 0.0 if abs(metres) <= _SAME_M else metres
