"""Robots that cannot get past each other, and lanes that do not lead where robots must go."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, takewhile

from muster.mission.model import Robot, Task
from muster.model.problem import Problem
from muster.motion.actions import TaskMotion, plan
from muster.traffic.blockages.impossible_crossings import Crossings, Swap
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.names import drives


@dataclass(frozen=True)
class BlockedWay:
    """Something that no traffic can get done, proven on the roadmap.

    Parameters
    ----------
    robots
        the robot that cannot do it, or both of two that must swap where there is room for one.
    task
        the task that the first robot cannot do; None where the two cannot be at their ends both.
    detail
        why, as a sentence without its end.
    """

    robots: tuple[str, ...]
    task: str | None
    detail: str


def blocked_ways(problem: Problem) -> tuple[BlockedWay, ...]:
    """The robots and tasks between which traffic is impossible.

    Looked at are robots that drive and have a radius, on lanes or a map. A task is named where each robot that may do
    it is blocked, alone or by another one. Two robots are named where each has a task that nobody else may do and they
    cannot be at the ends of their routes both. All joint positions of the two are searched; nothing is said of a
    roadmap that is too large for that, nor of three robots or more.
    """
    mission = problem.mission
    if not any(map(drives, mission.robots)) or (mission.map is None and mission.driven_lanes is None):
        return ()
    world = problem.robot_paths.world if mission.travel_off_lanes == "map" else None
    return tuple(_Search(problem, MissionRoadmap.of(mission, world)).found())


class _Search:
    def __init__(self, problem: Problem, made: MissionRoadmap) -> None:
        self.problem, self.made = problem, made
        self.robots = made.robots
        starts = [made.points([robot.position], robot)[0] for robot in made.robots]
        self.crossings = Crossings(made.roadmap, starts, [robot.radius_m for robot in made.robots])
        self.number = {robot.id: k for k, robot in enumerate(problem.robots)}

    def found(self) -> Iterator[BlockedWay]:
        busy: dict[int, None] = {}
        for task in self.problem.tasks:
            allowed = self._allowed(task)
            blocked = list(takewhile(lambda way: way is not None, (self._blocked(robot, task) for robot in allowed)))
            if len(blocked) == len(allowed):
                yield from filter(None, blocked)
            if len(allowed) == 1:
                busy[allowed[0]] = None
        for one, other in combinations(busy, 2):
            ends = self._end(self.robots[one]), self._end(self.robots[other])
            if ends[0] is not None and ends[1] is not None:
                swap = self.crossings.ends_apart(one, other, (ends[0], ends[1]))
                if swap is not None:
                    yield self._told(swap, None, "they cannot be at the ends of their routes both")

    def _blocked(self, robot: int, task: Task) -> BlockedWay | None:
        """Why a robot cannot do a task: the lanes do not lead there, or another robot that it cannot get past."""
        name, goals = self.robots[robot].id, self._goals(robot, task)
        ends = self._end(self.robots[robot]) is not None
        where = f"to task {task.id}{' and to the end of its route' if ends else ''}"
        legs = zip([self.crossings.starts[robot], *goals], goals, strict=False)
        if self.problem.mission.driven_lanes and not all(self.crossings.reaches(*leg) for leg in legs):
            return BlockedWay((name,), task.id, f"no lanes lead {name} {where}")
        swap = self.crossings.blocking(robot, goals)
        return None if swap is None else self._told(swap, task, f"{name} cannot get {where}")

    def _told(self, swap: Swap, task: Task | None, what: str) -> BlockedWay:
        one, other = (self.robots[k].id for k in swap.robots)
        shown = f"{swap.positions} joint positions, all that they reach on the roadmap, were searched"
        detail = f"{one} and {other} must swap in a dead end: {what} ({shown})"
        return BlockedWay((one, other), None if task is None else task.id, detail)

    def _allowed(self, task: Task) -> list[int]:
        """The robots of the roadmap that may do a task, by number; without those in the air."""
        column = self.problem.task_index[task.id]
        rows = self.problem.allowed[:, column]
        if sum(rows) > sum(rows[self.number[robot.id]] for robot in self.robots):
            return []
        return [k for k, robot in enumerate(self.robots) if rows[self.number[robot.id]]]

    def _goals(self, robot: int, task: Task) -> list[int]:
        """The points at which a robot must be for a task, in order, and its end at last."""
        motion = plan(task, self.robots[robot])
        places = [motion.entry, motion.exit] if isinstance(motion, TaskMotion) else []
        end = self._end(self.robots[robot])
        return self.made.points(places, self.robots[robot]) + ([] if end is None else [end])

    def _end(self, robot: Robot) -> int | None:
        place = robot.place_at_end(self.problem.mission.rules)
        return None if place is None else self.made.points([place], robot)[0]
