"""A task with `only_robots` is done by one of those robots."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

from muster.mission.model import Robot, Task
from muster.model.parts import Parts
from muster.model.rules.rule import Change, Question, Rule, listed


@dataclass(frozen=True)
class LockedOut(Change):
    """The robots that a task is locked to, of which the robot is none."""

    robots: tuple[str, ...]

    @property
    def plain(self) -> tuple[str, ...]:
        return self.robots

    @property
    def short(self) -> str:
        return "a place in the lock"

    @property
    def line(self) -> str:
        return f"a place in the lock: only {listed(self.robots)} may do it"

    def task(self, task: Task, robot: Robot) -> Task:
        return replace(task, only_robots=(*self.robots, robot.id))


class Lock(Rule):
    """The robot is one of `only_robots_j`, where these are given.

    A problem that ignores the rule has no locks of the mission; those in it are made by planning, and hold.
    """

    word: ClassVar[str] = "lock"
    ignorable = False
    key = "lock"

    def compile(self, problem: Question, parts: Parts) -> None:
        for k, station in enumerate(problem.mission.stations):
            for i, robot in enumerate(problem.robots):
                if station.only_robots is not None and robot.id not in station.only_robots:
                    parts.keep_away(i, k)

    def kinds(self, problem: Question) -> Sequence[Hashable]:
        locked = {name for task in problem.tasks for name in task.only_robots or ()}
        return [robot.id if robot.id in locked else None for robot in problem.robots]

    def refusal(self, problem: Question, i: int, j: int) -> str | None:
        task = problem.tasks[j]
        if task.only_robots is None or problem.robots[i].id in task.only_robots:
            return None
        return f"only {listed(task.only_robots)} may do it"

    def change(self, problem: Question, robot: Robot, task: Task) -> LockedOut | None:
        if task.only_robots is None or robot.id in task.only_robots:
            return None
        return LockedOut(task.only_robots)
