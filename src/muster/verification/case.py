"""The input of the judge: a mission, the measured routes of a plan, and the rules that are ignored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from muster.mission.declared_rules import usable_rules
from muster.mission.ignorable_rules import timed_keys
from muster.mission.model import Mission, Robot, Task
from muster.mission.task_relations import alternatives_of
from muster.verification.insertions import Insertions
from muster.verification.measure import MeasuredRoute
from muster.verification.travel import Travel

ROUNDING = 1e-9
"""Relative. A route that fills its capacity exactly may come out above it, the order of additions being free."""

_OFFERED = ("abilities", "load_capacity", "load_at_start")  # by robots: it binds nothing that no task asks for


@dataclass(frozen=True, eq=False)
class Case:
    """The data that the rules of the judge work on.

    Parameters
    ----------
    routes
        of all robots, in mission order.
    ignored
        the rules that do not hold.
    deadlocked
        whether routes and prerequisites wait for each other in a cycle.
    """

    mission: Mission
    travel: Travel
    routes: tuple[MeasuredRoute, ...]
    ignored: tuple[str, ...]
    deadlocked: bool

    @cached_property
    def done(self) -> frozenset[str]:
        """The tasks in the plan."""
        return frozenset(step.task.id for route in self.routes for step in route.steps)

    @cached_property
    def members(self) -> dict[str, list[Robot]]:
        """For each task in the plan the robots that do it, in mission order."""
        members: dict[str, list[Robot]] = {}
        for route in self.routes:
            for step in route.steps:
                members.setdefault(step.task.id, []).append(route.robot)
        return members

    @cached_property
    def task(self) -> dict[str, Task]:
        """The tasks of the mission by id."""
        return {task.id: task for task in self.mission.tasks}

    @cached_property
    def deliverer(self) -> dict[str, str]:
        """For each task whose load another delivers the id of that."""
        return {task.delivers: task.id for task in self.mission.tasks if task.delivers is not None}

    def is_paired(self, task: Task) -> bool:
        """Whether a task is in a plan only together with another, done by the same robot."""
        return task.delivers is not None or task.id in self.deliverer

    @cached_property
    def has_goods(self) -> bool:
        """Whether tasks change what is on board."""
        return any(task.load is not None or task.delivers is not None for task in self.mission.tasks)

    @cached_property
    def has_energy(self) -> bool:
        """Whether robots have batteries."""
        return any(robot.battery is not None for robot in self.mission.robots)

    @cached_property
    def alternatives(self) -> dict[str, tuple[str, ...]]:
        """For each task those of which at most one is to be done, itself included, in mission order."""
        tasks = self.mission.tasks
        sets = alternatives_of(tasks) if self.holds("either-or") else [(task.id,) for task in tasks]
        return {name: names for names in sets for name in names}

    @cached_property
    def beginning_with(self) -> dict[str, list[str]]:
        """For each task those that name it in their `starts_with`."""
        named: dict[str, list[str]] = {}
        for task in self.mission.tasks:
            for name in task.starts_with:
                named.setdefault(name, []).append(task.id)
        return named

    @cached_property
    def awaited(self) -> frozenset[str]:
        """The tasks that tasks in the plan wait for."""
        return frozenset(name for route in self.routes for step in route.steps for name in step.task.prerequisites)

    @cached_property
    def has_relations(self) -> bool:
        """Whether tasks are tied by who does them."""
        return any(task.same_robot_as or task.other_robot_than or task.starts_with for task in self.mission.tasks)

    def is_subject_to(self, kind: str, is_in: Callable[[Mission], bool]) -> bool:
        """Whether anything in the mission is subject to a kind of rule; looked up once, not for each reason."""
        if kind not in self._subject_to:
            self._subject_to[kind] = is_in(self.mission)
        return self._subject_to[kind]

    @cached_property
    def _subject_to(self) -> dict[str, bool]:
        return {}

    def needs_others(self, task: Task) -> bool:
        """Whether other robots may have to work at the same time: in its team, or at a task that begins with it."""
        return bool(task.is_for_team or task.starts_with or task.id in self.beginning_with)

    @cached_property
    def has_within(self) -> bool:
        """Whether a task may begin only so long after a prerequisite."""
        return any(lag.within_s is not None for task in self.mission.tasks for lag in task.lags.values())

    @property
    def unit(self) -> str:
        """The unit of usage."""
        return "s" if self.mission.rules.usage == "time" else "m"

    @property
    def tolerance(self) -> float:
        """By how much a usage may differ from the true one, relative."""
        return max(ROUNDING, self.travel.tolerance)

    @cached_property
    def is_timed(self) -> bool:
        """Whether anything but prerequisites and capacities depends on times, teams, goods or other further rules."""
        mission = self.mission
        keys = set[str]().union(*map(timed_keys, usable_rules())).difference(_OFFERED)
        return any(one.states(key) for one in (mission.rules, *mission.robots, *mission.tasks) for key in keys)

    def holds(self, rule: str) -> bool:
        """Whether a rule holds."""
        return rule not in self.ignored

    def capacity_of(self, robot: Robot) -> float | None:
        """What the robot may use, in the unit of usage; None where it is unlimited or the rule is ignored."""
        if robot.work_capacity is None or not self.holds("capacity"):
            return None
        return (1 - self.mission.rules.capacity_reserve) * robot.work_capacity

    def insertions(self, route: MeasuredRoute) -> Insertions:
        """The gaps of a route."""
        if route.robot.id not in self._insertions:
            self._insertions[route.robot.id] = Insertions(self.mission, self.travel, route)
        return self._insertions[route.robot.id]

    @cached_property
    def _insertions(self) -> dict[str, Insertions]:
        return {}

    def first_gap(self, route: MeasuredRoute, task: Task) -> int:
        """The number of stops in a route that come before a task wherever it is put in it.

        These are the ones that must be done before a prerequisite of the task can be done.
        """
        before = self._before(task.id)
        names = enumerate((stop.place_id for stop in route.stops), 1)
        return max((k for k, name in names if name in before), default=0)

    def _before(self, task: str) -> frozenset[str]:
        """The tasks in the plan that are done before a task can begin, by prerequisites and routes."""
        if task not in self._known_before:
            found: set[str] = set()
            waiting = [task]
            while waiting:
                new = [name for name in self._predecessors.get(waiting.pop(), ()) if name not in found]
                found.update(new)
                waiting += new
            self._known_before[task] = frozenset(found)
        return self._known_before[task]

    @cached_property
    def _known_before(self) -> dict[str, frozenset[str]]:
        return {}

    @cached_property
    def _predecessors(self) -> dict[str, list[str]]:
        """For each task of the mission its prerequisites in the plan, and the task before it in its route."""
        linked = self.holds("prerequisite")
        before = {
            task.id: [name for name in task.prerequisites if linked and name in self.done]
            for task in self.mission.tasks
        }
        if self.holds("load"):
            for pickup, deliverer in self.deliverer.items():
                before[deliverer] += [pickup] if pickup in self.done else []
        for route in self.routes:
            for first, second in pairwise(route.steps):
                before[second.task.id].append(first.task.id)
        if self.holds("relation"):
            for task in self.mission.tasks:
                for name in task.starts_with:
                    shared = [*before[task.id], *before[name]]
                    before[task.id] = before[name] = shared
        return before
