"""The roadmap of a mission: for its robots that drive, from its lanes, its map or the open area around its places."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from muster.mission.errors import ParameterError
from muster.mission.lanes import Lanes
from muster.mission.model import Mission, Point, Robot
from muster.motion.actions import TaskMotion, plan
from muster.motion.map_world import World
from muster.motion.paths.lane_joints import ClosedLane
from muster.traffic.journeys.roadmap_plan import UNLIMITED, Budget, RoadmapPlan
from muster.traffic.roadmaps.doors import RoadmapDoors
from muster.traffic.roadmaps.given_lanes import closed_lanes
from muster.traffic.roadmaps.passing_rows import with_passing_rows
from muster.traffic.roadmaps.roadmap import MARGIN_M, Layer, Roadmap, layer_of_lanes, layer_of_space
from muster.traffic.roadmaps.robot_sizes import same_ways, sizes
from muster.traffic.roadmaps.robot_spaces import RobotSpaces


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
    layers
        of which the roadmap is made.
    maker
        makes further ones.
    """

    roadmap: Roadmap
    robots: tuple[Robot, ...]
    point_of: tuple[Mapping[Point, int], ...]
    closed: tuple[tuple[ClosedLane, ...], ...]
    spaces: RobotSpaces
    doors: RoadmapDoors
    layers: tuple[Layer, ...]
    maker: _Maker

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
        mapped = mission.map is not None and mission.has_ways_by_map
        spaces = RobotSpaces((world or World.of_travel(mission)) if mapped else None, kind)
        maker = _Maker(mission.driven_lanes, spaces, margin_m)
        radii_m = sizes((robot.radius_m for robot in sharing), maker.alike)
        if not radii_m:
            raise ParameterError(
                "radius_m: 0 for all robots; expected a robot with a radius above 0: others share any lane"
            )
        owners = [
            [robot for robot in sharing if narrower_m < robot.radius_m <= radius_m]
            for narrower_m, radius_m in pairwise((0.0, *radii_m))
        ]
        places = [list(dict.fromkeys(place[:2] for place in _places(mission, own))) for own in owners]
        layers = tuple(map(maker.layer, radii_m, places))
        roadmap = maker.joined(layers)
        points = iter(roadmap.places.tolist())
        return cls(
            roadmap=roadmap,
            robots=tuple(robot for robot in robots if robot.radius_m > 0),
            point_of=tuple({place: next(points) for place in own} for own in places),
            closed=tuple(map(maker.closed_lanes, radii_m)),
            spaces=spaces,
            doors=RoadmapDoors.of(mission, kind, spaces.world),
            layers=layers,
            maker=maker,
        )

    def plan(self, seed: int = 0, budget: Budget = UNLIMITED) -> RoadmapPlan:
        """What plans moves of robots on it, and of others that join, of whatever size."""
        return RoadmapPlan(self.roadmap, self.spaces, seed, self.doors, self._for_more, budget)

    def points(self, places: Iterable[Point], robot: Robot) -> list[int]:
        """The points of places of a robot, or of its tasks."""
        numbers = self.point_of[self.roadmap.layer_for(robot.radius_m)]
        return [numbers[place[:2]] for place in places]

    def _for_more(self, radii_m: Iterable[float]) -> Roadmap:
        """The roadmap for robots of further sizes, too."""
        made = {layer.radius_m: layer for layer in self.layers}
        places = list(dict.fromkeys(place for points in self.point_of for place in points))
        every = sizes([*made, *radii_m], self.maker.alike)
        layers = [made[radius_m] if radius_m in made else self.maker.layer(radius_m, places) for radius_m in every]
        return self.maker.joined(layers)


@dataclass(frozen=True, eq=False)
class _Maker:
    """Makes layers of the lanes of a mission where it has them, else of its free space."""

    lanes: Lanes | None
    spaces: RobotSpaces
    margin_m: float

    def layer(self, radius_m: float, places: Sequence[Point]) -> Layer:
        space = self.spaces.space(radius_m)
        if self.lanes is None:
            return layer_of_space(space, radius_m, places, margin_m=self.margin_m)
        return layer_of_lanes(self.lanes, radius_m, places, space=space, margin_m=self.margin_m)

    def joined(self, layers: Sequence[Layer]) -> Roadmap:
        """The roadmap of some layers, of the narrowest robots first."""
        if self.lanes is None:
            radii_m = [layer.radius_m for layer in layers]
            made = with_passing_rows([layer.made for layer in layers], radii_m, self.spaces, self.margin_m)
            layers = [layer._replace(made=one) for layer, one in zip(layers, made, strict=True)]
        return Roadmap.joined(layers, self.margin_m)

    def closed_lanes(self, radius_m: float) -> tuple[ClosedLane, ...]:
        return () if self.lanes is None else tuple(closed_lanes(self.lanes, radius_m, self.spaces.finder(radius_m)))

    def alike(self, radius_m: float, wider_m: float) -> bool:
        """Whether the same lanes and gaps are open to robots of two sizes."""
        closed = [[lane.number for lane in self.closed_lanes(one)] for one in (radius_m, wider_m)]
        space, wider = self.spaces.space(radius_m), self.spaces.space(wider_m)
        return closed[0] == closed[1] and (space is None or wider is None or same_ways(space, wider))


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
