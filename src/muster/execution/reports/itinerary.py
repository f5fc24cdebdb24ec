"""The places and times of each robot by the judge's schedule: what exports write, and what distances are taken from."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

from muster.execution.replanning.travel import way_of
from muster.execution.robots.task_motion import Way, Work, place, places_of, work_of
from muster.mission.errors import Finding, PlanError
from muster.mission.model import Mission, Robot, Task
from muster.motion.actions import plan as doing
from muster.motion.leg_times import LegTimes
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.port import Place
from muster.verification import RouteFigures, Stop, Verdict


@dataclass(frozen=True)
class Passage:
    """A place that a robot passes.

    Parameters
    ----------
    place
        metres in the map frame.
    arrives_s, leaves_s
        seconds of the schedule; between them the robot works, is served, or waits for another robot or for a slot.
    task
        the task done there; None between tasks.
    station
        the station at which it is served there; None elsewhere.
    heading
        radians from east, anticlockwise, to which the robot turns there; None: unchanged.
    """

    place: Place
    arrives_s: float
    leaves_s: float
    task: str | None = None
    heading: float | None = None
    station: str | None = None

    @property
    def stays_s(self) -> float:
        return self.leaves_s - self.arrives_s


@dataclass(frozen=True)
class Itinerary:
    """A robot's passages, of which the first is its start; `has_end`: the last is where its route has to end."""

    robot: Robot
    passages: tuple[Passage, ...]
    has_end: bool

    @property
    def start(self) -> Passage:
        return self.passages[0]

    @property
    def under_way(self) -> tuple[Passage, ...]:
        """The passages between the start and the end of the route."""
        return self.passages[1:-1] if self.has_end else self.passages[1:]

    def with_heights(self, heights_m: Mapping[str, float]) -> Itinerary:
        """The itinerary with the work of some tasks, by their names, at a height above the ground of the map frame."""
        passages = [
            p if (height := heights_m.get(p.task or "")) is None else replace(p, place=(*p.place[:2], height))
            for p in self.passages
        ]
        return replace(self, passages=tuple(passages))

    def at_least(self, height_m: float) -> Itinerary:
        """The itinerary with every passage under way at least so many metres above the start."""
        floor = self.start.place[2] + height_m
        raised = [replace(p, place=(*p.place[:2], max(p.place[2], floor))) for p in self.under_way]
        return replace(self, passages=(self.start, *raised, *(self.passages[-1:] if self.has_end else ())))


def itineraries(mission: Mission, verdict: Verdict, robot_paths: RobotPaths | None = None) -> tuple[Itinerary, ...]:
    """The itinerary of every robot, in mission order; a robot without tasks stays at its start.

    Parameters
    ----------
    verdict
        of a plan that is admissible.
    robot_paths
        over the mission's map, if they are known.

    Raises
    ------
    PlanError
        if the map has no path for a leg of the plan.
    MissionError, MissingExtraError
        for travel over a map, as `RobotPaths.of`.
    """
    way = way_of(mission, robot_paths)
    tasks = {task.id: task for task in mission.tasks}
    pairs = zip(mission.robots, verdict.routes, strict=True)
    return tuple(_itinerary(mission, robot, figures, tasks, way) for robot, figures in pairs)


def heights_of_work(mission: Mission) -> dict[str, float]:
    """Return the heights, metres, at which actions state that work is done (`height_m`), by task."""
    return {task.id: task.action.height_m for task in mission.tasks if task.action and task.action.height_m}


def _itinerary(mission: Mission, robot: Robot, figures: RouteFigures, tasks: dict[str, Task], way: Way) -> Itinerary:
    passages = [Passage(place(robot.position), 0.0, figures.leaves_s)]
    stations = {station.id: place(station.position) for station in mission.stations}
    for stop in figures.stops:
        if stop.is_station:
            there = stations[stop.name]
            passages += _travel(mission, robot, passages[-1], there, stop.arrives_s, way)[:-1]
            passages.append(Passage(there, stop.arrives_s, stop.ends_s, station=stop.name))
            continue
        work = work_of(tasks[stop.name], robot, doing, way, LegTimes.in_mission(robot, mission))
        if not isinstance(work, Work):
            raise _no_way(mission, f"robot {robot.id} at task {stop.name}: {work.reason}")
        passages += _travel(mission, robot, passages[-1], work.entry, stop.arrives_s, way)[:-1]
        passages += _work(work, stop)
    end = robot.place_at_end(mission.rules)
    if end is None or figures.back_s is None:
        return Itinerary(robot, tuple(passages), has_end=False)
    passages += _travel(mission, robot, passages[-1], place(end), figures.back_s, way)
    return Itinerary(robot, tuple(passages), has_end=True)


def _travel(mission: Mission, robot: Robot, here: Passage, goal: Place, arrives_s: float, way: Way) -> list[Passage]:
    """The passages from one place to another, the goal included, at an even speed."""
    found = way(robot, here.place, goal)
    if found is None:
        raise _no_way(mission, f"robot {robot.id}: no way from {_told(here.place)} to {_told(goal)}")
    places = places_of(found)
    lengths = list(accumulate(math.dist(*leg) for leg in pairwise([here.place, *places])))
    shares = [length / lengths[-1] if lengths[-1] else 1.0 for length in lengths]
    times = [here.leaves_s + share * (arrives_s - here.leaves_s) for share in shares[:-1]] + [arrives_s]
    return [Passage(point, time, time) for point, time in zip(places, times, strict=True)]


def _work(work: Work, stop: Stop) -> list[Passage]:
    """The passages of a task, in the time that the judge gives the work; at the first the robot may wait."""
    scale = (stop.ends_s - stop.starts_s) / work.lasts_s if work.lasts_s else 0.0
    found = [
        Passage(point, stop.starts_s + scale * arrives, stop.starts_s + scale * leaves, stop.name, heading)
        for point, arrives, leaves, heading in _timed(work)
    ]
    found[0] = replace(found[0], arrives_s=stop.arrives_s)
    found[-1] = replace(found[-1], leaves_s=stop.ends_s)
    return found


def _timed(work: Work) -> Iterator[tuple[Place, float, float, float | None]]:
    """Each way point of a work with the seconds, from the entry on, at which the robot arrives and leaves."""
    here, now = work.entry, 0.0
    s_per_m = work.driven_s / work.way_m if work.way_m else 0.0
    for waypoint in work.waypoints:
        arrives = now + s_per_m * math.dist(here, waypoint.position)
        here, now = waypoint.position, arrives + waypoint.hold_s
        yield here, arrives, now, waypoint.heading


def _no_way(mission: Mission, what: str) -> PlanError:
    return PlanError([Finding(mission.source.file, None, "", what, "a plan whose legs can be travelled")])


def _told(point: Sequence[float]) -> str:
    return f"({', '.join(f'{c:g}' for c in point)})"
