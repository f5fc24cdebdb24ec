"""Managers of traffic for missions, by name."""

from __future__ import annotations

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.motion.map_world import Body, World
from muster.motion.robot_paths import RobotPaths
from muster.traffic.manager import TrafficManager
from muster.traffic.reserved import ReservedTraffic
from muster.traffic.roadmap import Roadmap
from muster.traffic.roadmap_plan import RoadmapPlan

FREE, RESERVE = TRAFFIC = ("free", "reserve")
"""Robots pass each other as they meet, or in the order of one plan for all."""


def manager_named(name: str, mission: Mission, seed: int = 0) -> TrafficManager | None:
    """The manager of a mission's traffic; None where robots pass each other as they meet.

    Raises
    ------
    ParameterError
        if there is none of that name.
    MissionError, MissingExtraError
        as `World.of`.
    """
    if name not in TRAFFIC:
        raise ParameterError(f"traffic: {shown(name)}; expected {', '.join(TRAFFIC)}{did_you_mean(str(name), TRAFFIC)}")
    return _reserved(mission, seed) if name == RESERVE else None


def _reserved(mission: Mission, seed: int) -> TrafficManager:
    """Traffic by reservation, over the mission's map where it has one."""
    widest = Body(max((robot.radius_m for robot in mission.all_robots), default=0.0), "ground")
    places = [robot.position[:2] for robot in mission.all_robots] + [task.position[:2] for task in mission.tasks]
    if mission.map is None or mission.travel_rule != "map":
        return ReservedTraffic(RoadmapPlan(Roadmap.of(None, widest.radius_m, places), lambda _: True, seed))
    world = World.of(mission)
    paths = RobotPaths(world)
    roadmap = Roadmap.of(world.free_space(widest.radius_m, widest.kind, three_d=False), widest.radius_m, places)
    return ReservedTraffic(RoadmapPlan(roadmap, lambda points: paths.clear(widest, points), seed))
