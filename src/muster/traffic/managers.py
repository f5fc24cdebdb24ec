"""Managers of traffic for missions, by name, and whether the roadmap of a mission serves all of its robots."""

from __future__ import annotations

from collections.abc import Callable

from muster.mission.model import Mission
from muster.motion.map_world import World
from muster.traffic.blockages.closed_rings import can_close_out
from muster.traffic.journeys.roadmap_plan import Budget
from muster.traffic.manager import TrafficManager
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.names import AUTO, RESERVE, drives, may_reserve
from muster.traffic.reservation.planning import DelayedPlanning, ThreadedPlanning
from muster.traffic.reservation.reserved import AHEAD_M, AHEAD_S, ReservedTraffic
from muster.traffic.roadmaps.given_lanes import limited_lanes
from muster.traffic.roadmaps.roadmap import MARGIN_M

BUDGET, THREAD_BUDGET = Budget(expansions=1_000_000), Budget(seconds=0.5)
"""How long a plan is improved while robots go on by the plan before; and in a thread."""

IsFaster = Callable[[MissionRoadmap], bool]
"""Whether robots that have room to pass each other are faster by reservation on a roadmap."""


def _never(made: MissionRoadmap) -> bool:
    return False


def manager_named(
    name: str,
    mission: Mission,
    seed: int = 0,
    *,
    world: World | None = None,
    margin_m: float = MARGIN_M,
    real: bool = False,
    in_thread: bool = False,
    is_faster: IsFaster = _never,
) -> TrafficManager | None:
    """The manager of a mission's traffic; None where robots pass each other as they meet.

    Parameters and errors are those of `shared_roadmap`. With `auto` traffic is by reservation also where robots at rest
    can close others out of their ends, and where `is_faster` says so. `real` robots get as few orders as possible
    (`ReservedTraffic.sparing`). Traffic is planned `in_thread`, for a time; or planning takes a fixed time of the
    mission, and a number of expansions, so that a seed gives one run.
    """
    chosen = RESERVE if name == AUTO and can_close_out(mission) else name
    shared = _shared_roadmap(chosen, mission, world, margin_m, is_faster)
    if shared is None:
        return None
    lanes = [] if mission.driven_lanes is None else limited_lanes(mission.driven_lanes)
    fastest_mps = max(robot.speed_mps for robot in mission.all_robots if drives(robot))
    ahead_m = max(AHEAD_M, AHEAD_S * fastest_mps) if real else AHEAD_M
    return ReservedTraffic(
        shared.plan(seed, THREAD_BUDGET if in_thread else BUDGET),
        margin_m=margin_m,
        lanes=lanes,
        ahead_m=ahead_m,
        sparing=real,
        planning=ThreadedPlanning() if in_thread else DelayedPlanning(),
    )


def shared_roadmap(name: str, mission: Mission) -> MissionRoadmap | None:
    """The roadmap on which a mission's robots pass in turn; None where they pass each other as they meet.

    With `auto` traffic is by reservation where the mission gives lanes, or its map has passages for one robot.

    Raises
    ------
    ParameterError
        as `may_reserve`.
    MissionError, MissingExtraError
        as `World.of`.
    """
    return _shared_roadmap(name, mission, None, MARGIN_M, _never)


def _shared_roadmap(
    name: str, mission: Mission, world: World | None, margin_m: float, is_faster: IsFaster
) -> MissionRoadmap | None:
    if not may_reserve(name, mission):
        return None
    mapped = mission.has_ways_by_map
    if mapped and world is None:
        world = World.of_travel(mission)
    shared = MissionRoadmap.of(mission, world if mapped else None, margin_m=margin_m)
    if name != AUTO or mission.driven_lanes is not None:
        return shared
    return shared if shared.roadmap.narrow.any() or is_faster(shared) else None
