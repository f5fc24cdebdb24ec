"""Every plan of a small mission, by building them all."""

import math
from itertools import permutations

from muster import core
from muster.model.problem import Problem
from muster.verification.measure import all_measured
from muster.verification.travel import Travel

ROUNDING = 1e-9


class AllPlans:
    """Every plan of a small mission that keeps prerequisites and waits in no circle, each built in an order of time."""

    def __init__(self, mission, unlimited=None):
        """`unlimited` names a robot whose capacity is looked away from."""
        self.mission = mission
        self.problem = Problem.compile(mission)
        self._travel = Travel(mission)
        self._unlimited = unlimited
        self._usages = {}
        self.plans = set()
        self._build(tuple(() for _ in mission.robots))

    def usage(self, k, route):
        """Usage of the robot at place k of the mission; inf if it may not do that or there is no way."""
        if (k, route) not in self._usages:
            robot = self.mission.robots[k]
            i, tasks = self.problem.robot_index[robot.id], self.problem.task_index
            by_id = {task.id: task for task in self.mission.tasks}
            legs = all_measured(self.mission, self._travel, {robot.id: [by_id[name] for name in route]})[k]
            ways = [step.leg for step in legs.steps] + ([legs.last_leg] if legs.last_leg else [])
            allowed = all(self.problem.refusal(i, tasks[name]) is None for name in route)
            usage = legs.usage if allowed and all(way.exists for way in ways) else math.inf
            self._usages[k, route] = usage
        return self._usages[k, route]

    def fits(self, k, route):
        robot = self.mission.robots[k]
        if robot.id == self._unlimited or robot.work_capacity is None:
            return self.usage(k, route) < math.inf
        capacity = (1 - self.mission.rules.capacity_reserve) * robot.work_capacity
        return self.usage(k, route) <= capacity * (1 + ROUNDING)

    def _build(self, routes):
        if routes in self.plans:
            return
        self.plans.add(routes)
        done = {name for route in routes for name in route}
        for task in self.mission.tasks:
            if task.id in done or not done.issuperset(task.prerequisites):
                continue
            for k in range(len(routes)):
                self._build((*routes[:k], (*routes[k], task.id), *routes[k + 1 :]))

    def admissible(self):
        return (plan for plan in self.plans if all(self.fits(k, route) for k, route in enumerate(plan)))

    def sets(self):
        """The sets of tasks that admissible plans do."""
        return {frozenset(name for route in plan for name in route) for plan in self.admissible()}


def best_plan(problem):
    """(weight, objective, routes) of the best of all admissible plans that begin as the problem wants it."""
    tasks, robots = range(len(problem.tasks)), range(len(problem.robots))

    def plans(left, i):
        if i == len(robots):
            yield []
            return
        mine = [j for j in left if problem.allowed[i, j]]
        for size in range(len(mine) + 1):
            for route in permutations(mine, size):
                if tuple(route[: len(problem.beginning(i))]) != problem.beginning(i):
                    continue
                for others in plans([j for j in left if j not in route], i + 1):
                    yield [list(route), *others]

    def rank(routes):
        weight, objective = problem.value(routes)
        return -weight, objective

    admissible = (routes for routes in plans(list(tasks), 0) if core.Inspection(problem.core, routes).admissible)
    best = min(admissible, key=rank)
    return *problem.value(best), best
