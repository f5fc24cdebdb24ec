"""One seed of the campaign: a tiny mission with rules of every kind, and all that is said of it."""

from functools import cached_property

import muster
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.bounds.of_objective import lower_bound
from muster.allocation.capabilities import those_that_can
from muster.allocation.exact import solve_exactly
from muster.allocation.remedies.conflicts import together
from muster.allocation.stop import Stop
from muster.mission.system.clock import VirtualClock
from muster.model.problem import Problem
from muster.planning.explaining.explanations import left_out, one_task
from muster.planning.judging import admits
from muster.verification import verify
from tests import trials
from tests.judged_plans import JudgedPlans
from tests.mixed_missions.missions import mixed_mission

CPU_LIMIT_S = 60.0  # of one trial, beyond which it counts as one that hangs
ITERATIONS, LONGER = 200, 5_000
MOST_JUDGED, MOST_ASKED = 1_000, 400  # sets of routes that are judged for the best plan, and for one question
EXACT_EVERY, EXACT_S = 5, 20.0
OTHERS_EVERY = 2
TOGETHER_S, READING_S = 1.0, 2e-3  # of a clock that goes on when it is read
CLOSE = 1e-6


class Report(trials.Report):
    """What is claimed of the mission of a seed, and what is wrong with it."""


def trial(seed):
    """Check all that is claimed of the mission of a seed."""
    report = Report(seed)
    mission, text = mixed_mission(seed)
    report.story.append(text)
    for part in (Trial.plans, Trial.exactly, Trial.impossible, Trial.explained):
        with report.trying():
            part(Trial.of(report, mission))
    return report


