"""The rules of time, teams and relations that hold in a problem, by task and robot."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from muster.mission.model import Robot, Task
from muster.mission.task_relations import tied_by
from muster.mission.values.arrays import Bools, Floats

ROUNDING = 2e-9
"""By how much a time may be above a limit, relative; a little more than the judge allows."""

Openings = list[tuple[float, float]]


class Question(Protocol):
    """What the rules are read from: a `Problem`."""

    @property
    def robots(self) -> tuple[Robot, ...]: ...
    @property
    def tasks(self) -> tuple[Task, ...]: ...
    @property
    def prerequisites(self) -> list[list[int]]: ...
    @property
    def task_index(self) -> dict[str, int]: ...

    def holds(self, rule: str) -> bool: ...


@dataclass(frozen=True, eq=False)
class TimedRules:
    """What the mission says of time and teams, as far as it is not ignored."""

    problem: Question

    @cached_property
    def openings(self) -> list[Openings]:
        """For each task when work on it may begin; empty: at any time."""
        if not self.problem.holds("window"):
            return [[] for _ in self.problem.tasks]
        return [[(a, math.inf if b is None else b) for a, b in task.window_s] for task in self.problem.tasks]

    @cached_property
    def ends_by(self) -> Floats:
        """(n,) inf: none."""
        holds = self.problem.holds("deadline")
        return np.array([_limit(task.deadline_s if holds else None) for task in self.problem.tasks])

    @cached_property
    def due(self) -> Floats:
        """(n,) inf: never late."""
        return np.array([_limit(task.due_s) for task in self.problem.tasks])

    @cached_property
    def over_by(self) -> Floats:
        """(m,) inf: always."""
        holds = self.problem.holds("shift")
        return np.array([_limit(robot.available_until_s if holds else None) for robot in self.problem.robots])

    def gaps(self, j: int) -> list[tuple[int, float, float]]:
        """The prerequisites of a task; how long after the end of each work begins, at least and at most."""
        task, found = self.problem.tasks[j], []
        for k in self.problem.prerequisites[j]:
            lag = task.lags.get(self.problem.tasks[k].id)
            found.append((k, 0.0, math.inf) if lag is None else (k, lag.after_s, _limit(lag.within_s)))
        return found

    @cached_property
    def units(self) -> list[list[int]]:
        """The tasks in sets that begin together."""
        members: dict[int, list[int]] = {}
        tasks = self.problem.tasks
        tied = tied_by("starts_with", tasks) if self.problem.holds("relation") else range(len(tasks))
        for j, first in enumerate(tied):
            members.setdefault(first, []).append(j)
        return list(members.values())

    @cached_property
    def unit(self) -> list[int]:
        """For each task the index of its unit."""
        index = {j: u for u, members in enumerate(self.units) for j in members}
        return [index[j] for j in range(len(self.problem.tasks))]

    def beginning_with(self, j: int) -> list[int]:
        """The other tasks of its unit."""
        return [k for k in self.units[self.unit[j]] if k != j]

    @cached_property
    def same_crew(self) -> list[list[int]]:
        """For each task those that the same robots do."""
        return self._both_ways([self._related(task.same_robot_as) for task in self.problem.tasks])

    @cached_property
    def apart(self) -> list[list[int]]:
        """For each task those that none of its robots does."""
        return self._both_ways([self._related(task.other_robot_than) for task in self.problem.tasks])

    @staticmethod
    def _both_ways(named: list[list[int]]) -> list[list[int]]:
        if not any(named):
            return named
        both: list[set[int]] = [set(others) for others in named]
        for j, others in enumerate(named):
            for k in others:
                both[k].add(j)
        return [sorted(others) for others in both]

    def _related(self, names: Sequence[str]) -> list[int]:
        """The named tasks that are in the problem: of a part of a mission not all are, and then nothing is tied."""
        if not names or not self.problem.holds("relation"):
            return []
        index = self.problem.task_index
        return [index[name] for name in names if name in index]

    @cached_property
    def with_teams(self) -> bool:
        """Whether a team may have to do a task."""
        return bool(self.for_teams)

    @cached_property
    def for_teams(self) -> tuple[int, ...]:
        """The tasks that more than one robot may have to do."""
        return tuple(filter(self.is_for_team, range(len(self.problem.tasks))))

    @cached_property
    def with_relations(self) -> bool:
        """Whether tasks are tied to others by who does them, or begin together."""
        tied = any(map(any, (self.same_crew, self.apart)))
        return tied or len(self.units) < len(self.problem.tasks)

    def is_for_team(self, j: int) -> bool:
        """Whether more than one robot may have to do a task."""
        return self.problem.holds("team") and self.problem.tasks[j].is_for_team

    def needed(self, j: int) -> Mapping[str, float]:
        """What the abilities of the robots that do a task must sum to; none: nothing."""
        return (self.problem.tasks[j].needs or {}) if self.problem.holds("team") else {}

    def has_parts(self, j: int) -> bool:
        """Whether the robots that do a task are so many of each sort, more than one in all."""
        return self.is_for_team(j) and not self.needed(j)

    def needs(self, j: int) -> list[tuple[float, Floats]]:
        """What the abilities of a team must sum to, with those of each robot."""
        needs = self.problem.tasks[j].needs if self.problem.holds("team") else None
        robots = self.problem.robots
        return [(value, np.array([ability(robot, name) for robot in robots])) for name, value in (needs or {}).items()]

    def parts(self, j: int) -> list[tuple[int, Bools]]:
        """The parts of a team: how many robots, and which may be among them."""
        task = self.problem.tasks[j]
        if not self.is_for_team(j) or not task.team:
            return [
                (
                    (task.robots_needed if self.is_for_team(j) else None) or 1,
                    np.ones(len(self.problem.robots), np.bool_),
                )
            ]
        skills = self.problem.holds("skill")
        return [(p.count, np.array([p.fits(r, skills=skills) for r in self.problem.robots])) for p in task.team]

    def places(self, u: int) -> tuple[list[int], Bools]:
        """The places of the teams of a unit, of `needs` one: the task of each, and (places, m) which robots fit."""
        rows = [(j, fits) for j in self.units[u] for count, fits in self.parts(j) for _ in range(count)]
        return [j for j, _ in rows], np.array([fits for _, fits in rows], dtype=np.bool_)

    def next_begin(self, j: int, times: Floats) -> Floats:
        """When work on a task may begin that is ready at some times; inf: not any more."""
        if not self.openings[j]:
            return times
        opens, closes = np.array(self.openings[j]).T
        at = np.searchsorted(closes * (1 + ROUNDING), times)
        return np.asarray(np.maximum(times, np.append(opens, math.inf)[at]))

    def in_team(self, i: int) -> object:
        """What makes robot i the same as another in every team."""
        if not self.for_teams:
            return None
        seats = tuple(bool(fits[i]) for j in self.for_teams for _, fits in self.parts(j))
        return seats, tuple(sorted((self.problem.robots[i].abilities or {}).items()))

    def sizes_differ(self, j: int, k: int) -> bool:
        """Whether no team is of the right size for both of two tasks."""
        fewest = self.least_members(j), self.least_members(k)
        return fewest[0] != fewest[1] and not any(
            self.needed(few) for few, least in zip((j, k), fewest, strict=True) if least < max(fewest)
        )

    def least_members(self, j: int) -> int:
        """How many robots a task needs at least."""
        if not self.is_for_team(j):
            return 1
        if self.problem.tasks[j].needs:
            return max((_fewest(least, able) for least, able in self.needs(j)), default=1)
        return sum(count for count, _ in self.parts(j))


def _limit(value: float | None) -> float:
    return math.inf if value is None else value


def ability(robot: Robot, name: str) -> float:
    """How much of an ability a robot has."""
    return float((robot.abilities or {}).get(name, 0.0))


def _fewest(least: float, able: Floats) -> int:
    """How many of the ablest robots reach the least sum; one more than there are if none do."""
    sums = np.cumsum(np.sort(able)[::-1])
    return int((sums < least * (1 - 1e-9)).sum()) + 1
