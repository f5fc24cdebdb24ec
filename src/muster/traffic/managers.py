"""Managers of traffic for missions, by name, and whether the roadmap of a mission serves all of its robots."""

from __future__ import annotations

from muster.mission.model import Mission, Robot
from muster.motion.map_world import World
from muster.motion.path import Path
from muster.motion.paths import PathFinder
from muster.traffic.blockages.closed_rings import can_close_out
from muster.traffic.blockages.impossible_crossings import Crossings
from muster.traffic.manager import TrafficManager
from muster.traffic.mission_roadmap import MissionRoadmap, task_motions
from muster.traffic.names import AUTO, RESERVE, may_reserve
from muster.traffic.reservation.reserved import ReservedTraffic
from muster.traffic.roadmaps.given_lanes import limited_lanes
from muster.traffic.roadmaps.roadmap import MARGIN_M


def manager_named(
    name: str, mission: Mission, seed: int = 0, *, world: World | None = None, margin_m: float = MARGIN_M
) -> TrafficManager | None:
    """The manager of a mission's traffic; None where robots pass each other as they meet.

    Parameters and errors are those of `shared_roadmap`. With `auto` traffic is by reservation also where robots at rest
    can close others out of their ends.
    """
    closes_out = name == AUTO and can_close_out(mission)
    shared = _shared_roadmap(name, mission, world, margin_m, even_if_wide=closes_out)
    if shared is None:
        return None
    lanes = [] if mission.driven_lanes is None else limited_lanes(mission.driven_lanes)
    return ReservedTraffic(shared.plan(seed), margin_m=margin_m, lanes=lanes)


def shared_roadmap(name: str, mission: Mission) -> MissionRoadmap | None:
    """The roadmap on which a mission's robots pass in turn; None where they pass each other as they meet.

    With `auto` traffic is by reservation where the mission gives lanes, or its map has passages for one robot. It is
    free where the roadmap, which is for the widest robot, would cut off a smaller one.

    Raises
    ------
    ParameterError
        as `may_reserve`.
    MissionError, MissingExtraError
        as `World.of`.
    """
    return _shared_roadmap(name, mission, None, MARGIN_M)


def _shared_roadmap(
    name: str, mission: Mission, world: World | None, margin_m: float, *, even_if_wide: bool = False
) -> MissionRoadmap | None:
    if not may_reserve(RESERVE if even_if_wide else name, mission):
        return None
    mapped = mission.has_ways_by_map
    if mapped and world is None:
        world = World.of_travel(mission)
    shared = MissionRoadmap.of(mission, world if mapped else None, margin_m=margin_m)
    if name != AUTO or mission.driven_lanes is not None:
        return shared
    passes_in_turn = even_if_wide or shared.roadmap.narrow.any()
    if not passes_in_turn or (mapped and world is not None and cuts_off(shared, mission, world)):
        return None
    return shared


def cuts_off(made: MissionRoadmap, mission: Mission, world: World) -> bool:
    """Whether a robot that is smaller than the widest has a path to a task or to its end, but no way on the roadmap."""
    smaller = [robot for robot in made.robots if robot.radius_m < made.roadmap.radius_m]
    starts = made.points(robot.position for robot in smaller)
    alone = Crossings(made.roadmap, starts, [robot.radius_m for robot in smaller])
    for robot, start in zip(smaller, starts, strict=True):
        missed = [goal for goal in _goals(mission, robot) if not alone.reaches(start, made.point_of[goal[:2]])]
        if not missed:
            continue
        finder = PathFinder(world.with_closed(()).free_space(robot.radius_m, robot.kind, three_d=False))
        if any(isinstance(finder.path(robot.position[:2], goal[:2]), Path) for goal in missed):
            return True
    return False


def _goals(mission: Mission, robot: Robot) -> list[tuple[float, ...]]:
    """Where it begins the tasks that it may do, and its end."""
    entries = [motion.entry for motion in task_motions(mission, [robot])]
    end = robot.place_at_end(mission.rules)
    return entries if end is None else [*entries, end]
