"""The usage of each route (docs/design.md, Meaning; [tcf-thesis] (3.8)-(3.10) and (3.28)-(3.29))."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from muster.mission.model import Mission, Robot, Task
from muster.motion.actions import TaskMotion
from muster.motion.leg_times import LegTimes
from muster.verification.travel import Place, Travel, doing_at, place_at_end, place_of_start, place_of_task, rise_m


class Leg(NamedTuple):
    """The way to a place. A leg without a way counts nothing, so that the rest of the route can still be judged."""

    exists: bool
    usage: float
    seconds: float


class Step(NamedTuple):
    """One task of a route: the way there, the usage on arrival, and how long the work takes.

    It is passable if there is a way along the way points of its action; without one the work's metres count nothing.
    """

    task: Task
    leg: Leg
    arrival_usage: float
    work_s: float
    passable: bool


@dataclass(frozen=True)
class MeasuredRoute:
    """One robot's route with its costs; `last_leg` goes to where the route must end, if it must and has tasks."""

    robot: Robot
    steps: tuple[Step, ...]
    last_leg: Leg | None
    travel: float
    work: float

    @property
    def usage(self) -> float:
        """Travel plus work: u_i of [tcf-thesis] (3.10)."""
        return self.travel + self.work


def all_measured(mission: Mission, travel: Travel, tasks_of: Mapping[str, Sequence[Task]]) -> tuple[MeasuredRoute, ...]:
    """Measure the routes of all robots, in mission order. A task takes as long as for the slowest of its team."""
    slowest: dict[str, float] = {}
    for robot in mission.robots:
        times = LegTimes.in_mission(robot, mission)
        for task in tasks_of.get(robot.id, ()):
            seconds = work_seconds(times, travel, robot, task)
            slowest[task.id] = max(seconds, slowest.get(task.id, 0.0))
    return tuple(measured(mission, travel, robot, tasks_of.get(robot.id, ()), slowest) for robot in mission.robots)


def measured(
    mission: Mission, travel: Travel, robot: Robot, tasks: Sequence[Task], work_s: Mapping[str, float]
) -> MeasuredRoute:
    """Measure one robot's route; `work_s` is how long each task takes."""
    in_time = mission.rules.usage == "time"
    times = LegTimes.in_mission(robot, mission)
    steps: list[Step] = []
    travelled = worked = 0.0
    here = place_of_start(robot)
    for task in tasks:
        there = place_of_task(task, robot)
        leg = leg_between(travel, robot, here, there, times, in_time)
        travelled += leg.usage
        metres = travel.work_metres(robot, task)
        seconds = work_s[task.id]
        steps.append(Step(task, leg, travelled + worked, seconds, passable=metres is not None))
        worked += seconds if in_time else metres or 0.0
        here = there
    end = place_at_end(robot, mission.rules) if steps else None
    last_leg = None if end is None else leg_between(travel, robot, here, end, times, in_time)
    travelled += last_leg.usage if last_leg else 0.0
    return MeasuredRoute(robot, tuple(steps), last_leg, travelled, worked)


def leg_between(travel: Travel, robot: Robot, start: Place, end: Place, times: LegTimes, in_time: bool) -> Leg:
    """Measure the leg from the exit of one place to the entry of another."""
    metres = travel.metres(robot, start, end)
    if metres is None:
        return Leg(exists=False, usage=0.0, seconds=0.0)
    seconds = times.leg_seconds(metres, rise_m(start, end), math.dist(start.exit, end.entry))
    return Leg(exists=True, usage=seconds if in_time else metres, seconds=seconds)


def work_seconds(times: LegTimes, travel: Travel, robot: Robot, task: Task) -> float:
    """Return how long the robot works on the task: duration by efficiency where one is given.

    Else the time of its motion profile along the way points of the task's action, if it has any; else cost by speed.
    """
    duration = task.duration_s
    if duration is None and task.action is not None:
        duration = task.action.duration_s
    if duration is not None:
        return duration / robot.efficiency
    metres = travel.work_metres(robot, task) or 0.0
    doing = None if times.is_constant else doing_at(robot, task)
    if not isinstance(doing, TaskMotion) or metres == 0.0:
        return metres / robot.speed_mps
    return times.work_seconds(doing.points, travel.leg_metres(robot, doing))


def equality_index(usages: Sequence[float]) -> float:
    """Return 1 - Gini over the usages of all robots, [tcf-thesis] (3.28) and (3.29); 1 if all are 0.

    From 1/M, where one of M robots has all the usage, to 1, where all have the same.
    """
    total = sum(usages)
    if total == 0:
        return 1.0
    count = len(usages)
    # A share first, then its weight: the sum of rank times usage may overflow where the index does not.
    ranked = sum(rank * (usage / total) for rank, usage in enumerate(sorted(usages), start=1))
    gini = 2 * ranked / count - (count + 1) / count
    return 1 - gini
