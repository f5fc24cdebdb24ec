"""One seed of the campaign: all that must be true of a mission and of what Muster says of it."""

from dataclasses import dataclass

import muster
from muster.allocation.allocator import routes_of
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.bounds.of_objective import lower_bound
from muster.allocation.exact import solve_exactly
from muster.allocation.registry import ALLOCATORS
from muster.allocation.remedies.conflicts import together
from muster.model.problem import Problem
from muster.planning.judging import admits
from muster.verification import verify
from tests import trials
from tests.all_plans import best_plan
from tests.campaign.missions import case

ITERATIONS, MANY_ITERATIONS = 400, 20_000  # of `search`; others have a tenth of the first
LONGER_RUNS = 5
EXACT_EVERY, CONFLICTS_EVERY = (
    40,
    8,
)  # one in so many small missions is solved exactly, one in so many looked at for conflicts
OTHERS = tuple(name for name in ALLOCATORS if name != "search")


@dataclass
class Report(trials.Report):
    """The figures: how far the bound was below the best of all plans.

    `rounding` is how much judge and planner may differ, relative.
    """

    rounding: float = 0.0


def trial(seed):
    """Plan the mission of a seed and check all that is claimed."""
    report = Report(seed)
    with report.trying():
        given = case(seed)
        report.story.append(str(given.mission))
        report.rounding = given.rounding
        _run(report, given)
    return report


def _run(report, given):
    mission, seed = given.mission, report.seed
    problem = Problem.compile(mission)
    bound = lower_bound(problem)
    plan = muster.solve(mission, "search", seed=seed, iterations=ITERATIONS)
    found = _judged(report, mission, plan, bound)
    other = OTHERS[seed % len(OTHERS)]
    start = muster.solve(mission, other, seed=seed, iterations=ITERATIONS // 10)
    begun = _judged(report, mission, start, bound)
    onward = muster.solve(mission, "search", seed=seed, iterations=ITERATIONS // 10, start=start)
    after = _judged(report, mission, onward, bound)
    report.check(not _better(report, begun, after), f"search makes {begun} of {other} worse: {after}")
    _impossible(report, problem, (plan, start, onward))
    if given.small:
        _against_all_plans(report, problem, (found, begun, after), bound)
    if seed % CONFLICTS_EVERY == 0:
        _together(report, problem, (plan, start, onward))


def _judged(report, mission, plan, bound):
    """(weight, objective) by the judge; a plan that does every task is not below the bound."""
    verdict = verify(mission, plan)
    report.counts["plans"] += 1
    details = "; ".join(f"{v.kind} {v.robot} {v.task} {v.detail}" for v in verdict.violations)
    report.check(verdict.valid, f"{plan.allocator}: {details}")
    if plan.complete:
        value = verdict.value()
        report.counts["complete"] += 1
        report.check(
            bound <= value + report.rounding * (1 + value), f"{plan.allocator}: {value} is below the bound {bound}"
        )
    weights = {task.id: task.priority for task in mission.tasks}
    return sum(sorted(weights[name] for route in plan.routes for name in route.tasks)), verdict.value()


def _better(report, a, b):
    """Whether (weight, objective) a is better than b by more than rounding."""
    if abs(a[0] - b[0]) > 1e-9:
        return a[0] > b[0]
    return a[1] < b[1] - max(1e-7, report.rounding) * (1 + abs(b[1]))


def _impossible(report, problem, plans):
    never = {item.task for item in impossible(problem)}
    for plan in plans:
        done = {name for route in plan.routes for name in route.tasks}
        report.check(not done & never, f"{plan.allocator} does {done & never}, said to be impossible")


def _against_all_plans(report, problem, found, bound):
    """The bound is not above the best of all plans, and nothing that was found is better."""
    weight, value, routes = best_plan(problem)
    report.counts["small"] += 1
    for one in found:
        report.check(
            not _better(report, one, (weight, value)), f"{one} is better than the best of all plans, {weight, value}"
        )
    _reached(report, problem, (weight, value), found[0])
    if sum(map(len, routes)) == len(problem.tasks):
        report.check(
            bound <= value + report.rounding * (1 + value), f"the best of all plans, {value}, is below {bound}"
        )
        report.figures.append(1 - bound / value if value else 0.0)
        report.counts["small: the best of all plans does all tasks"] += 1
    if report.seed % EXACT_EVERY == 0:
        _exactly(report, problem, (weight, value))


def _reached(report, problem, best, found):
    """Search finds the best of all plans, if not at once then in one of a few longer runs.

    It is a heuristic: where tasks must all change robot at once one run of some thousand small missions misses it.

    Unless a travel table lacks ways: tasks that can only be done one on the way to or from the other are not put in
    one by one, so that search may miss them.
    """
    if not _better(report, best, found):
        report.counts["small: search finds the best of all plans"] += 1
        return
    runs = (
        muster.solve(problem.mission, "search", seed=report.seed + k, iterations=MANY_ITERATIONS)
        for k in range(LONGER_RUNS)
    )
    reached = any(not _better(report, best, problem.value(routes_of(problem, plan))) for plan in runs)
    report.counts["small: search finds the best of all plans in a longer run"] += reached
    report.check(reached or len(problem.travel[0]), f"search misses the best of all plans, {best}: {found}")


def _exactly(report, problem, best):
    """The exact solver finds the best of all plans, and its bound is below it."""
    exact = solve_exactly(problem, 20.0, judge=admits)
    said, value = problem.value(exact.routes), best[1]
    report.counts["exact"] += 1
    report.check(exact.optimal, f"exact: {said} is not proven optimal; the best of all plans is {best}")
    report.check(not _better(report, best, said), f"exact: {said}, but the best of all plans is {best}")
    bound = exact.lower_bound or 0.0
    report.check(
        bound <= value + report.rounding * (1 + value), f"exact: the best of all plans, {value}, is below {bound}"
    )


def _together(report, problem, plans):
    """No plan does all tasks of a conflict."""
    conflict = together(
        problem, lambda mission, plan, ignored: verify(mission, plan, ignored).valid, time_limit=0.15
    ).conflict
    if conflict is None:
        return
    report.counts["conflicts"] += 1
    for plan in plans:
        done = {name for route in plan.routes for name in route.tasks}
        report.check(not done.issuperset(conflict.tasks), f"{plan.allocator} does the conflict {conflict.tasks}")
