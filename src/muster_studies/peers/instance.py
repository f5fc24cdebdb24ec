"""A mission as input of other solvers: the tasks that can be done, places as nodes, whole numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from muster.allocation.bounds.feasibility import impossible
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem
from muster_studies.peers.costs import Costs, time_costs, usage_costs
from muster_studies.peers.goods import Goods, goods_of, unusual_goods

Routes = Sequence[Sequence[int]]
"""For each robot the tasks of the instance, in order."""

_PRIORITY_STEPS = 100
"""Priorities that are not whole numbers, or above this, are rounded to so many steps."""


@dataclass(frozen=True, eq=False)
class Instance:
    """What a peer solves.

    Nodes are the tasks, then the starts and ends of robots, each position once. Robots stand in the problem's order;
    tasks are counted as they stand in `tasks`, which holds indices of the problem's.

    Parameters
    ----------
    complete
        whether a plan that does all tasks is known to exist.
    """

    problem: Problem
    complete: bool = False

    @cached_property
    def tasks(self) -> tuple[int, ...]:
        """Tasks that are not impossible from the outset."""
        lost = {self.problem.task_index[item.task] for item in impossible(self.problem)}
        return tuple(j for j in range(len(self.problem.tasks)) if j not in lost)

    @property
    def robot_count(self) -> int:
        return len(self.problem.robots)

    @property
    def objective(self) -> str:
        return self.problem.objective

    @cached_property
    def limited(self) -> bool:
        """Whether a robot has a capacity."""
        return bool(np.isfinite(self.problem.capacity).any())

    @cached_property
    def optional(self) -> bool:
        """Whether tasks may have to be left out. Without limits all that are possible can be done together."""
        return self.limited or self.timed or self.goods.limited

    @cached_property
    def goods(self) -> Goods:
        """What is carried."""
        return goods_of(self.problem, self.tasks)

    @cached_property
    def timed(self) -> bool:
        """Whether a task has a time window, or a robot an end of its shift."""
        return any(self.windows) or any(until is not None for until in self.available_until)

    @cached_property
    def unusual_rule(self) -> str | None:
        """A rule of the mission that no peer is given."""
        problem = self.problem
        tasks = [problem.tasks[j] for j in self.tasks]
        found = {
            "teams": any(task.robots_needed or task.team or task.needs for task in tasks),
            "relations": any(task.same_robot_as or task.other_robot_than or task.starts_with for task in tasks),
            "deadlines": any(task.deadline_s is not None for task in tasks),
            "lags": any(task.lags for task in tasks),
            "charging stations": bool(problem.stations) or any(robot.battery for robot in problem.robots),
            "goods of this kind": unusual_goods(problem, self.tasks),
            "lateness": self.objective == "lateness",
        }
        return next((rule for rule, is_there in found.items() if is_there), None)

    @cached_property
    def weights(self) -> list[int]:
        """The tasks' priorities in whole numbers; 1 where all are the same."""
        priorities = [self.problem.tasks[j].priority for j in self.tasks]
        if len({*priorities}) <= 1:
            return [1] * len(priorities)
        if all(priority.is_integer() for priority in priorities) and max(priorities) <= _PRIORITY_STEPS:
            return list(map(int, priorities))
        return [max(1, round(_PRIORITY_STEPS * priority / max(priorities))) for priority in priorities]

    @cached_property
    def allowed(self) -> npt.NDArray[np.bool_]:
        """(m, n) whether a robot may do a task."""
        return np.asarray(self.problem.allowed[:, list(self.tasks)])

    def allowed_robots(self, task: int) -> list[int]:
        return [int(i) for i in np.flatnonzero(self.allowed[:, task])]

    @cached_property
    def prerequisites(self) -> list[list[int]]:
        index = {j: k for k, j in enumerate(self.tasks)}
        return [[index[before] for before in self.problem.prerequisites[j]] for j in self.tasks]

    @cached_property
    def has_prerequisites(self) -> bool:
        return any(self.prerequisites)

    @cached_property
    def available_from(self) -> list[int]:
        """When each robot can leave, in the scale of `seconds`."""
        return [math.ceil(robot.available_from_s * self.seconds.scale) for robot in self.problem.robots]

    @cached_property
    def available_until(self) -> list[int | None]:
        """When each robot is back at the latest, in the scale of `seconds`; None: at any time."""
        return [_down(robot.available_until_s, self.seconds) for robot in self.problem.robots]

    @cached_property
    def windows(self) -> list[list[tuple[int, int | None]]]:
        """For each task when work may begin, in the scale of `seconds`; empty, and None: at any time."""
        scale = self.seconds.scale
        return [
            [(math.ceil(a * scale), _down(b, self.seconds)) for a, b in self.problem.tasks[j].window_s]
            for j in self.tasks
        ]

    @cached_property
    def _nodes(self) -> tuple[list[int], list[int], list[int]]:
        """The problem's place of each node; each robot's node of start, and of end (-1: anywhere)."""
        problem = self.problem
        tabled = len(problem.travel[0]) > 0
        places = list(self.tasks)
        known: dict[object, int] = {}

        def node(position: object, robot: str, place: int) -> int:
            key = (position, robot if tabled else "")
            if key not in known:
                known[key] = len(places)
                places.append(place)
            return known[key]

        starts: list[int] = []
        ends: list[int] = []
        for i, robot in enumerate(problem.robots):
            starts.append(node(robot.position, robot.id, problem.start(i)))
            end = robot.place_at_end(problem.mission.rules)
            ends.append(-1 if end is None else node(end, robot.id, problem.end(i)))
        return places, starts, ends

    @property
    def node_count(self) -> int:
        """Tasks, starts and ends; one more stands for anywhere."""
        return len(self._nodes[0])

    @property
    def starts(self) -> list[int]:
        return self._nodes[1]

    @property
    def ends(self) -> list[int]:
        """Each robot's node of the end; -1 where a route may end anywhere."""
        return self._nodes[2]

    @cached_property
    def ends_or_anywhere(self) -> list[int]:
        """Each robot's node of the end; the node after all others where a route may end anywhere."""
        return [self.node_count if end < 0 else end for end in self.ends]

    @cached_property
    def usage(self) -> Costs:
        """In the unit of usage."""
        return usage_costs(self.problem, self._nodes[0], len(self.tasks))

    @cached_property
    def seconds(self) -> Costs:
        """In seconds; the way to the end counts where a shift ends or the makespan includes it."""
        problem = self.problem
        shifts = any(robot.available_until_s is not None for robot in problem.robots)
        returns = shifts or problem.mission.rules.makespan_includes_return
        return time_costs(problem, self._nodes[0], len(self.tasks), to_ends=returns)

    @cached_property
    def capacity(self) -> list[int | None]:
        """The most usage of each robot, rounded down; None where unlimited."""
        return [int(c * self.usage.scale) if np.isfinite(c) else None for c in self.problem.capacity.tolist()]

    @property
    def prize(self) -> int:
        """More than all routes of any plan together use: what a task of weight 1 is worth, but no more than it must be.

        A solver that weighs prizes against penalties for routes that are too long finds no plan where prizes are huge.
        """
        limits = [limit for limit in self.capacity if limit is not None]
        return sum(limits) + 1 if len(limits) == self.robot_count else self.usage.bound

    @property
    def horizon(self) -> int:
        """A time that no plan without needless waiting reaches, in the scale of `seconds`."""
        opens = [a for windows in self.windows for a, _ in windows]
        return int(self.seconds.bound + max([*self.available_from, *opens]))

    def weight(self, routes: Routes) -> int:
        return sum(self.weights[j] for route in routes for j in route)

    def plan(self, routes: Iterable[Sequence[int]], allocator: str) -> Plan:
        """Routes as a plan, for the judge."""
        problem = self.problem
        by_robot = {
            robot.id: Route(robot.id, tuple(problem.tasks[self.tasks[k]].id for k in route))
            for robot, route in zip(problem.robots, routes, strict=True)
        }
        return Plan(
            mission=problem.mission.name,
            allocator=allocator,
            ignored=problem.ignored,
            objective=problem.objective,
            routes=tuple(by_robot[robot.id] for robot in problem.mission.robots),
        )


def _down(seconds: float | None, costs: Costs) -> int | None:
    return None if seconds is None else math.floor(seconds * costs.scale)
