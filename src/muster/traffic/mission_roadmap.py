"""The roadmap of a mission: for its robots that drive, from its lanes, its map or the open area around its places."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from muster.mission.model import Mission, Point, Robot
from muster.motion.actions import TaskMotion, plan
from muster.motion.map_world import World
from muster.traffic.journeys.roadmap_plan import RoadmapPlan
from muster.traffic.roadmaps.doors import NO_DOORS, RoadmapDoors
from muster.traffic.roadmaps.given_lanes import ClosedLane, closed_lanes
from muster.traffic.roadmaps.roadmap import MARGIN_M, Layer, Roadmap, layer_of_lanes, layer_of_space
from muster.traffic.roadmaps.robot_sizes import same_ways, sizes
from muster.traffic.roadmaps.robot_spaces import RobotSpaces, require_radius


@dataclass(frozen=True, eq=False)
class MissionRoadmap:
    """A roadmap, and where on it a mission's robots and tasks are.

    Parameters
    ----------
    roadmap
        with a layer for each size of the robots.
    robots
        those that share it: the robots of kind `ground`, or all where none is, that have a radius.
    point_of
        for each layer and place of its robots and their tasks, (x, y) metres in the map frame, the number of its
        point; -1 where no way leads there.
    closed
        for each layer the lanes of the mission that its widest robot cannot drive.
    spaces
        the free space of each robot.
    doors
        of the mission; the roadmap is that with all of them open.
    """

    roadmap: Roadmap
    robots: tuple[Robot, ...]
    point_of: tuple[Mapping[Point, int], ...]
    closed: tuple[tuple[ClosedLane, ...], ...]
    spaces: RobotSpaces
    doors: RoadmapDoors = NO_DOORS

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
        kind = robots[0].kind
        sharing = (*robots, *(robot for robot in mission.newcomers if robot.kind == kind))
        require_radius([robot.radius_m for robot in sharing])
        mapped = mission.map is not None and mission.has_ways_by_map
        spaces = RobotSpaces((world or World.of_travel(mission)) if mapped else None, kind)
        layers, places, closed = list[Layer](), list[list[Point]](), list[tuple[ClosedLane, ...]]()
        before_m = 0.0
        for radius_m in _sizes(mission, spaces, sharing):
            own = [robot for robot in sharing if before_m < robot.radius_m <= radius_m]
            places.append(list(dict.fromkeys(place[:2] for place in _places(mission, own))))
            before_m, space = radius_m, spaces.space(radius_m)
            if mission.lanes is None:
                layers.append(layer_of_space(space, radius_m, places[-1], margin_m=margin_m))
                closed.append(())
            else:
                layers.append(layer_of_lanes(mission.lanes, radius_m, places[-1], space=space, margin_m=margin_m))
                closed.append(tuple(closed_lanes(mission.lanes, radius_m, spaces.finder(radius_m))))
        roadmap = Roadmap.joined(layers, margin_m)
        points = iter(roadmap.places.tolist())
        point_of = tuple({place: next(points) for place in own} for own in places)
        doors = RoadmapDoors.of(mission, kind, spaces.world)
        return cls(roadmap, tuple(filter(_has_radius, robots)), point_of, tuple(closed), spaces, doors)

    def plan(self, seed: int = 0) -> RoadmapPlan:
        """What plans moves of robots on it."""
        return RoadmapPlan(self.roadmap, self.spaces, seed, self.doors)

    def points(self, places: Iterable[Point], robot: Robot) -> list[int]:
        """The points of places of a robot, or of its tasks."""
        numbers = self.point_of[self.roadmap.layer_for(robot.radius_m)]
        return [numbers[place[:2]] for place in places]


def _has_radius(robot: Robot) -> bool:
    return robot.radius_m > 0


def _sizes(mission: Mission, spaces: RobotSpaces, robots: Sequence[Robot]) -> tuple[float, ...]:
    """The radii of the layers: where robots are of many, two share one that close the same lanes and gaps."""

    def alike(radius_m: float, wider_m: float) -> bool:
        if mission.lanes is not None:
            closed = [closed_lanes(mission.lanes, one, spaces.finder(one)) for one in (radius_m, wider_m)]
            if [lane.number for lane in closed[0]] != [lane.number for lane in closed[1]]:
                return False
        space, wider = spaces.space(radius_m), spaces.space(wider_m)
        return space is None or wider is None or same_ways(space, wider)

    return sizes((robot.radius_m for robot in robots), alike)


def _places(mission: Mission, robots: Sequence[Robot]) -> Iterator[Point]:
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
