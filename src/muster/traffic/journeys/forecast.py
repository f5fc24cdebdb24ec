"""How long a plan takes where robots pass in turn: the forecast of its traffic, before anybody moves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot
from muster.mission.plan import RouteStop
from muster.motion.actions import TaskMotion
from muster.motion.actions import plan as motion_of
from muster.traffic.journeys.joint_journeys import JointJourneys, Journey
from muster.traffic.journeys.roadmap_plan import RoadmapPlan
from muster.traffic.journeys.travellers import Stop, Traveller
from muster.traffic.names import drives
from muster.traffic.roadmaps.roadmap import Roadmap

_WAYS_EACH, _LEAST_WAYS = 4, 40
"""Ways of each robot that are sought, and of all: they tell how long a plan takes as well as the more of a run do."""
_MOST = 3_000_000
"""Robots and tasks times edges of the roadmap up to which traffic is forecast: for more that takes some seconds."""
_WAYS_AFTER_CHANGE = 12
"""Ways that are sought beside those of robots that go elsewhere."""


@dataclass(frozen=True)
class RobotForecast:
    """When a robot has ended its route, its way home included.

    Parameters
    ----------
    with_traffic_s
        seconds, with what it waits for others; None where no path is found for it.
    alone_s
        seconds, were it alone on the roadmap; None where no path is found.
    """

    robot: str
    with_traffic_s: float | None
    alone_s: float | None

    @property
    def delay_s(self) -> float:
        """What the others cost it; inf where no path is found among them."""
        if self.with_traffic_s is None or self.alone_s is None:
            return math.inf
        return max(0.0, self.with_traffic_s - self.alone_s)


@dataclass(frozen=True)
class Forecast:
    """How the robots of a plan that drive get along: together, and each as if it were alone.

    Parameters
    ----------
    robots
        a line for each.
    together, alone
        the journey of each.
    """

    robots: tuple[RobotForecast, ...]
    together: tuple[Journey, ...]
    alone: tuple[Journey, ...]

    @property
    def with_traffic_s(self) -> float | None:
        """When all have ended their routes; None where somebody finds no path."""
        return _last([one.with_traffic_s for one in self.robots])

    @property
    def alone_s(self) -> float | None:
        """The same, if each were alone."""
        return _last([one.alone_s for one in self.robots])


class Forecaster:
    """Forecasts of the traffic of one mission.

    A robot stays at each task as long as its route says, waits for other tasks, the clock and other robots included.

    Parameters
    ----------
    mission
        whose robots drive.
    traffic
        the roadmap that they share.

    Raises
    ------
    ParameterError
        if no robot is of kind `ground` with a radius above 0.
    """

    def __init__(self, mission: Mission, traffic: RoadmapPlan) -> None:
        self._mission, self._traffic = mission, traffic
        self._driving = [robot for robot in mission.robots if drives(robot)]
        if not self._driving:
            raise ParameterError(
                "no robot is of kind ground with a radius above 0; expected one whose traffic is forecast"
            )
        self._stations = [(station.position[0], station.position[1]) for station in mission.stations]
        self._journeys: JointJourneys | None = None
        self._before: JointJourneys | None = None  # where the last change made others of them

    def of(self, routes: Mapping[str, Sequence[RouteStop]]) -> Forecast:
        """What the traffic of routes comes to."""
        travellers, self._before = self._travellers(routes), None
        ways = max(_LEAST_WAYS, _WAYS_EACH * len(travellers))
        self._journeys = self._traffic.journeys(travellers, ways=ways, places=self._stations)
        return self._told(self._journeys)

    def changed(self, routes: Mapping[str, Sequence[RouteStop]]) -> Forecast:
        """The same after a forecast of routes most of which are as these: that of the others is sought among them.

        It may be less, as more was sought from one forecast to the next.
        """
        travellers, before, self._before = self._travellers(routes), self._journeys, None
        if self._journeys is None or not self._journeys.knows(travellers):
            told = self.of(routes)
            self._before = before
            return told
        self._journeys.change(travellers, ways=_WAYS_AFTER_CHANGE)
        return self._told(self._journeys)

    def undo(self) -> None:
        """Take the last change back: the next one is of the routes before it."""
        if self._before is not None:
            self._journeys, self._before = self._before, None
        elif self._journeys is not None:
            self._journeys.undo()

    def _travellers(self, routes: Mapping[str, Sequence[RouteStop]]) -> list[Traveller]:
        return [_traveller(self._mission, robot, routes.get(robot.id, ())) for robot in self._driving]

    def _told(self, journeys: JointJourneys) -> Forecast:
        together, alone = journeys.together, journeys.alone
        robots = tuple(
            RobotForecast(robot.id, finite(among.end_s), finite(by_itself.end_s))
            for robot, among, by_itself in zip(self._driving, together, alone, strict=True)
        )
        return Forecast(robots, tuple(together), tuple(alone))


def is_forecast(mission: Mission, roadmap: Roadmap) -> bool:
    """Return whether robots and tasks are so few that their traffic on a roadmap is forecast."""
    return (len(mission.robots) + len(mission.tasks)) * len(roadmap.edges) <= _MOST


def forecast(mission: Mission, routes: Mapping[str, Sequence[RouteStop]], traffic: RoadmapPlan) -> Forecast:
    """What `traffic` makes of the routes of robots: see `Forecaster`."""
    return Forecaster(mission, traffic).of(routes)


def _last(times_s: Sequence[float | None]) -> float | None:
    known = [time_s for time_s in times_s if time_s is not None]
    return max(known) if len(known) == len(times_s) else None


def finite(seconds: float) -> float | None:
    """Seconds that are known; None for inf and NaN."""
    return seconds if math.isfinite(seconds) else None


def _traveller(mission: Mission, robot: Robot, route: Sequence[RouteStop]) -> Traveller:
    home = robot.place_at_end(mission.rules)
    stops = list(_stops(mission, robot, route))
    if stops and home is not None:
        stops.append(Stop((home[0], home[1])))
    start = (robot.position[0], robot.position[1])
    return Traveller(
        robot=robot,
        start=start,
        stops=tuple(stops),
        heading_rad=math.radians(robot.heading_deg or 0.0),
        ready_s=robot.available_from_s if stops else 0.0,
        stays=bool(stops) and home is not None,
    )


def _stops(mission: Mission, robot: Robot, route: Sequence[RouteStop]) -> Iterator[Stop]:
    """Where a robot enters and leaves its tasks, and how long it is at each."""
    tasks = {task.id: task for task in mission.tasks}
    stations = {station.id: station for station in mission.stations}
    for stop in route:
        if stop.is_station:
            x, y = stations[stop.name].position[:2]
            yield Stop((x, y), stop.end_s - stop.arrive_s)
            continue
        motion = motion_of(tasks[stop.name], robot)
        if not isinstance(motion, TaskMotion):
            continue
        (x, y), (to_x, to_y) = motion.entry[:2], motion.exit[:2]
        moves_s = math.dist((x, y), (to_x, to_y)) / robot.speed_mps
        if moves_s == 0.0:
            yield Stop((x, y), stop.end_s - stop.arrive_s)
            continue
        yield Stop((x, y), stop.begin_s - stop.arrive_s)
        yield Stop((to_x, to_y), max(0.0, stop.end_s - stop.begin_s - moves_s))
