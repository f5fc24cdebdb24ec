"""QGroundControl plan files, one a robot: way points, fence and rally points.

Latitude comes first. Heights are metres above home, which is the robot's start. A robot without an end position
lands at the end of its route; one that returns to its start returns to launch.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import count, groupby
from typing import Any

from muster.execution.itinerary import Itinerary, Passage
from muster.mission.model import Mission, Point, Robot, Task
from muster_files.earth import Earth, Spot, anticlockwise
from muster_files.fence import Fence
from muster_files.qgc import plan_format as qgc
from muster_files.qgc.survey_writer import survey_item

Item = dict[str, Any]


@dataclass(frozen=True)
class PlanFiles:
    """What plan files of a mission have in common.

    Parameters
    ----------
    mission, earth
        the mission, and where it lies.
    team
        the itineraries of all robots; their starts are rally points of drones.
    firmware
        a key of `plan_format.FIRMWARE`. PX4 turns to the heading of a way point, ArduPilot by an item of its own.
    """

    mission: Mission
    earth: Earth
    team: Sequence[Itinerary]
    firmware: str

    def plan(self, itinerary: Itinerary) -> dict[str, Any]:
        """The plan file of one robot, as plain data for JSON."""
        home = self.earth.spot(itinerary.start.place)
        robot = itinerary.robot
        return {
            "fileType": "Plan",
            "geoFence": {"circles": [], "polygons": self._fence(itinerary), "version": 2},
            "groundStation": "QGroundControl",
            "mission": {
                "cruiseSpeed": robot.speed_mps,
                "firmwareType": qgc.FIRMWARE[self.firmware],
                "globalPlanAltitudeMode": qgc.RELATIVE_TO_HOME,
                "hoverSpeed": robot.speed_mps,
                "items": _numbered(self._items(itinerary, home)),
                "plannedHomePosition": [home.lat, home.lon, home.alt],
                "vehicleType": qgc.QUADROTOR if robot.kind == "air" else qgc.GROUND_ROVER,
                "version": 2,
            },
            "rallyPoints": {"points": self._rally_points(itinerary, home), "version": 2},
            "version": 1,
        }

    def _items(self, itinerary: Itinerary, home: Spot) -> Iterator[Item]:
        robot = itinerary.robot
        spots = self.earth.spots(passage.place for passage in itinerary.passages)
        passed = list(zip(itinerary.under_way, spots[1:], strict=False))
        if robot.kind == "air":
            yield _item(qgc.NAV_TAKEOFF, [0, 0, 0, None], home, _above(passed[0][1], home))
        yield _command(qgc.DO_CHANGE_SPEED, [qgc.GROUND_SPEED, robot.speed_mps, -1, 0])
        for name, group in groupby(passed, key=lambda pair: pair[0].task):
            yield from self._stop(self.tasks.get(name or ""), robot, list(group), home)
        yield from self._ending(itinerary, spots[-1], home)

    @cached_property
    def tasks(self) -> dict[str, Task]:
        """The tasks of the mission by id."""
        return {task.id: task for task in self.mission.tasks}

    def _stop(self, task: Task | None, robot: Robot, passed: list[tuple[Passage, Spot]], home: Spot) -> Iterator[Item]:
        """The way points of one task, or between tasks; those of a drone over an area as a survey."""
        items = [item for passage, spot in passed for item in self._way_point(passage, spot, home)]
        if robot.kind == "air" and task is not None and task.action is not None and task.action.area is not None:
            passages = [passage for passage, _ in passed]
            yield survey_item(task, robot, items, passages, _above(passed[0][1], home), self.earth)
        else:
            yield from items

    def _way_point(self, passage: Passage, spot: Spot, home: Spot) -> Iterator[Item]:
        yaw = None if passage.heading is None else _compass_deg(passage.heading)
        own = yaw if self.firmware == "px4" else None
        if yaw is not None and own is None:  # what stands after a way point is done when that is left
            yield _command(qgc.CONDITION_YAW, [yaw, 0, 0, 0])
        yield _item(qgc.NAV_WAYPOINT, [round(passage.stays_s, 3), 0, 0, own], spot, _above(spot, home))

    def _ending(self, itinerary: Itinerary, last: Spot, home: Spot) -> Iterator[Item]:
        robot = itinerary.robot
        if itinerary.has_end and robot.end_position is None:
            yield _command(qgc.NAV_RETURN_TO_LAUNCH, [0, 0, 0, 0])
        elif robot.kind == "air":
            ground = _above(last, home) if itinerary.has_end else 0.0
            yield _item(qgc.NAV_LAND, [0, 0, 0, None], last, ground)
        elif itinerary.has_end:
            yield _item(qgc.NAV_WAYPOINT, [0, 0, 0, None], last, _above(last, home))

    def _fence(self, itinerary: Itinerary) -> list[dict[str, Any]]:
        return [
            {"inclusion": inside, "polygon": self._clockwise(corners), "version": 1}
            for corners, inside in Fence.of(self.mission, itinerary).polygons
        ]

    def _clockwise(self, polygon: Sequence[Point]) -> list[list[float]]:
        return [[spot.lat, spot.lon] for spot in self.earth.spots(anticlockwise(polygon)[::-1])]

    def _rally_points(self, itinerary: Itinerary, home: Spot) -> list[list[float]]:
        """The starts of drones, at this drone's first height of flight; a rover has no rally points."""
        if itinerary.robot.kind != "air":
            return []
        starts = dict.fromkeys(other.start.place for other in self.team if other.robot.kind == "air")
        height = _above(self.earth.spot(itinerary.passages[1].place), home)
        return [[spot.lat, spot.lon, height] for spot in self.earth.spots(starts)]


def _numbered(items: Iterable[Item]) -> list[Item]:
    """The items with their numbers from 1; of a survey the items in it have them."""
    found, number = [], count(1)
    for item in items:
        if item["type"] == "SimpleItem":
            found.append(item | {"doJumpId": next(number)})
            continue
        inner = item["TransectStyleComplexItem"]
        own = [one | {"doJumpId": next(number)} for one in inner["Items"]]
        found.append(item | {"TransectStyleComplexItem": inner | {"Items": own}})
    return found


def _item(command: int, params: Sequence[float | None], spot: Spot, height_m: float) -> Item:
    """An item at a place, `height_m` above home."""
    return {
        "AMSLAltAboveTerrain": None,
        "Altitude": height_m,
        "AltitudeMode": qgc.RELATIVE_TO_HOME,
        "autoContinue": True,
        "command": command,
        "frame": qgc.FRAME_GLOBAL_RELATIVE_ALT,
        "params": [*params, spot.lat, spot.lon, height_m],
        "type": "SimpleItem",
    }


def _command(command: int, params: Sequence[float]) -> Item:
    """An item that has no place."""
    frame = qgc.FRAME_MISSION
    item = {"autoContinue": True, "command": command, "frame": frame, "params": [*params, 0, 0, 0]}
    return item | {"type": "SimpleItem"}


def _above(spot: Spot, home: Spot) -> float:
    return round(spot.alt - home.alt, 4) + 0.0


def _compass_deg(heading: float) -> float:
    """Radians from east, anticlockwise, as degrees from north, clockwise, in [0, 360)."""
    return round((90.0 - math.degrees(heading)) % 360.0, 6) % 360.0
