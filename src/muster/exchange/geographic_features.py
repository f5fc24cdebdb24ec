"""The features of a plan in geographic files: places, routes and areas on Earth, with their properties."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from muster.exchange.earth import Earth, Spot, anticlockwise
from muster.exchange.itinerary import Itinerary
from muster.mission.model import Mission
from muster.verification import Verdict

Properties = dict[str, Any]

AREAS = ("boundary", "zone")
"""The kinds of features that are areas."""


@dataclass(frozen=True)
class Feature:
    """A place (one point), a path (several points) or an area (corners, anticlockwise).

    `heights_m` has for each point its height in the map frame; None in a mission in the plane.
    """

    kind: str
    name: str
    spots: tuple[Spot, ...]
    heights_m: tuple[float, ...] | None
    properties: Properties


@dataclass(frozen=True)
class Survey:
    """The starts of robots, the tasks, the paths of robots with tasks, and the boundary and zones of the map."""

    mission: str
    robots: tuple[Feature, ...]
    tasks: tuple[Feature, ...]
    routes: tuple[Feature, ...]
    areas: tuple[Feature, ...]

    @property
    def features(self) -> tuple[Feature, ...]:
        return (*self.areas, *self.routes, *self.tasks, *self.robots)


def survey(mission: Mission, verdict: Verdict, team: Sequence[Itinerary], earth: Earth) -> Survey:
    """The features of a plan."""
    spatial = mission.dimensions == 3

    def feature(kind: str, name: str, points: Sequence[tuple[float, ...]], properties: Properties) -> Feature:
        heights = tuple((*point, 0.0)[2] for point in points) if spatial else None
        return Feature(kind, name, tuple(earth.spots(points)), heights, {"kind": kind, "name": name} | properties)

    visits = _visits(verdict)
    figures = {route.robot: route for route in verdict.routes}
    return Survey(
        mission=mission.name,
        robots=tuple(
            feature("robot", r.id, [r.position], {"type": r.type, "moves": r.kind, "speed_mps": r.speed_mps})
            for r in mission.robots
        ),
        tasks=tuple(
            feature("task", t.id, [t.position], {"type": t.type} | visits.get(t.id, {"robot": None}))
            for t in mission.tasks
        ),
        routes=tuple(
            feature(
                "route",
                i.robot.id,
                [passage.place for passage in i.passages],
                {
                    "robot": i.robot.id,
                    "tasks": list(figures[i.robot.id].tasks),
                    f"usage_{verdict.usage_unit}": figures[i.robot.id].usage,
                    "ends_s": i.passages[-1].leaves_s,
                },
            )
            for i in team
            if len(i.passages) > 1
        ),
        areas=tuple(feature(kind, name, corners, own) for kind, name, corners, own in _areas(mission)),
    )


def _visits(verdict: Verdict) -> dict[str, Properties]:
    """For each task in the plan, who does it and when."""
    return {
        visit.task: {
            "robot": route.robot,
            "order": order,
            "arrives_s": visit.arrives_s,
            "starts_s": visit.starts_s,
            "ends_s": visit.ends_s,
        }
        for route in verdict.routes
        for order, visit in enumerate(route.visits, 1)
    }


def _areas(mission: Mission) -> list[tuple[str, str, list[tuple[float, ...]], Properties]]:
    area = mission.map
    if area is None:
        return []
    bounds = [] if area.boundary is None else [("boundary", "boundary", anticlockwise(area.boundary), Properties())]
    return bounds + [
        (
            "zone",
            f"zone {k}",
            anticlockwise(zone.polygon),
            {"forbidden_to": list(zone.forbidden_to), "floor_m": zone.floor_m, "ceiling_m": zone.ceiling_m},
        )
        for k, zone in enumerate(area.zones)
    ]
