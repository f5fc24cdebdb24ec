"""Whether a robot could do a task that a plan leaves out, everything else in the plan kept: all places are tried."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, islice, product

from muster.mission.model import Robot, Task
from muster.mission.task_relations import tied_by
from muster.motion.leg_times import LegTimes
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute, measured, work_seconds
from muster.verification.rules import rules_that_hold
from muster.verification.rules.pair_rule import PairRule
from muster.verification.rules.team import team_fault
from muster.verification.schedule import schedule
from muster.verification.schedule_nodes import Deadlock

MARGIN = 1e-6
"""What a limit is kept or broken by at least, relative, for a place to count."""

_MOST_TEAMS, _MOST_TRIED, _MOST_PLACES = 60, 2000, 200
_MOST_STOPS = 20_000  # of all schedules that are computed for one plan

Member = tuple[Robot, Task]


class TooManyError(Exception):
    """There are more teams or places than are looked at."""


@dataclass(eq=False)
class Places:
    """The places of tasks in the routes of a plan."""

    case: Case
    stops_left: int = _MOST_STOPS

    @cached_property
    def _route(self) -> dict[str, MeasuredRoute]:
        return {route.robot.id: route for route in self.case.routes}

    @cached_property
    def _work(self) -> dict[str, float]:
        """How long each task of the plan takes."""
        return {step.task.id: step.work_s for route in self.case.routes for step in route.steps}

    @property
    def _margin(self) -> float:
        return max(MARGIN, 2 * self.case.travel.tolerance)

    @cached_property
    def _is_sure(self) -> bool:
        """Whether the plan keeps all rules, and margins say enough.

        A length that is off moves both ends of a lag, by more than the margin of a short one.
        """
        inexact = self.case.has_within and self.case.travel.tolerance
        return not inexact and self._is_kept({}, -self._margin)

    def can_do(self, robot: Robot, task: Task) -> bool | None:
        """Whether a robot can do a task at some place, with a team where it needs one; None: undecided.

        Undecided are tasks with many teams or places, plans that break a rule themselves, and limits that are kept or
        broken by less than the margin. So are tasks that come in pairs, and all where robots charge or go to stations:
        other tasks, and other visits, may have to come with them.
        """
        case, close = self.case, False
        if case.is_paired(task) or case.has_energy or case.mission.stations:
            return None
        try:
            if self.stops_left < 0 or not self._is_sure:
                return None
            for place in self._places(robot, task):
                if not self._is_kept(place, -self._margin):
                    continue
                if self._is_kept(place, self._margin):
                    return True
                close = True
        except TooManyError:
            return None
        return None if close else False

    def _places(self, robot: Robot, task: Task) -> Iterator[dict[str, list[Task]]]:
        """The routes that change, by robot, for each place."""
        found = 0
        for team in self._units(robot, task):
            gaps = [range(len(self._route[member.id].steps) + 1) for member, _ in team]
            found += math.prod(map(len, gaps)) if len(team) > 1 else 0
            if found > _MOST_PLACES:
                raise TooManyError
            for at in product(*gaps):
                yield {member.id: self._with(member, one, gap) for (member, one), gap in zip(team, at, strict=True)}

    def _with(self, robot: Robot, task: Task, gap: int) -> list[Task]:
        tasks = [step.task for step in self._route[robot.id].steps]
        return [*tasks[:gap], task, *tasks[gap:]]

    # --- teams -------------------------------------------------------------------------------------------------------

    def _units(self, robot: Robot, task: Task) -> list[list[Member]]:
        """Different robots for a task and for those that begin with it and are left out, a robot among them."""
        teams = [self._teams(one, robot if one is task else None) for one in self._together(task)]
        if math.prod(map(len, teams)) > _MOST_TRIED:
            raise TooManyError
        units = [[member for team in one for member in team] for one in product(*teams)]
        found = [unit for unit in units if len({member.id for member, _ in unit}) == len(unit)]
        if len(found) > _MOST_TEAMS:
            raise TooManyError
        return found

    def _together(self, task: Task) -> list[Task]:
        """A task, and those left out that begin with it."""
        tasks = self.case.mission.tasks
        own = self._first_of_unit[task.id]
        others = (one for one in tasks if self._first_of_unit[one.id] == own and one.id != task.id)
        return [task, *(one for one in others if one.id not in self.case.done)]

    @cached_property
    def _first_of_unit(self) -> dict[str, int]:
        """For each task the number of the first that it begins with."""
        tasks = self.case.mission.tasks
        tied = tied_by("starts_with", tasks) if self.case.holds("relation") else range(len(tasks))
        return {task.id: k for task, k in zip(tasks, tied, strict=True)}

    def _teams(self, task: Task, required: Robot | None) -> list[list[Member]]:
        """The teams of a task, with a robot that must be in it."""
        alone = not (self.case.holds("team") and task.is_for_team)
        robots = (required,) if alone and required else self.case.mission.robots
        able = [robot for robot in robots if self._may(robot, task)]
        if alone:
            return [[(robot, task)] for robot in able]
        tried = (team for size in self._sizes(task, len(able)) for team in combinations(able, size))
        some = list(islice(tried, _MOST_TRIED + 1))
        if len(some) > _MOST_TRIED:
            raise TooManyError
        skills = self.case.holds("skill")
        return [
            [(robot, task) for robot in team]
            for team in some
            if (required is None or required in team) and team_fault(task, team, skills=skills) is None
        ]

    @staticmethod
    def _sizes(task: Task, most: int) -> Sequence[int]:
        if task.needs is not None:
            return range(1, most + 1)
        return [sum(part.count for part in task.team) if task.team else task.robots_needed or 1]

    def _may(self, robot: Robot, task: Task) -> bool:
        return all(rule.refusal(self.case.mission, robot, task) is None for rule in self._pair_rules)

    @cached_property
    def _pair_rules(self) -> list[PairRule]:
        return [rule for rule in rules_that_hold(self.case) if isinstance(rule, PairRule)]

    # --- rules -------------------------------------------------------------------------------------------------------

    def _is_kept(self, changed: dict[str, list[Task]], margin: float) -> bool:
        """Whether routes, some of them changed, keep all rules by a margin."""
        routes = self._measured(changed)
        if not all(self._has_capacity(route, margin) for route in routes):
            return False
        own = [[route] for route in routes if route.robot.id in changed]
        # A route that is too late by itself, which waits for no other, is so among all.
        if not all(self._is_in_time(some, margin) for some in (*own, routes)):
            return False
        case = Case(self.case.mission, self.case.travel, routes, self.case.ignored, deadlocked=False)
        rules = [rule for rule in rules_that_hold(case) if rule.kind != "capacity"]
        return not any(True for route in routes for rule in rules for _ in rule.violations(case, route))

    def _is_in_time(self, routes: Sequence[MeasuredRoute], margin: float) -> bool:
        self.stops_left -= sum(len(route.steps) for route in routes)
        if self.stops_left < 0:
            raise TooManyError
        found = schedule(routes, self.case.ignored, margin)
        return not isinstance(found, Deadlock) and not found.broken

    def _has_capacity(self, route: MeasuredRoute, margin: float) -> bool:
        capacity = self.case.capacity_of(route.robot)
        return capacity is None or route.usage <= capacity * (1 - margin)

    def _measured(self, changed: dict[str, list[Task]]) -> tuple[MeasuredRoute, ...]:
        """The routes of all robots; a task takes as long as for the slowest of its team."""
        mission, travel, work = self.case.mission, self.case.travel, dict(self._work)
        for name, tasks in changed.items():
            robot = self._route[name].robot
            times = LegTimes.in_mission(robot, mission)
            for task in tasks:
                if task.id not in self._work:
                    seconds = work_seconds(times, travel, robot, task)
                    work[task.id] = max(seconds, work.get(task.id, 0.0))
        return tuple(
            measured(mission, travel, route.robot, changed[route.robot.id], work)
            if route.robot.id in changed
            else route
            for route in self.case.routes
        )
