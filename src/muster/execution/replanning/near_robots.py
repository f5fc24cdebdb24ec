"""Orders among many: which robots a new order is tried with, so that it costs the same however many are open.

A cheap estimate by straight ways ranks all robots; the routes of the best of them, with the order, are a part of the
mission that is planned by all rules.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from muster.execution.replanning.situation import Part
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.task_motion import place
from muster.mission.model import Robot, Task
from muster.mission.task_relations import tasks_named_by
from muster.mission.values.arrays import Floats
from muster.motion.actions import duration_of
from muster.state.task_ledger import Ledger

PART_TASKS, PART_ROBOTS, ORDER_ROBOTS = 40, 16, 4
"""An order is tried with at least two robots, until their routes have so many tasks; in a fleet of at least twice so
many robots with no more than so many, of which orders that come at once each have their share, and the last number at
least. A fleet with fewer robots, and fewer open tasks than four times so many, is planned as a whole."""


@dataclass
class NearRobots:
    """Chooses the robots that new orders are tried with.

    Parameters
    ----------
    ledger, crew
        of the executor.
    """

    ledger: Ledger
    crew: Mapping[str, RobotState]
    _known: dict[str, tuple[list[Task], Floats, Floats]] = field(default_factory=dict)  # by robot its route, as arrays

    def part(self, orders: Collection[str]) -> Part | None:
        """The part of the mission in which orders are planned; None: that would be no small one, or is not enough.

        Orders that name other tasks, or are for several robots, are planned with the whole fleet, and so are all where
        robots share stations, or a task of a route in the part is tied to one outside.
        """
        present = self._present
        if not _is_large(present) or not all(map(self._is_alone, orders)):
            return None
        most = len(present) if len(present) < 2 * PART_ROBOTS else max(ORDER_ROBOTS, PART_ROBOTS // len(orders))
        tasks = [self.ledger.tasks[order] for order in orders]
        robots = dict.fromkeys(name for task in tasks for name in self._nearest(task, present, most))
        return self._part(robots, orders)

    def around(self, routes: Mapping[str, Sequence[str]]) -> Part | None:
        """The part of the mission in which robots may get other routes: they, and those whose tasks are in these."""
        tasks = {name for route in routes.values() for name in route}
        robots = [s.robot.id for s in self._present if s.robot.id in routes or not tasks.isdisjoint(s.route)]
        return self._part(robots, ())

    @property
    def _present(self) -> list[RobotState]:
        return [state for state in self.crew.values() if not state.out]

    def _part(self, robots: Collection[str], more: Collection[str]) -> Part | None:
        """Robots with the tasks of their routes, and more; None: that is no small part, or is tied to what is not."""
        tasks = [*more, *dict.fromkeys(task for name in robots for task in self.crew[name].route)]
        named = {name for task in tasks for name in tasks_named_by(self.ledger.tasks[task])}
        present = self._present
        is_small = 2 * (len(robots) + len(tasks)) <= len(present) + _routed(present)
        if not robots or not is_small or not _is_large(present) or any(map(self.ledger.is_open, named)):
            return None
        return Part(robots, tasks)

    def _is_alone(self, order: str) -> bool:
        return not self.ledger.is_joint(order) and not tasks_named_by(self.ledger.tasks[order])

    def _nearest(self, task: Task, present: Sequence[RobotState], most: int) -> list[str]:
        """At most so many robots that may do a task and whose routes grow least by it, as far as straight ways tell.

        By turns one with the least detour, and one with the least delay: of the task, and of all that it puts off.
        """
        able = set(self.ledger.model.able(task, [state.robot for state in present]))
        states = [state for state in present if state.robot.id in able]
        if not states:
            return []
        rows = [self._row(state) for state in states]
        counts = np.array([len(lasts_s) for _, lasts_s in rows])
        first, last = np.cumsum(counts) - counts, np.cumsum(counts) - 1
        places, lasts_s = (np.concatenate(column) for column in zip(*rows, strict=True))
        places[first], lasts_s[first] = _free_at(states)
        speed = np.repeat([state.robot.speed_mps for state in states], counts)

        onward_m = np.linalg.norm(np.roll(places, -1, axis=0) - places, axis=1)
        there_m = np.linalg.norm(places - np.array(place(task.entry or task.position)), axis=1)
        detour_m = there_m + np.roll(there_m, -1) - onward_m
        detour_m[last] = there_m[last]
        onward_m[last] = 0.0
        lasts_s[1:] += (onward_m / speed)[:-1]
        ends_s = np.cumsum(lasts_s)
        ends_s -= np.repeat(ends_s[first] - lasts_s[first], counts)
        after = np.repeat(last, counts) - np.arange(len(places))
        work_s = duration_of(task) or 0.0
        late_s = ends_s + there_m / speed + after * (work_s + detour_m / speed)
        return _first_of_each(states, [np.minimum.reduceat(cost, first) for cost in (detour_m / speed, late_s)], most)

    def _row(self, state: RobotState) -> tuple[Floats, Floats]:
        """Of a robot's route (1 + n, 3) where tasks not begun are left, and (1 + n,) about how long each takes.

        The first row stands for where the robot is.
        """
        ahead = state.route[1:] if state.activity is Activity.WORKING else state.route
        tasks = [self.ledger.tasks[task] for task in ahead]
        known = self._known.get(state.robot.id)
        if known is None or known[0] != tasks:
            known = self._known[state.robot.id] = (tasks, *_route(tasks, state.robot))
        return known[1:]


def _routed(states: Sequence[RobotState]) -> int:
    """The number of tasks in the routes of robots."""
    return sum(len(state.route) for state in states)


def _is_large(present: Sequence[RobotState]) -> bool:
    """Whether a fleet is too large to be planned as a whole for each order."""
    return len(present) >= 2 * PART_ROBOTS or _routed(present) >= 4 * PART_TASKS


def _free_at(states: Sequence[RobotState]) -> tuple[Floats, Floats]:
    """(m, 3) where robots are when their work under way is done, and (m,) in how many seconds that is."""
    busy = [state.work is not None and state.activity is Activity.WORKING for state in states]
    at = [s.work.exit if s.work is not None and works else s.position for s, works in zip(states, busy, strict=True)]
    left_s = [state.work_s if works else 0.0 for state, works in zip(states, busy, strict=True)]
    return np.array([place(point) for point in at]), np.array(left_s)


def _route(tasks: Sequence[Task], robot: Robot) -> tuple[Floats, Floats]:
    places = [(0.0, 0.0, 0.0), *(place(task.exit or task.position) for task in tasks)]
    durations = [(duration_of(task), task.actuation_cost / robot.speed_mps) for task in tasks]
    lasts_s = [0.0, *(cost_s if lasts is None else lasts / robot.efficiency for lasts, cost_s in durations)]
    return np.array(places), np.array(lasts_s)


def _first_of_each(states: Sequence[RobotState], ranks: Sequence[Floats], most: int) -> list[str]:
    """The first robots of each ranking, by turns, until their routes have enough tasks, or they are the most."""
    chosen: dict[str, int] = {}
    for row in np.stack([np.argsort(rank, kind="stable") for rank in ranks], axis=1).tolist():
        for k in row:
            if len(chosen) >= most or (len(chosen) >= 2 and sum(chosen.values()) >= PART_TASKS):
                return list(chosen)
            chosen[states[k].robot.id] = len(states[k].route)
    return list(chosen)
