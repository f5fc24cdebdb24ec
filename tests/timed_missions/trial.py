"""One seed of the campaign: a small timed mission, every plan of it, and all that is said of it."""

from dataclasses import dataclass
from random import Random

import muster
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.bounds.of_objective import lower_bound
from muster.allocation.capabilities import those_that_can
from muster.allocation.exact import solve_exactly
from muster.allocation.reasons.explanations import unassigned
from muster.allocation.registry import ALLOCATORS
from muster.allocation.remedies.conflicts import together
from muster.allocation.remedies.remedies import remedies
from muster.mission.errors import ParameterError
from muster.mission.plan import Plan, Route
from muster.mission.system.clock import VirtualClock
from muster.model.problem import Problem
from muster.planning.judging import admits
from muster.verification import verify
from tests import trials
from tests.timed_missions.every_plan import EveryPlan
from tests.timed_missions.meaning import Meaning
from tests.timed_missions.missions import (
    further_ignored_in,
    ignored_in,
    timed_mission,
    with_further_rules,
    wrong_routes,
)
from tests.timed_missions.places import Places
from tests.timed_missions.possibilities import Possibilities
from tests.timed_missions.remedied import Remedied

FOR_ALL_RULES = ("greedy", "greedy+genetic", "auction", "search")  # but an auction takes nothing back
OTHERS = tuple(name for name in ALLOCATORS if name not in FOR_ALL_RULES)
ITERATIONS, LONGER = 200, 5000
EXACT_S = 30.0
JUDGED, MOST_PLANS = 12, 30_000
EXACT_EVERY = 2
EXPLAINED, REMEDIED = 2, 2  # plans, and tasks left out of each
TOGETHER_S, READING_S = 1.0, 1e-3  # of a clock that goes on when it is read
CLOSE = 1e-7


@dataclass
class Report(trials.Report):
    """The figures: how far the quick bound was below the best of all plans."""


def trial(seed, *, planned=True):
    """Check all that is claimed of the mission of a seed; `planned`: of plans of the allocators too."""
    report = Report(seed)
    with report.trying():
        mission, ignored = timed_mission(seed), ignored_in(seed)
        report.story += [str(part) for part in (*mission.robots, *mission.tasks, mission.rules, ignored)]
        tried = Trial(report, mission, ignored)
        tried.without_plans()
        tried.explained()
        if planned:
            tried.with_plans()
    return report


def judged_trial(seed):
    """Check the judge's verdicts on plans of the mission of a seed, in which there are the further rules."""
    report = Report(seed)
    with report.trying():
        mission, ignored = with_further_rules(timed_mission(seed), seed), further_ignored_in(seed)
        report.story += [str(part) for part in (*mission.robots, *mission.tasks, mission.rules, ignored)]
        lax = EveryPlan(Meaning(mission, ignored=(*ignored, "shift", "duty", "aboard", "either-or")), MOST_PLANS)
        Judging(report, mission, ignored).judged(lax.admissible)
    return report


class Judging:
    """The mission of one trial, and plans of it."""

    def __init__(self, report, mission, ignored):
        self.report, self.mission, self.ignored = report, mission, ignored
        self.meaning = Meaning(mission, ignored=ignored)
        self.every = EveryPlan(self.meaning, MOST_PLANS)
        self.random = Random(f"trial {report.seed}")

    def judged(self, more=()):
        """The judge accepts what the enumeration accepts, and nothing else; figures agree. Some of `more` are tried."""
        admissible = self.every.admissible
        some = self.random.sample(admissible, min(JUDGED, len(admissible)))
        wrong = [wrong_routes(self.mission, self.random) for _ in range(JUDGED)]
        wrong += self.random.sample(more, min(JUDGED, len(more)))
        for routes in (*some, *(self._mutated(routes) for routes in some), *wrong):
            faults = self.meaning.faults(routes)
            verdict = verify(self.mission, self._written(routes), self.ignored)
            said = sorted({violation.kind for violation in verdict.violations})
            self.report.counts["judged"] += 1
            self.report.counts["judged: admissible"] += not faults
            self.report.counts.update(f"judged: {kind} alone" for kind in said if len(said) == 1)
            self.report.check(verdict.valid == (not faults), f"judge: {routes}: {said}, but it breaks {faults}")
            if verdict.valid and not faults:
                self._figures(routes, verdict)

    def _figures(self, routes, verdict):
        expected = self.meaning.figures(routes)
        said = {name: verdict.value(name) for name in expected}
        wrong = {name: (said[name], value) for name, value in expected.items() if not _near(said[name], value)}
        self.report.check(not wrong, f"judge: {routes}: {wrong} (said, true)")

    def _mutated(self, routes):
        """Routes with one task taken out, put elsewhere or given to one robot more."""
        changed = [list(route) for route in routes]
        j, i = self.random.randrange(len(self.mission.tasks)), self.random.randrange(len(routes))
        kind = self.random.choice(("out", "move", "join"))
        if kind != "join":
            changed = [[k for k in route if k != j] for route in changed]
        if kind != "out" and j not in changed[i]:
            changed[i].insert(self.random.randint(0, len(changed[i])), j)
        return tuple(map(tuple, changed))

    def _written(self, routes):
        pairs = zip(self.mission.robots, routes, strict=True)
        return Plan(routes=tuple(Route(r.id, tuple(self.mission.tasks[j].id for j in route)) for r, route in pairs))


