"""A planning request is answered by a plan that was rewired, bounded and judged as it asks."""

import dataclasses

import pytest

import muster
from muster.allocation.algorithms.greedy import GREEDY
from muster.allocation.allocator import Allocator, Outcome
from muster.allocation.stop import Stop
from muster.mission.errors import MusterError, ParameterError
from muster.planning.options import PlanningOptions, options_from
from muster.planning.request import Request
from muster.planning.solving import answer


@dataclasses.dataclass(frozen=True, kw_only=True)
class NoParameters:
    """Of an algorithm without parameters."""


def all_tasks_for_the_first_robot(problem, stop, seed, params, start):
    return Outcome([list(range(len(problem.tasks))), *([] for _ in problem.robots[1:])])


CARELESS = Allocator(
    name="careless",
    summary="gives all tasks to the first robot",
    anytime=False,
    parameters=NoParameters,
    algorithm=all_tasks_for_the_first_robot,
)


@pytest.fixture(scope="module")
def mission():
    return muster.load("31T-6R50")


def test_no_plan_that_the_judge_rejects_is_given(mission):
    for solve in (
        lambda: answer(Request(mission=mission, allocator=CARELESS)),
        lambda: muster.solve(mission, CARELESS),
    ):
        with pytest.raises(MusterError, match=r"^allocator careless: the judge rejects its plan: suitability "):
            solve()
    shipped = dataclasses.replace(CARELESS, name="greedy")
    with pytest.raises(MusterError, match=r"^internal error: allocator greedy: the judge rejects its plan: "):
        muster.solve(mission, shipped)


def test_an_allocator_stands_for_its_name(mission):
    assert muster.solve(mission, GREEDY).routes == muster.solve(mission, "greedy").routes


def test_rewired_robots_wait_less(mission):
    plain, rewired = (answer(Request(mission=mission, iterations=2000, rewire=rewire)) for rewire in (False, True))
    assert rewired.verdict.waiting_s < plain.verdict.waiting_s
    assert rewired.plan.routes == muster.solve(mission, iterations=2000, rewire=True).routes


def test_a_solution_has_the_verdict_and_the_reason_of_the_bound():
    mission = muster.load("eil51-5")
    solution = answer(Request(mission=mission, allocator="greedy", bound="quick"))
    assert solution.verdict.valid
    assert 0 < solution.plan.lower_bound <= solution.verdict.value()
    assert solution.why
    assert answer(Request(mission=mission, allocator="greedy")).why == ""


def test_an_interrupted_request_keeps_its_plan_without_a_bound(mission):
    interrupt = Stop()
    interrupt.interrupt()
    solution = answer(Request(mission=mission, time_limit=600.0, bound="quick", rewire=True), interrupt=interrupt)
    assert solution.interrupted
    assert solution.plan.tasks_completed > 0
    assert (solution.plan.lower_bound, solution.why) == (None, "planning was stopped before a bound was proven")


def test_progress_has_the_bound_and_a_share(mission):
    reports = []
    request = Request(mission=mission, iterations=500, bound="quick")
    plan = answer(request, on_progress=reports.append).plan
    assert reports
    shares = [report.share for report in reports if report.share]
    assert shares == sorted(shares)
    assert all(0 < share <= 1 for share in shares)
    assert {report.bound for report in reports} <= {None, plan.lower_bound}


def test_fixed_routes_stay(mission):
    first = muster.solve(mission, "greedy")
    fixed = dataclasses.replace(
        first, routes=tuple(dataclasses.replace(r, tasks=r.tasks[:1]) for r in first.routes), unassigned=(), book=None
    )
    plan = muster.solve(mission, iterations=50, fixed=fixed)
    for route, beginning in zip(plan.routes, fixed.routes, strict=True):
        assert route.tasks[: len(beginning.tasks)] == beginning.tasks


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"mission": "31T-6R50"}, 'mission: "31T-6R50"; expected a Mission'),
        ({"start": {"routes": []}}, "start: .*; expected a Plan"),
        ({"fixed": 3}, "fixed: 3; expected a Plan"),
        ({"allocator": 3}, "allocator: 3; expected a name"),
        ({"parameters": [1]}, r"parameters: \[1\]; expected names and values"),
        ({"time_limit": float("nan")}, "time_limit: nan; expected seconds, at least 0"),
        ({"time_limit": True}, "time_limit: true; expected seconds"),
        ({"iterations": 1.5}, "iterations: 1.5; expected a whole number"),
        ({"bound": "exat"}, "bound: \"exat\"; expected quick or exact; did you mean 'exact'?"),
        ({"objective": "totl"}, "objective: \"totl\"; expected .*; did you mean 'total'?"),
        ({"ignore": "capacity"}, 'ignore: "capacity"; expected a list of'),
        ({"rewire": 1}, "rewire: 1; expected true or false"),
    ],
)
def test_a_request_is_checked_when_it_is_made(mission, wrong, message):
    with pytest.raises(ParameterError, match=f"^{message}"):
        Request(**({"mission": mission} | wrong))


def test_options_from_plain_data():
    assert options_from({"seed": 3, "objective": None}) == PlanningOptions(seed=3)
    with pytest.raises(ParameterError, match=r'"tme_limit": unknown; expected .*; did you mean .time_limit.'):
        options_from({"tme_limit": 1})
