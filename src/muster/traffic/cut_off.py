"""Whether the roadmap for the widest robot keeps a smaller one from a place to which it would get by itself."""

from __future__ import annotations

from muster.mission.model import Mission, Robot
from muster.motion.map_world import World
from muster.motion.path import Path
from muster.motion.paths import PathFinder
from muster.traffic.impossible_crossings import Crossings
from muster.traffic.mission_roadmap import MissionRoadmap, task_motions


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
