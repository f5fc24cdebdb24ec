"""Areas that are covered, as survey items of QGroundControl.

A survey holds its own way points, which are flown as they are until somebody changes the survey: then the ground
station makes lanes of its own in the polygon, without holes. So the polygon is that of the part which one robot covers.
Source: QGroundControl developer guide, "Plan File Format", survey; version 5 with transects of version 2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from muster.execution.itinerary import Passage
from muster.mission.model import Action, Camera, Point, Robot, Task
from muster.motion.actions import Impossible
from muster.motion.actions.area_coverage import lanes_of, path_over, swath_of
from muster.motion.actions.footprint import Footprint, footprint_of
from muster.motion.areas.lanes import swaths
from muster_files.earth import Earth, anticlockwise
from muster_files.qgc import plan_format as qgc

Item = dict[str, Any]

_NO_CAMERA = "Manual (no camera specs)"
_FINE = 0.05
"""Of the width of a lane: corners of a part's polygon that lie nearer to the line past them are left out."""


def survey_item(
    task: Task, robot: Robot, items: Sequence[Item], passed: Sequence[Passage], height_m: float, earth: Earth
) -> Item:
    """The survey of a task over an area.

    Parameters
    ----------
    items, passed
        the way points of the task, and the passages that they stand for.
    height_m
        above home.
    """
    action = task.action
    assert action is not None
    swath = swath_of(action, robot)
    assert not isinstance(swath, Impossible)  # its way points are there
    every_m = picture_distance_m(action, robot)
    spots = earth.spots(passage.place for passage in passed)
    polygon = earth.spots(anticlockwise(_polygon(action, swath.width_m))[::-1])
    return {
        "TransectStyleComplexItem": {
            "CameraCalc": {
                "AdjustedFootprintFrontal": every_m or 0.0,
                "AdjustedFootprintSide": swath.width_m,
                "CameraName": _NO_CAMERA,
                "DistanceMode": qgc.RELATIVE_TO_HOME,
                "DistanceToSurface": height_m,
                "version": 2,
            },
            "CameraShots": _shots(passed, every_m),
            "CameraTriggerInTurnAround": True,
            "HoverAndCapture": False,
            "Items": [*_trigger(every_m), *items, *_trigger(0.0 if every_m else None)],
            "Refly90Degrees": False,
            "TurnAroundDistance": 0,
            "VisualTransectPoints": [[spot.lat, spot.lon] for spot in spots],
            "version": 2,
        },
        "angle": (90.0 - math.degrees(path_over(action, swath.width_m).heading)) % 360.0,
        "complexItemType": "survey",
        "entryLocation": 0,
        "flyAlternateTransects": False,
        "polygon": [[spot.lat, spot.lon] for spot in polygon],
        "splitConcavePolygons": False,
        "type": "ComplexItem",
        "version": 5,
    }


def picture_distance_m(action: Action, robot: Robot) -> float | None:
    """Metres from one picture to the next, by `front_overlap`; None where no pictures are taken."""
    front_m = _ahead_m(action, robot)
    return None if front_m is None or action.front_overlap is None else (1 - action.front_overlap) * front_m


def _ahead_m(action: Action, robot: Robot) -> float | None:
    """How far a picture reaches along a lane."""
    if action.width_m is not None or action.height_m is None:
        return None
    if action.fov_deg is not None:
        camera = robot.camera or Camera(fov_deg=action.fov_deg)
        wide = 2 * action.height_m * math.tan(math.radians(action.fov_deg) / 2)
        return wide * camera.height_px / camera.width_px
    if robot.camera is not None and isinstance(seen := footprint_of(robot.camera, action.height_m), Footprint):
        return 2 * (seen.middle_m - seen.near_m)
    return None


def _polygon(action: Action, width_m: float) -> tuple[Point, ...]:
    """The area, or about the part of it that is seen from the lanes of one part."""
    import shapely

    assert action.area is not None
    if action.part is None:
        return action.area
    part = shapely.intersection(
        shapely.Polygon(action.area), shapely.union_all(swaths(lanes_of(action, width_m), width_m))
    )
    largest = max(shapely.get_parts(part), key=lambda one: one.area)
    outline = shapely.simplify(shapely.Polygon(largest.exterior), _FINE * width_m)
    return tuple(outline.exterior.coords)[:-1]


def _trigger(every_m: float | None) -> list[Item]:
    """The item from which on a picture is taken every so many metres; 0 ends it."""
    if every_m is None:
        return []
    params = [every_m, 0, 1 if every_m else 0, 0, 0, 0, 0]
    item = {"autoContinue": True, "command": qgc.SET_TRIGGER_DISTANCE, "frame": qgc.FRAME_MISSION, "params": params}
    return [item | {"type": "SimpleItem"}]


def _shots(passed: Sequence[Passage], every_m: float | None) -> int:
    if every_m is None:
        return 0
    return math.ceil(sum(math.dist(a.place, b.place) for a, b in pairwise(passed)) / every_m)
