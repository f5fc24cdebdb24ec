"""Managers of traffic for missions, by name."""

from __future__ import annotations

from muster.mission.model import Mission
from muster.motion.map_world import World
from muster.traffic.closed_rings import can_close_out
from muster.traffic.manager import TrafficManager
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.names import AUTO, RESERVE, may_reserve
from muster.traffic.reserved import ReservedTraffic
from muster.traffic.roadmap import MARGIN_M


def manager_named(
    name: str, mission: Mission, seed: int = 0, *, world: World | None = None, margin_m: float = MARGIN_M
) -> TrafficManager | None:
    """The manager of a mission's traffic; None where robots pass each other as they meet.

    Parameters and errors are those of `shared_roadmap`. With `auto` traffic is by reservation also where robots at rest
    can close others out of their ends.
    """
    if name == AUTO and can_close_out(mission):
        name = RESERVE
    shared = shared_roadmap(name, mission, world=world, margin_m=margin_m)
    if shared is None:
        return None
    return ReservedTraffic(shared.plan(seed), margin_m=margin_m)


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
        as `may_reserve`.
    MissionError, MissingExtraError
        as `World.of`.
    """
    if not may_reserve(name, mission):
        return None
    mapped = mission.travel_rule == "map"
    if mapped and world is None:
        world = World.of(mission)
    shared = MissionRoadmap.of(mission, world if mapped else None, margin_m=margin_m)
    if name == AUTO and mission.lanes is None and not shared.roadmap.narrow.any():
        return None
    return shared
