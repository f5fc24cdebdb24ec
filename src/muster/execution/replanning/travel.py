"""Travel from the robots' current positions: straight, over the map, or by travel tables."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import numpy.typing as npt

from muster.execution.robots.task_motion import Way, place, straight
from muster.mission.model import Mission, Robot, TravelTable
from muster.model.lengths import Measured
from muster.model.problem import Problem
from muster.motion.map_world import body_of
from muster.motion.path import NoPath
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.port import Place, Waypoint

_OUT_M, _STEP_M, _DIRECTIONS = 3.0, 0.25, 16
"""How far out of a door a place is sought, in which steps and how many directions."""


@dataclass(frozen=True)
class Spot:
    """Where a robot is to be planned from.

    Parameters
    ----------
    point
        metres in the map frame.
    name
        the place of the travel tables nearest to it on its way.
    refuge
        a place near by where it can stand for certain, if it cannot at `point`, where odometry has it.
    """

    point: Place
    name: str
    refuge: Place


class Travel(Protocol):
    """How travel is measured for a problem in which robots stand anywhere."""

    def knows(self, name: str) -> bool:
        """Whether there is travel to a task or from a robot of that name."""
        ...

    def close(self, closed: Collection[str]) -> None:
        """From now on these doors are closed, and the others open; what is measured follows where it knows doors."""
        ...

    def stands(self, robot: Robot, at: Place) -> bool:
        """Whether a robot may stand at a place, as far as walls and closed areas go."""
        ...

    def way_out(self, robot: Robot, at: Place, goal: Place | None) -> Place | None:
        """Where a robot is to go first that stands in a door: out on its way to a goal; None where it stands free."""
        ...

    def measured(self, problem: Problem, past: Mapping[str, Spot], robots: Mapping[str, Spot]) -> Measured:
        """The lengths that a problem needs, whose own rule is straight travel.

        Parameters
        ----------
        past
            for tasks that are the past of a robot, where it is.
        robots
            for each robot, where it is.
        """
        ...


def travel_of(mission: Mission, robot_paths: RobotPaths | None = None) -> Travel:
    """Travel by the mission's rule; `robot_paths` over its map, where they are known.

    Raises
    ------
    MissionError, MissingExtraError
        as `RobotPaths.of`.
    """
    if mission.has_paths:
        return OverMap(RobotPaths.of(mission) if robot_paths is None else robot_paths, mission)
    return ByTable(mission.travel_tables) if mission.travel_rule == "matrix" else Straight()


def way_of(mission: Mission, robot_paths: RobotPaths | None = None) -> Way:
    """The ways that robots go: straight, over the mission's map or along its lanes, as `robot_paths` may have them.

    Raises
    ------
    MissionError, MissingExtraError
        as `RobotPaths.of`.
    """
    if not mission.has_paths:
        return straight
    over = RobotPaths.of(mission) if robot_paths is None else robot_paths

    def quickest(robot: Robot, start: Place, goal: Place, *, at_work: bool = False) -> Sequence[Waypoint] | None:
        d, body = mission.dimensions, body_of(robot, mission)
        found = over.driven(body.off_lanes if at_work else body, start[:d], goal[:d])
        if isinstance(found, NoPath):
            return None
        path, speeds = found
        points = zip(path.points[1:].tolist(), speeds, strict=True)
        return [Waypoint(place(point), speed_mps=speed) for point, speed in points] or [Waypoint(goal)]

    return quickest


class Straight:
    """Travel without obstacles."""

    def stands(self, robot: Robot, at: Place) -> bool:
        return True

    def knows(self, name: str) -> bool:
        return True

    def close(self, closed: Collection[str]) -> None:
        pass

    def way_out(self, robot: Robot, at: Place, goal: Place | None) -> Place | None:
        return None

    def measured(self, problem: Problem, past: Mapping[str, Spot], robots: Mapping[str, Spot]) -> Measured:
        return problem.measured


@dataclass(frozen=True, eq=False)
class OverMap:
    """Paths over a map or along lanes. A robot that stands where it cannot goes by way of its refuge."""

    robot_paths: RobotPaths
    mission: Mission | None = None

    def stands(self, robot: Robot, at: Place) -> bool:
        return self.robot_paths.stands(body_of(robot), at)

    def knows(self, name: str) -> bool:
        return True

    def close(self, closed: Collection[str]) -> None:
        self.robot_paths.close(closed)

    def way_out(self, robot: Robot, at: Place, goal: Place | None) -> Place | None:
        body, d = body_of(robot, self.mission), self.robot_paths.world.dimensions
        if self.robot_paths.stands(body, at):
            return None
        doors_open = RobotPaths(self.robot_paths.world.with_closed(()))
        free = [there for there in _around(at) if self.robot_paths.stands(body, there)]
        seen = [there for there in free if doors_open.clear(body, [at[:d], there[:d]])]

        def metres(there: Place) -> tuple[float, float]:
            onward = 0.0 if goal is None else self.robot_paths.leg_m(body, there[:d], goal[:d])
            return math.dist(at, there) + onward, math.dist(at, there)

        return min(seen, key=metres, default=None)

    def measured(self, problem: Problem, past: Mapping[str, Spot], robots: Mapping[str, Spot]) -> Measured:
        over = problem.over(self.robot_paths)
        found = over.measured(1)
        here = {problem.task_index[name]: spot for name, spot in past.items()}
        here |= {problem.start(i): robots[robot.id] for i, robot in enumerate(problem.robots)}
        for k, metres in enumerate(found.table):
            body, seconds = over.bodies[k], found.seconds[k] if len(found.seconds) else None
            cut_off = [p for p in here if not np.isfinite(np.delete(metres[p], p)).any()]
            lost = [p for p in cut_off if not self.robot_paths.stands(body, here[p].point)]
            if lost:
                refuges = np.array([here[p].refuge for p in lost])
                apart = np.linalg.norm(over.exits[k, lost] - refuges, axis=1)
                onward_m, onward_s = over.lengths(k, refuges, 1)
                metres[lost] = apart[:, None] + onward_m
                if seconds is not None:
                    seconds[lost] = apart[:, None] / over.times[k].speed_mps + onward_s
            for name, spot in past.items():  # a robot is where its past is, wherever that may be
                for i in (i for i, robot in enumerate(problem.robots) if robots[robot.id] is spot):
                    metres[problem.start(i), problem.task_index[name]] = 0.0
                    if seconds is not None:
                        seconds[problem.start(i), problem.task_index[name]] = 0.0
        return found


def _around(at: Place) -> Iterator[Place]:
    """Places around one, near ones first."""
    for away_m in np.arange(_STEP_M, _OUT_M + _STEP_M / 2, _STEP_M).tolist():
        for k in range(_DIRECTIONS):
            angle = 2 * math.pi * k / _DIRECTIONS
            yield at[0] + away_m * math.cos(angle), at[1] + away_m * math.sin(angle), at[2]


@dataclass(frozen=True)
class ByTable:
    """Travel tables, which know the places of robots and tasks alone: a robot is at the place it goes to next."""

    tables: Mapping[str, TravelTable]

    def stands(self, robot: Robot, at: Place) -> bool:
        return True

    def knows(self, name: str) -> bool:
        return all(name in table.places for table in self.tables.values())

    def close(self, closed: Collection[str]) -> None:
        pass

    def way_out(self, robot: Robot, at: Place, goal: Place | None) -> Place | None:
        return None

    def measured(self, problem: Problem, past: Mapping[str, Spot], robots: Mapping[str, Spot]) -> Measured:
        tasks = [past[task.id].name if task.id in past else task.id for task in problem.tasks]
        starts, ends = [robots[robot.id].name for robot in problem.robots], [robot.id for robot in problem.robots]
        kinds = sorted({robot.type or "" for robot in problem.robots})
        stations = [station.id for station in problem.stations]
        tables = [self._between(kind, [*tasks, *starts, *ends, *stations]) for kind in kinds]
        classes = np.array([kinds.index(robot.type or "") for robot in problem.robots], dtype=np.int32)
        return replace(problem.measured, table=np.array(tables), classes=classes)

    def _between(self, kind: str, names: Sequence[str]) -> npt.NDArray[np.float64]:
        given = self.tables[kind]
        index = {name: k for k, name in enumerate(given.places)}
        rows = [index[name] for name in names]
        return np.array(given.metres, dtype=np.float64)[np.ix_(rows, rows)]
