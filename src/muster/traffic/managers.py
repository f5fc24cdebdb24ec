"""Managers of traffic for missions, by name."""

from __future__ import annotations

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.motion.map_world import World
from muster.traffic.manager import TrafficManager
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.names import AUTO, RESERVE, TRAFFIC
from muster.traffic.reserved import ReservedTraffic
from muster.traffic.roadmap import MARGIN_M
from muster.traffic.roadmap_plan import RoadmapPlan


def manager_named(
    name: str, mission: Mission, seed: int = 0, *, world: World | None = None, margin_m: float = MARGIN_M
) -> TrafficManager | None:
    """The manager of a mission's traffic; None where robots pass each other as they meet.

    Parameters and errors are those of `shared_roadmap`.
    """
    shared = shared_roadmap(name, mission, world=world, margin_m=margin_m)
    if shared is None:
        return None
    return ReservedTraffic(RoadmapPlan(shared.roadmap, shared.clear, seed), margin_m=margin_m)


def shared_roadmap(
    name: str, mission: Mission, *, world: World | None = None, margin_m: float = MARGIN_M
) -> MissionRoadmap | None:
    """The roadmap on which a mission's robots pass in turn; None where they pass each other as they meet.

    With `auto` traffic is by reservation where the mission gives lanes, or its map has passages for one robot.

    Parameters
    ----------
    world
        of the mission, where it is at hand.
    margin_m
        what robots keep between them beyond touching.

    Raises
    ------
    ParameterError
        if there is none of that name, or `reserve` is asked for where no two robots drive on one roadmap.
    MissionError, MissingExtraError
        as `World.of`.
    """
    if name not in TRAFFIC:
        raise ParameterError(f"traffic: {shown(name)}; expected {', '.join(TRAFFIC)}{did_you_mean(str(name), TRAFFIC)}")
    if name not in (AUTO, RESERVE):
        return None
    reason = _reason_against(mission)
    if reason and name == RESERVE:
        raise ParameterError(f"traffic: {name}; expected free: {reason}")
    if reason or (name == AUTO and mission.lanes is None and mission.travel_rule != "map"):
        return None
    mapped = mission.travel_rule == "map"
    if mapped and world is None:
        world = World.of(mission)
    shared = MissionRoadmap.of(mission, world if mapped else None, margin_m=margin_m)
    if name == AUTO and mission.lanes is None and not shared.roadmap.narrow.any():
        return None
    return shared


def _reason_against(mission: Mission) -> str:
    """Why robots of a mission cannot share a roadmap; empty where they can."""
    driving = [robot for robot in mission.all_robots if robot.kind == "ground" and robot.radius_m > 0]
    if len(driving) < 2:
        return "fewer than two robots of kind ground have a radius above 0"
    return ""
