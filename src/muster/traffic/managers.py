"""Managers of traffic for missions, by name."""

from __future__ import annotations

from muster.mission.model import Mission, Robot
from muster.motion.map_world import Body, World
from muster.motion.robot_paths import RobotPaths
from muster.traffic.manager import TrafficManager
from muster.traffic.reserved import ReservedTraffic
from muster.traffic.roadmap import Roadmap
from muster.traffic.roadmap_plan import RoadmapPlan


def reserved(mission: Mission, seed: int = 0) -> TrafficManager:
    """Traffic by reservation, over the mission's map where it has one.

    Raises
    ------
    MissionError, MissingExtraError
        as `World.of`.
    """
    widest = Body(max((robot.radius_m for robot in robots_of(mission)), default=0.0), "ground")
    places = [robot.position[:2] for robot in robots_of(mission)] + [task.position[:2] for task in mission.tasks]
    if mission.map is None or mission.travel_rule != "map":
        return ReservedTraffic(RoadmapPlan(Roadmap.of(None, widest.radius_m, places), lambda _: True, seed))
    world = World.of(mission)
    paths = RobotPaths(world)
    roadmap = Roadmap.of(world.free_space(widest.radius_m, widest.kind, three_d=False), widest.radius_m, places)
    return ReservedTraffic(RoadmapPlan(roadmap, lambda points: paths.clear(widest, points), seed))


def robots_of(mission: Mission) -> list[Robot]:
    """The robots of a mission, and those that will join it."""
    return [*mission.robots, *(event.robot_joins for event in mission.events if event.robot_joins is not None)]
