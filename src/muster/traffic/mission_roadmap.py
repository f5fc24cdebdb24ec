"""The roadmap of a mission: for its robots that drive, from its lanes, its map or the open area around its places."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Point, Robot
from muster.motion.actions import TaskMotion, plan
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Floats
from muster.motion.map_world import World, body_of
from muster.motion.paths import PathFinder
from muster.motion.paths.lane_joints import ClosedLane
from muster.traffic.journeys.roadmap_plan import RoadmapPlan
from muster.traffic.roadmaps.doors import NO_DOORS, RoadmapDoors
from muster.traffic.roadmaps.given_lanes import closed_lanes
from muster.traffic.roadmaps.roadmap import MARGIN_M, Roadmap


@dataclass(frozen=True, eq=False)
class MissionRoadmap:
    """A roadmap, and where on it a mission's robots and tasks are.

    Parameters
    ----------
    roadmap
        for the widest of the robots.
    robots
        those that share it: the robots of kind `ground`, or all where none is.
    point_of
        for each place of these robots and their tasks, (x, y) metres in the map frame, the number of its point; -1
        where no way leads there.
    closed
        the lanes of the mission that the widest robot cannot drive.
    doors
        of the mission; the roadmap is that with all of them open.
    finder
        of paths for the widest robot; None where there is no map.
    """

    roadmap: Roadmap
    robots: tuple[Robot, ...]
    point_of: Mapping[Point, int]
    closed: tuple[ClosedLane, ...] = ()
    doors: RoadmapDoors = NO_DOORS
    finder: PathFinder | None = None

    @classmethod
    def of(cls, mission: Mission, world: World | None = None, *, margin_m: float = MARGIN_M) -> MissionRoadmap:
        """The roadmap of a mission; its world is made where it is not given.

        Raises
        ------
        ParameterError
            if no robot that drives has a radius above 0.
        MissionError, MissingExtraError
            as `World.of`.
        """
        robots = tuple(robot for robot in mission.robots if robot.kind == "ground") or mission.robots
        sharing = (*robots, *(robot for robot in mission.newcomers if robot.kind == robots[0].kind))
        widest = max(sharing, key=lambda robot: robot.radius_m)
        if widest.radius_m <= 0:
            raise ParameterError(
                "radius_m: 0 for all robots; expected a robot with a radius above 0: others share any lane"
            )
        places = list(dict.fromkeys(place[:2] for place in _places(mission, sharing)))
        space = None
        if mission.map is not None and mission.has_ways_by_map:
            world = world or World.of_travel(mission)
            space = world.with_closed(()).free_space(widest.radius_m, widest.kind, three_d=False)
            assert isinstance(space, GridSpace | PolygonSpace)
        finder = None if space is None else PathFinder(space)
        closed: list[ClosedLane] = []
        if mission.driven_lanes is None:
            roadmap = Roadmap.of(space, widest.radius_m, places, margin_m=margin_m)
        else:
            roadmap = Roadmap.of_lanes(mission.driven_lanes, widest.radius_m, places, space=space, margin_m=margin_m)
            closed = closed_lanes(mission.driven_lanes, widest.radius_m, finder)
        doors = RoadmapDoors.of(mission, body_of(widest), world if space is not None else None)
        point_of = dict(zip(places, roadmap.places.tolist(), strict=True))
        return cls(roadmap, robots, point_of, tuple(closed), doors, finder)

    def plan(self, seed: int = 0) -> RoadmapPlan:
        """What plans moves of robots on it."""
        return RoadmapPlan(self.roadmap, self.clear, seed, self.doors)

    def clear(self, points: Floats) -> bool:
        """Whether the straight way along points, (n, 2) metres, is free for the widest robot."""
        return self.finder is None or self.finder.clear(points)

    def points(self, places: Iterator[Point] | list[Point]) -> list[int]:
        """The points of places of the mission."""
        return [self.point_of[place[:2]] for place in places]


def _places(mission: Mission, robots: tuple[Robot, ...]) -> Iterator[Point]:
    """Where robots start and end, and where they begin and end their tasks."""
    for robot in robots:
        yield robot.position
        if robot.end_position is not None:
            yield robot.end_position
    for motion in task_motions(mission, robots):
        yield motion.entry
        yield motion.exit


def task_motions(mission: Mission, robots: Sequence[Robot]) -> Iterator[TaskMotion]:
    """How each task is done by each of these robots that may do it and can."""
    for task in mission.tasks:
        for robot in robots:
            if task.is_open_to(robot.id):
                motion = plan(task, robot)
                if isinstance(motion, TaskMotion):
                    yield motion
