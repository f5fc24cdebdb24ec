"""The best of all plans of a small mission with goods and energy, where no robot waits for another."""

from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise

from tests.carried_missions.routes import Figures, RobotRoutes


class EveryPlan:
    """The figures of all routes of each robot, and what is best of all that they make together."""

    def __init__(self, mission):
        self.mission = mission
        self.tasks = {task.id: task for task in mission.tasks}
        self.routes = [RobotRoutes(mission, robot).figures() for robot in mission.robots]

    @cached_property
    def best(self):
        """(weight, objective) of the best plan, and its routes."""
        best = 0.0, 0.0, tuple(() for _ in self.routes)
        for weight, value, orders in self._plans(0, frozenset(), (), ()):
            if (-weight, value) < (-best[0], best[1]) and self.keeps_order(orders):
                best = weight, value, orders
        return best

    def _plans(self, number, done, orders, figures):
        if number == len(self.routes):
            yield sum(self.tasks[name].priority for name in done), self.value(figures, len(done)), orders
            return
        for order, own in self._own(number):
            if done.isdisjoint(order):
                yield from self._plans(number + 1, done | frozenset(order), (*orders, order), (*figures, own))

    def _own(self, number):
        """The routes of a robot; without prerequisites only those that none with the same tasks is better than."""
        if any(task.prerequisites for task in self.mission.tasks):
            return self.routes[number].items()
        return self._shortest[number].items()

    @cached_property
    def _shortest(self):
        kept = []
        for routes in self.routes:
            best = {}
            for order, own in routes.items():
                value = self.value([own], 1)
                key = frozenset(order)
                if key not in best or value < best[key][0]:
                    best[key] = value, order, own
            kept.append({order: own for _, order, own in best.values()})
        return kept

    def value(self, figures, count):
        values = {
            "total": sum(own.usage for own in figures),
            "max": max(own.usage for own in figures),
            "total+max": sum(own.usage for own in figures) + max(own.usage for own in figures),
            "average": sum(own.arrivals for own in figures) / max(1, count),
            "makespan": max(own.ends for own in figures),
            "lateness": sum(own.late for own in figures),
        }
        return values[self.mission.rules.objective]

    def keeps_order(self, orders):
        """Whether prerequisites are done, and nothing deadlocks."""
        done = {name for order in orders for name in order}
        before = {name: set(self.tasks[name].prerequisites) for name in done}
        if not all(names <= done for names in before.values()):
            return False
        for order in orders:
            for first, then in pairwise(order):
                before[then].add(first)
        try:
            TopologicalSorter(before).prepare()
        except CycleError:
            return False
        return True

    def figures_of(self, number, order):
        """The figures of one robot's route; None where it breaks a rule."""
        return self.routes[number].get(order) if order else Figures()
