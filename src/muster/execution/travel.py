"""Travel from where robots are now: straight, over the map, or by travel tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from muster.allocation.problem import Problem
from muster.execution.doing import Way, place, straight
from muster.mission.model import Mission, Robot, TravelTable
from muster.motion.path import NoPath
from muster.motion.port import Place
from muster.motion.roads import Roads
from muster.motion.world import body_of

Table = tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]
"""(classes, n + 2m, n + 2m) metres between tasks, starts and ends of a problem, and (m,) each robot's class."""


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

    def table(self, problem: Problem, past: Mapping[str, Spot], robots: Mapping[str, Spot]) -> Table | None:
        """Travel of a problem; None where it is straight.

        Parameters
        ----------
        past
            for tasks that are the past of a robot, where it is.
        robots
            for each robot, where it is.
        """
        ...


def travel_of(mission: Mission, roads: Roads | None = None) -> Travel:
    """Travel by the mission's rule; `roads` over its map, if they are known.

    Raises
    ------
    MissionError, MissingExtraError
        as `Roads.of`.
    """
    if mission.travel_rule == "map":
        return OverMap(Roads.of(mission) if roads is None else roads)
    return ByTable(mission.travel_tables) if mission.travel_rule == "matrix" else Straight()


def way_of(mission: Mission, roads: Roads | None = None) -> Way:
    """The ways that robots go: the shortest over the mission's map, which `roads` may hold already, or straight.

    Raises
    ------
    MissionError, MissingExtraError
        as `Roads.of`.
    """
    if mission.travel_rule != "map":
        return straight
    over = Roads.of(mission) if roads is None else roads

    def shortest(robot: Robot, start: Place, goal: Place) -> Sequence[Place] | None:
        d = mission.dimensions
        found = over.path(body_of(robot), start[:d], goal[:d])
        return None if isinstance(found, NoPath) else [place(point) for point in found.points[1:].tolist()] or [goal]

    return shortest


class Straight:
    """Travel without obstacles."""

    def knows(self, name: str) -> bool:
        return True

    def table(self, problem: Problem, past: Mapping[str, Spot], robots: Mapping[str, Spot]) -> Table | None:
        return None


@dataclass(frozen=True, eq=False)
class OverMap:
    """Shortest paths over a map. A robot that stands where it cannot goes by way of its refuge."""

    roads: Roads

    def knows(self, name: str) -> bool:
        return True

    def table(self, problem: Problem, past: Mapping[str, Spot], robots: Mapping[str, Spot]) -> Table | None:
        here = [past.get(task.id) for task in problem.tasks] + [robots[robot.id] for robot in problem.robots]
        ends = [place(robot.end_position or robot.position) for robot in problem.robots]
        entries = [place(task.entry or task.position) for task in problem.tasks]
        exits = [place(task.exit or task.position) for task in problem.tasks]
        starts = [place(robot.position) for robot in problem.robots]
        into, out = np.array([*entries, *starts, *ends]), np.array([*exits, *starts, *ends])
        refuges = np.array([*(out[k] if spot is None else spot.refuge for k, spot in enumerate(here)), *ends])
        bodies = list(dict.fromkeys(body_of(robot) for robot in problem.robots))
        tables = []
        for body in bodies:
            metres = self.roads.lengths(body, out, into, 1)
            lost = [k for k in range(len(here)) if here[k] is not None and not np.isfinite(metres[k]).any()]
            if lost:
                apart = np.linalg.norm(out[lost] - refuges[lost], axis=1)
                metres[lost] = apart[:, None] + self.roads.lengths(body, refuges[lost], into, 1)
            tables.append(metres)
        return np.array(tables), np.array([bodies.index(body_of(r)) for r in problem.robots], dtype=np.int32)


@dataclass(frozen=True)
class ByTable:
    """Travel tables, which know the places of robots and tasks alone: a robot is at the place it goes to next."""

    tables: Mapping[str, TravelTable]

    def knows(self, name: str) -> bool:
        return all(name in table.places for table in self.tables.values())

    def table(self, problem: Problem, past: Mapping[str, Spot], robots: Mapping[str, Spot]) -> Table | None:
        tasks = [past[task.id].name if task.id in past else task.id for task in problem.tasks]
        starts, ends = [robots[robot.id].name for robot in problem.robots], [robot.id for robot in problem.robots]
        kinds = sorted({robot.type or "" for robot in problem.robots})
        tables = [self._between(kind, [*tasks, *starts, *ends]) for kind in kinds]
        return np.array(tables), np.array([kinds.index(robot.type or "") for robot in problem.robots], dtype=np.int32)

    def _between(self, kind: str, names: Sequence[str]) -> npt.NDArray[np.float64]:
        given = self.tables[kind]
        index = {name: k for k, name in enumerate(given.places)}
        rows = [index[name] for name in names]
        return np.array(given.metres, dtype=np.float64)[np.ix_(rows, rows)]