class Trial(Judging):
    """What is known of the mission of one trial."""

    def __init__(self, report, mission, ignored):
        self.problem = Problem.compile(mission, ignored=ignored)
        super().__init__(report, mission, ignored)
        self.best, self.routes = self.every.best()
        report.counts["missions with more plans than are built"] += not self.every.complete
        report.story.append(f"the best of {len(self.every.admissible)} admissible plans: {self.best} {self.routes}")

    def without_plans(self):
        """The verdicts of the judge, the quick bound, and the tasks that are said to be impossible."""
        self.judged()
        self._bound(self.problem)
        self._impossible(self.problem)

    def with_plans(self):
        """Plans of the allocators, and that of the exact solver."""
        bound = lower_bound(self.problem)
        able = those_that_can(self.problem.asked)
        found = [self._plan(name, bound, may_refuse=name not in able) for name in FOR_ALL_RULES]
        self._reached(found[-1])
        self._plan(OTHERS[self.report.seed % len(OTHERS)], bound, may_refuse=True)
        if self.report.seed % EXACT_EVERY == 0:
            self.exactly(self.problem)

    def _numbered(self, plan):
        by_robot = {route.robot: tuple(self.meaning.number[name] for name in route.tasks) for route in plan.routes}
        return tuple(by_robot[robot.id] for robot in self.mission.robots)

    def _bound(self, problem):
        """The quick bound is not above the best plan of all tasks; it is infinite only where there is none."""
        bound, (_, value, _) = lower_bound(problem), self.best
        if self._all_done(self.routes):
            holds = bound <= value + CLOSE * (1 + value)
            self.report.check(holds, f"the best of all plans, {value}, is below the quick bound {bound}")
            self.report.counts["complete"] += 1
            self.report.figures.append(1 - bound / value if value else 0.0)

    def _all_done(self, routes):
        return len({j for route in routes for j in route}) == len(self.mission.tasks)

    def _plan(self, name, bound, *, may_refuse=False):
        """The value of an allocator's plan, which the judge and the enumeration accept; none is above the best."""
        seed = self.report.seed
        try:
            plan = muster.solve(self.mission, name, seed=seed, iterations=ITERATIONS, ignore=self.ignored)
        except ParameterError as error:
            self.report.check(may_refuse, f"{name} refuses: {error}")
            self.report.counts[f"refused by {name}"] += 1
            return None
        return self._checked(name, plan, bound)

    def _checked(self, name, plan, bound):
        verdict, routes = verify(self.mission, plan, self.ignored), self._numbered(plan)
        details = "; ".join(f"{v.kind} {v.robot} {v.task} {v.detail}" for v in verdict.violations)
        faults = self.meaning.faults(routes)
        self.report.counts["plans"] += 1
        self.report.check(verdict.valid, f"{name}: {details}")
        self.report.check(not faults, f"{name}: {routes} breaks {faults}")
        if faults:
            return None
        self._reasons(routes, plan.unassigned)
        value = self.meaning.value(routes)
        self._none_is_better(name, value)
        self.report.check(_near(plan.objective_value, value[1]), f"{name}: {plan.objective_value} is said, not {value}")
        if self._all_done(routes):
            self.report.check(bound <= value[1] + CLOSE * (1 + value[1]), f"{name}: {value} is below {bound}")
        return value

    def _none_is_better(self, name, value):
        """No value is better than the best of all plans, where all were built."""
        if self.every.complete:
            self.report.check(not _better(value, self.best), f"{name}: {value} is better than the best, {self.best}")

    def _reached(self, found):
        """How often search finds the best of all plans, at once or in one longer run."""
        if found is None:
            return
        if _better(self.best, found):
            plan = muster.solve(self.mission, "search", seed=1, iterations=LONGER, ignore=self.ignored)
            found = self.meaning.value(self._numbered(plan))
            self.report.counts["search finds the best of all plans in a longer run"] += not _better(self.best, found)
            if _better(self.best, found):
                self.report.counts["search misses the best of all plans"] += 1
                self.report.story.append(f"search: {found}, but the best is {self.best} {self.routes}")
        else:
            self.report.counts["search finds the best of all plans"] += 1

    def exactly(self, problem):
        """The exact solver finds the best of all plans and proves it."""
        exact = solve_exactly(problem, EXACT_S, judge=admits)
        number = [self.meaning.number[task.id] for task in problem.tasks]
        by_robot = {r.id: [number[j] for j in one] for r, one in zip(problem.robots, exact.routes, strict=True)}
        routes = tuple(tuple(by_robot[robot.id]) for robot in self.mission.robots)
        self.report.counts["exact"] += 1
        faults = self.meaning.faults(routes)
        self.report.check(not faults, f"exact: {routes} breaks {faults}")
        value = self.meaning.value(routes) if not faults else None
        self.report.check(exact.optimal, f"exact: {value} is not proven; the best of all plans is {self.best}")
        if value is not None:
            self.report.check(not _better(self.best, value), f"exact: {value}, but the best is {self.best}")
            self._none_is_better("exact", value)
        least = exact.lower_bound or 0.0
        self.report.check(least <= self.best[1] + CLOSE * (1 + least), f"exact: {self.best} is below the bound {least}")

    def _impossible(self, problem):
        """What is said of tasks that no plan does, alone and together, is true."""
        if not self.every.complete:
            return
        said, possible = impossible(problem), Possibilities(self.mission, self.ignored, self.every)
        clock = VirtualClock(step_s=READING_S)
        found = together(problem, admits, time_limit=TOGETHER_S, clock=clock)
        done = frozenset[int]().union(*self.every.done())
        self.report.counts["tasks that no plan does"] += len(self.mission.tasks) - len(done)
        self.report.counts["tasks said to be impossible"] += len(said)
        self.report.counts["conflicts"] += found.conflict is not None
        self.report.counts["conflicts: smallest ones"] += found.conflict is not None and found.conflict.minimal
        self.report.counts["all together: unknown"] += found.unknown
        self._none(f"alone: {wrong}" for wrong in possible.wrong_alone(said))
        self._none(f"together: {wrong}" for wrong in possible.wrong_together(found, {item.task for item in said}))

    def _none(self, wrong):
        """Nothing is wrong."""
        found = list(wrong)
        self.report.counts["checks"] += 1
        self.report.failures += found

    def explained(self):
        """The reasons for tasks left out of some admissible plans are true, and remedies keep what they promise."""
        admissible = self.every.admissible
        for routes in self.random.sample(admissible, min(EXPLAINED, len(admissible))):
            self._reasons(routes, unassigned(self.problem, self._compiled(routes)))
            missing = [j for j in range(len(self.mission.tasks)) if not any(j in route for route in routes)]
            for j in self.random.sample(missing, min(REMEDIED, len(missing))):
                self._remedies(routes, j)

    def _compiled(self, routes):
        """Routes as those of the problem."""
        index, compiled = self.problem.task_index, [[] for _ in routes]
        for robot, route in zip(self.mission.robots, routes, strict=True):
            compiled[self.problem.robot_index[robot.id]] = [index[self.mission.tasks[j].id] for j in route]
        return compiled

    def _reasons(self, routes, left_out):
        """Each reason is true in the plan, and what it names; the judge refuses none of them."""
        robot = {robot.id: i for i, robot in enumerate(self.mission.robots)}
        for item in left_out:
            for one in item.reasons:
                places = Places(self.mission, self.ignored, routes, robot[one.robot], self.meaning.number[item.task])
                self.report.counts[f"reason {one.reason}"] += 1
                said = f"{routes}: {item.task} {one}"
                self.report.check(places.is_true(one.reason), f"{said}: a false reason")
                self.report.check(places.sentence_holds(one.reason, one.detail), f"{said}: a false sentence")

    def _remedies(self, routes, j):
        index = self.problem.task_index[self.mission.tasks[j].id]
        for i, remedy in enumerate(remedies(self.problem, self._compiled(routes), index, admits)):
            self.report.counts["remedies"] += 1
            self.report.counts["remedies: a plan was found"] += remedy.enough
            wrong = Remedied(self.mission, self.ignored, routes, i, j, remedy).wrong()
            self._none(f"remedy: {routes}, robot {i}, task {j}: {one}" for one in wrong)


def _near(a, b):
    return abs(a - b) <= CLOSE * (1 + abs(b))


def _better(a, b):
    """Whether (weight, objective, tie) a is better than b by more than rounding."""
    for higher, x, y in zip((True, False, False), a, b, strict=True):
        if not _near(x, y):
            return (x > y) == higher
    return False
