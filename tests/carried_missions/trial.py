"""One seed of the campaign: a small mission with goods and energy, its best plan, and all that is said of it."""

from random import Random

import muster
from muster import core
from muster.allocation.bounds.of_objective import lower_bound
from muster.allocation.exact import solve_exactly
from muster.model.problem import Problem
from muster.planning.judging import admits
from muster.verification import verify
from tests import trials
from tests.carried_missions.every_plan import EveryPlan
from tests.carried_missions.missions import carried_mission

CLOSE = 1e-7
ROUTES = 40  # of each robot that are looked at
ITERATIONS, LONGER = 300, 5000
OTHERS = ("greedy", "auction", "greedy+genetic")
EXACT_S, EXACT_EVERY = 20.0, 4


class Report(trials.Report):
    """The figures: how far the quick bound was below the best of all plans."""


def trial(seed, *, planned=True):
    """Check all that is claimed of the mission of a seed; `planned`: of plans of the allocators too."""
    report = Report(seed)
    with report.trying():
        mission = carried_mission(seed)
        report.story += [str(part) for part in (*mission.robots, *mission.tasks, *mission.stations, mission.rules)]
        tried = Trial(report, mission)
        tried.routes()
        tried.bound()
        if planned:
            tried.plans()
        if planned and seed % EXACT_EVERY == 0:
            tried.exactly()
    return report


class Trial:
    """What is known of the mission of one trial."""

    def __init__(self, report, mission):
        self.report, self.mission = report, mission
        self.problem = Problem.compile(mission)
        self.every = EveryPlan(mission)
        self.best = self.every.best
        self.random = Random(f"trial {report.seed}")
        report.story.append(f"the best of all plans: {self.best}")

    def routes(self):
        """Routes of single robots are admissible where they are, with the least usage."""
        for number in range(len(self.mission.robots)):
            known = list(self.every.routes[number])
            some = self.random.sample(known, min(ROUTES, len(known)))
            for order in {*some, *(self._changed(order) for order in some)}:
                self._route(number, order)

    def _changed(self, order):
        names = list(order)
        name = self.random.choice(self.mission.tasks).id
        if name in names:
            names.remove(name)
        else:
            names.insert(self.random.randint(0, len(names)), name)
        return tuple(names)

    def _route(self, number, order):
        figures, inspection = self.every.figures_of(number, order), self._inspected(number, order)
        if figures is not None and not self.every.keeps_order((order,)):
            figures = None
        self.report.counts["routes"] += 1
        self.report.counts["routes that keep the rules"] += figures is not None
        is_said = inspection.admissible
        self.report.check(
            is_said == (figures is not None), f"robot {number}, {order}: {figures}, but {is_said} is said"
        )
        if figures is None or not is_said:
            return
        said, true = inspection.objective, self.every.value([figures], len(order))
        self.report.check(_near(said, true), f"robot {number}, {order}: {said} is said, not {true}")

    def _inspected(self, number, order):
        routes = [[] for _ in self.problem.robots]
        own = self.problem.robot_index[self.mission.robots[number].id]
        routes[own] = [self.problem.task_index[name] for name in order]
        return core.Inspection(self.problem.core, routes)

    def bound(self):
        """The quick bound is not above the best plan of all tasks."""
        self.quick, (_, value, orders) = lower_bound(self.problem), self.best
        if self._all_done(orders):
            self.report.counts["complete"] += 1
            self.report.figures.append(1 - self.quick / value if value else 0.0)
            self.report.check(self.quick <= value + CLOSE * (1 + value), f"{value} is below the bound {self.quick}")

    def exactly(self):
        """The exact solver finds the best of all plans; its proofs and bounds are true."""
        exact = solve_exactly(self.problem, EXACT_S, judge=admits)
        weight, value = self.problem.value(exact.routes)
        self.report.counts["exact"] += 1
        self.report.counts["exact: proven"] += exact.optimal
        found = (weight, value)
        self.report.check(self._reaches(found) or not exact.optimal, f"exact: {found}, but the best is {self.best}")
        is_true = not exact.weight_proven or _near(exact.weight, self.best[0])
        self.report.check(is_true, f"exact: the weight {exact.weight} is said to be the best")
        least = exact.lower_bound or 0.0
        self.report.check(not _less(self.best[1], least), f"exact: {self.best} is below the bound {least}")

    def _all_done(self, orders):
        return sum(map(len, orders)) == len(self.mission.tasks)

    def plans(self):
        """Plans of allocators are valid, and none is better than the best."""
        for name in OTHERS:
            self._plan(name, ITERATIONS)
        found = self._plan("search", ITERATIONS)
        if not self._reaches(found):
            found = self._plan("search", LONGER)
            self.report.counts["search finds the best in a longer run"] += self._reaches(found)
            if not self._reaches(found):
                self.report.counts["search misses the best"] += 1
                self.report.counts[f"search misses the best: {self.mission.rules.objective}"] += 1
                self.report.story.append(f"search: {found}")
        else:
            self.report.counts["search finds the best"] += 1

    def _reaches(self, found):
        return _near(found[0], self.best[0]) and _near(found[1], self.best[1])

    def _plan(self, name, iterations):
        plan = muster.solve(self.mission, name, seed=self.report.seed, iterations=iterations)
        verdict = verify(self.mission, plan)
        details = "; ".join(f"{v.kind} {v.robot} {v.task} {v.detail}" for v in verdict.violations)
        self.report.counts["plans"] += 1
        self.report.check(verdict.valid, f"{name}: {details}")
        value = verdict.weight_completed, verdict.value()
        self.report.story.append(f"{name}: {value} {[route.tasks for route in plan.routes]}")
        if verdict.valid:
            self.report.check(_near(value[1], plan.objective_value), f"{name} says {plan.objective_value}, not {value}")
            better = value[0] > self.best[0] or (_near(value[0], self.best[0]) and _less(value[1], self.best[1]))
            self.report.check(not better, f"{name}: {value} is better than the best, {self.best}")
        return value


def sum_up(gaps):
    return f"mean gap of quick bounds: {100 * sum(gaps) / len(gaps):.1f} %"


def _near(a, b):
    return abs(a - b) <= CLOSE * (1 + abs(b))


def _less(a, b):
    return a < b and not _near(a, b)
