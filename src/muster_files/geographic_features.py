"""The features of a plan in geographic files: places, routes and areas on Earth, with their properties."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from muster.execution.itinerary import Itinerary
from muster.mission.action_keys import ACTION_KEYS
from muster.mission.areas.task_areas import whole_id
from muster.mission.model import Mission, Robot, Task
from muster.verification import RouteFigures, Verdict
from muster_files.earth import Earth, Spot, anticlockwise
from muster_files.task_times import asked, clock, station_properties, stops_of, task_properties, utc

Properties = dict[str, Any]

AREAS = ("boundary", "zone", "area", "hole")
"""The kinds of features that are areas."""


@dataclass(frozen=True)
class Feature:
    """A place (one point), a path (several points) or an area (corners, anticlockwise).

    `heights_m` has for each point its height in the map frame; None in a mission in the plane. `times` has for each
    point of a route when the robot arrives, for its start when it leaves, and at last when the route ends; for a task
    when work starts and ends. There is none where the mission does not start at a time in a zone.
    """

    kind: str
    name: str
    spots: tuple[Spot, ...]
    heights_m: tuple[float, ...] | None
    properties: Properties
    times: tuple[datetime, ...] = ()


@dataclass(frozen=True)
class PlanFeatures:
    """The starts of robots, tasks, stations, the paths of robots with stops, and the map's boundary and zones."""

    mission: str
    robots: tuple[Feature, ...]
    tasks: tuple[Feature, ...]
    routes: tuple[Feature, ...]
    areas: tuple[Feature, ...]
    stations: tuple[Feature, ...] = ()

    @property
    def features(self) -> tuple[Feature, ...]:
        return (*self.areas, *self.routes, *self.stations, *self.tasks, *self.robots)


def features_of(
    mission: Mission,
    verdict: Verdict,
    team: Sequence[Itinerary],
    earth: Earth,
    *,
    layered: Mapping[str, float] | None = None,
) -> PlanFeatures:
    """The features of a plan; routes of drones that are `layered`, by robot, have heights in a plane mission, too."""
    spatial, layered = mission.dimensions == 3, layered or {}

    def feature(
        kind: str, name: str, points: Sequence[tuple[float, ...]], own: Properties, times_s: Sequence[float] = ()
    ) -> Feature:
        has_heights = spatial or (kind == "route" and name in layered)
        heights = tuple((*point, 0.0)[2] for point in points) if has_heights else None
        times = tuple(moment for seconds in times_s if (moment := utc(mission, seconds)) is not None)
        return Feature(kind, name, tuple(earth.spots(points)), heights, {"kind": kind, "name": name} | own, times)

    stops = stops_of(verdict)
    figures = {route.robot: route for route in verdict.routes}
    return PlanFeatures(
        mission=mission.name,
        robots=tuple(feature("robot", r.id, [r.position], _robot_properties(r)) for r in mission.robots),
        tasks=tuple(
            feature(
                "task",
                t.id,
                [t.position],
                {"type": t.type} | task_properties(mission, t, stops.get(t.id, ())),
                [time for stop in stops.get(t.id, ())[:1] for time in (stop.visit.starts_s, stop.visit.ends_s)],
            )
            for t in mission.tasks
        ),
        stations=tuple(
            feature("station", s.id, [s.position], station_properties(s, stops.get(s.id, ()))) for s in mission.stations
        ),
        routes=tuple(
            feature(
                "route",
                i.robot.id,
                [passage.place for passage in i.passages],
                _route_properties(mission, i, figures[i.robot.id], verdict.usage_unit)
                | ({"altitude_m": layered[i.robot.id]} if i.robot.id in layered else {}),
                _times_s(i),
            )
            for i in team
            if len(i.passages) > 1
        ),
        areas=tuple(feature(kind, name, corners, own) for kind, name, corners, own in _areas(mission)),
    )


def _robot_properties(robot: Robot) -> Properties:
    skills = {"skills": list(robot.skills)} if robot.skills else {}
    return {"type": robot.type, "moves": robot.kind, "speed_mps": robot.speed_mps} | skills


def _times_s(itinerary: Itinerary) -> list[float]:
    """When the robot leaves its start, arrives at each further point, and leaves the last one."""
    start, *others = itinerary.passages
    return [start.leaves_s, *(passage.arrives_s for passage in others), itinerary.passages[-1].leaves_s]


def _route_properties(mission: Mission, itinerary: Itinerary, figures: RouteFigures, unit: str) -> Properties:
    leaves_s, ends_s = figures.leaves_s, itinerary.passages[-1].leaves_s
    own = {"robot": figures.robot, "tasks": list(figures.tasks), f"usage_{unit}": figures.usage, "ends_s": ends_s}
    if any(stop.is_station for stop in figures.stops):
        own |= {"stops": list(figures.order), f"charged_{unit}": figures.charged}
    times = {"starts_at": clock(mission, leaves_s), "ends_at": clock(mission, ends_s)}
    return own | {name: value for name, value in times.items() if value is not None}


def _areas(mission: Mission) -> list[tuple[str, str, list[tuple[float, ...]], Properties]]:
    fields = []
    for name, task in _tasks_over_areas(mission).items():
        assert task.action is not None
        assert task.action.area is not None
        fields.append(("area", name, anticlockwise(task.action.area), _survey_properties(task)))
        fields += [
            ("hole", f"hole {n} of {name}", anticlockwise(hole), Properties({"of": name}))
            for n, hole in enumerate(task.action.holes)
        ]
    return [*_map_areas(mission), *fields]


def _tasks_over_areas(mission: Mission) -> dict[str, Task]:
    """By the name of each area a task that covers it; those that cover its parts are one."""
    found: dict[str, Task] = {}
    for task in mission.tasks:
        if task.action is not None and task.action.area is not None:
            found.setdefault(whole_id(task), task)
    return found


def _survey_properties(task: Task) -> Properties:
    """What an area asks for, as a mission file has it; with it the area can be read again as one to survey."""
    assert task.action is not None
    keys = [key for key in ACTION_KEYS[task.action.name].names if key not in ("area", "holes", "part")]
    given = {key: value for key in keys if (value := task.action.value(key)) not in (None, False)}
    own: Properties = {"action": task.action.name, "type": task.type}
    return own | given | asked(task)


def _map_areas(mission: Mission) -> list[tuple[str, str, list[tuple[float, ...]], Properties]]:
    area = mission.map
    if area is None:
        return []
    bounds = [] if area.boundary is None else [("boundary", "boundary", anticlockwise(area.boundary), Properties())]
    return bounds + [
        (
            "zone",
            f"zone {k}",
            anticlockwise(zone.polygon),
            {"forbidden_to": list(zone.closed_to), "floor_m": zone.floor_m, "ceiling_m": zone.ceiling_m},
        )
        for k, zone in enumerate(area.zones)
    ]