class Trial:
    """What is known of the mission of one trial."""

    def __init__(self, report, mission):
        self.report, self.mission = report, mission
        self.known = []  # values of valid plans, with these
        report.trial = self

    @classmethod
    def of(cls, report, mission):
        """Return the trial of a report, so that what one part has found is known to the next."""
        return getattr(report, "trial", None) or cls(report, mission)

    @cached_property
    def problem(self):
        return Problem.compile(self.mission)

    @cached_property
    def every(self):
        return JudgedPlans(self.mission, most=MOST_JUDGED)

    @cached_property
    def best(self):
        best = self.every.best()
        self.report.counts["missions of which not all plans are judged"] += not self.every.complete
        self.report.story.append(f"the best of all plans: {best}")
        self.known.append(((best.weight, best.objective), best.plan))
        return best.weight, best.objective

    # --- plans -------------------------------------------------------------------------------------------------------

    def plans(self):
        """Plans of allocators are valid, with their reasons, and none is better than the best."""
        found = self._plan("search", ITERATIONS)
        self._reached(found)
        able = [name for name in those_that_can(self.problem.asked) if name != "search"]
        if able and self.report.seed % OTHERS_EVERY == 0:
            self._plan(able[self.report.seed // OTHERS_EVERY % len(able)], ITERATIONS // 10)
        self._bound()

    def _plan(self, name, iterations, seed=None):
        seed = self.report.seed if seed is None else seed
        plan = muster.solve(self.mission, name, seed=seed, iterations=iterations)
        verdict = verify(self.mission, plan)
        self.report.counts["plans"] += 1
        self.report.check(verdict.valid, f"{name}: {verdict.first_violations}")
        value = verdict.weight_completed, verdict.value()
        self.report.story.append(f"{name}: {value} {[route.tasks for route in plan.routes]} {plan.unassigned}")
        if verdict.valid:
            self.known.append((value, plan))
            self._reasons(plan)
            said = plan.objective_value
            self.report.check(_near(value[1], said), f"{name} says {said}, not {value[1]}")
        is_better = _better(value, self.best)
        self.report.counts["better than the best that is enumerated"] += is_better
        exhaustive = self.every.complete and not self.mission.stations
        self.report.check(not (is_better and exhaustive), f"{name}: {value} is better than the best, {self.best}")
        return value

    def _reached(self, found):
        """How often search finds the best of all plans, at once or in one longer run."""
        if not _better(self.best, found):
            self.report.counts["search finds the best"] += 1
            return
        found = self._plan("search", LONGER, seed=1)
        missed = _better(self.best, found)
        self.report.counts["search finds the best in a longer run"] += not missed
        if missed:
            tasks = self.best[0] > found[0] + CLOSE
            self.report.counts["search misses the best"] += 1
            self.report.counts["search misses the best: tasks"] += tasks
            self.report.notes.append(f"search: {found}, but the best is {self.best}")

    def _bound(self):
        """The quick bound is not above a plan of all tasks, and is infinite only where there is none."""
        bound = lower_bound(self.problem)
        everything = sum(task.priority for task in self.mission.tasks)
        for (weight, value), _ in self.known:
            if _near(weight, everything):
                self.report.check(bound <= value + CLOSE * (1 + value), f"{value} is below the quick bound {bound}")

    def exactly(self):
        """What the exact solver proves is true."""
        if self.report.seed % EXACT_EVERY:
            return
        exact = solve_exactly(self.problem, EXACT_S, judge=admits)
        found = float(self.problem.value(exact.routes)[0]), self.problem.value(exact.routes)[1]
        self.report.counts["exact"] += 1
        self.report.counts["exact: proven"] += exact.optimal
        self.report.story.append(f"exact: {exact}")
        for value in (self.best, *(value for value, _ in self.known)):
            if exact.weight_proven:
                self.report.check(value[0] <= exact.weight + CLOSE, f"exact: no plan does more, but one is {value}")
                least = exact.lower_bound or 0.0
                same = _near(value[0], exact.weight)
                self.report.check(not same or least <= value[1] + CLOSE * (1 + least), f"exact: {value} below {least}")
            self.report.check(not (exact.optimal and _better(value, found)), f"exact: {found}, but one is {value}")

    # --- what is said of tasks ---------------------------------------------------------------------------------------

    def impossible(self):
        """No plan does a task that is said to be impossible, nor all tasks of a conflict."""
        said = {item.task for item in impossible(self.problem)}
        self.report.counts["tasks said to be impossible"] += len(said)
        self._no_plan(said, lambda done: bool(said & done), "said to be impossible")
        found = together(self.problem, admits, time_limit=TOGETHER_S, clock=VirtualClock(step_s=READING_S))
        self.report.counts["conflicts"] += found.conflict is not None
        self.report.counts["all together: unknown"] += found.unknown
        if found.conflict is not None:
            tasks = frozenset(found.conflict.tasks)
            self._no_plan(tasks, tasks.issubset, "said to be a conflict")
        self.report.counts["shortfalls"] += len(found.shortfalls)
        for short in found.shortfalls:
            tasks = frozenset((*short.tasks, *short.after))
            most = len(tasks) - short.alternatives - short.left_out
            what = f"tasks of which {short.left_out} at least are left out: {short.detail}"
            self._no_plan(tasks, lambda done, tasks=tasks, most=most: len(tasks & done) > most, what)

    def _no_plan(self, tasks, is_wrong, what):
        """Check that no plan is wrong by the set of tasks that it does."""
        if not tasks:
            return
        _ = self.best
        for _, plan in self.known:
            done = {name for route in plan.routes for name in route.tasks if name in self.every.tasks}
            self.report.check(not is_wrong(done), f"{sorted(tasks)} are {what}, but {plan.routes} does them")
        found = self.every.find(lambda orders: is_wrong(frozenset[str]().union(*orders)), MOST_ASKED)
        self.report.check(found is None, f"{sorted(tasks)} are {what}, but {found and found.routes} does them")

    def _reasons(self, plan):
        """No reason for a task left out is refuted by a plan that does it, with the rest of the plan as it is."""
        own = [tuple(name for name in route.tasks if name in self.every.tasks) for route in plan.routes]
        for item in plan.unassigned:
            added = self._with(item.task)
            for number, robot in enumerate(self.mission.robots):
                reason = next(one for one in item.reasons if one.robot == robot.id) if item.reasons else None
                missing = set(self.every.tasks[item.task].prerequisites).difference(*own)
                if reason is None or (missing and reason.reason == "prerequisite"):  # which is true as it is said
                    continue
                self.report.counts[f"reason {reason.reason}"] += 1

                def adds(orders, number=number, added=added, item=item):
                    rest = [tuple(name for name in order if name not in added) for order in orders]
                    return item.task in orders[number] and rest == own

                found = self.every.find(adds, MOST_ASKED) if reason.reason != "not-chosen" else None
                self.report.check(found is None, f"{own}: {item.task}: {reason}, but {found and found.routes}")

    def _with(self, name):
        """A task with those that can only be done with it."""
        found, waiting = {name}, [name]
        while waiting:
            one = self.every.tasks[waiting.pop()]
            tied = {other.id for other in self.mission.tasks if one.id in other.starts_with or other.delivers == one.id}
            tied.update(one.starts_with, (one.delivers,) if one.delivers else ())
            waiting += tied - found
            found |= tied
        return found

    def explained(self):
        """Explanations of what plans leave out, and of each task of the best plan, end; changes that help do help."""
        _ = self.best
        for _, plan in self.known[:2]:
            left_out(self.mission, plan, (), Stop())
        name = self.mission.tasks[self.report.seed % len(self.mission.tasks)].id
        one_task(self.mission, self.known[-1][1], name, (), Stop())


def _near(a, b):
    return abs(a - b) <= CLOSE * (1 + abs(b))


def _better(a, b):
    """Whether (weight, objective) a is better than b by more than rounding."""
    return a[0] > b[0] if not _near(a[0], b[0]) else a[1] < b[1] and not _near(a[1], b[1])
