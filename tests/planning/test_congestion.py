"""Plans for robots that share passages for one: their traffic is told, and routes spread where it costs."""

import dataclasses

import pytest

import muster
from muster.allocation.stop import Stop
from muster.generation import narrow
from muster.planning import spreading
from muster.planning.congestion import SharedPassages
from muster.planning.request import Request
from muster.planning.solving import answer


@pytest.fixture(scope="module")
def mission():
    return narrow.dead_ends("differential-drive", 1, 12)


def planned(mission, **asked):
    return answer(Request(mission=mission, iterations=1500, **asked)).plan


@pytest.mark.long
@pytest.mark.parametrize("seeds", [1, pytest.param(2, marks=pytest.mark.long)])
def test_routes_spread_and_the_plan_says_what_its_traffic_takes(mission, seeds):
    """The time with traffic is on average shorter than that of plans that know nothing of it."""
    free = [planned(mission, seed=seed, traffic="free") for seed in range(seeds)]
    assert {plan.time_with_traffic_s for plan in free} == {None}
    shared = SharedPassages.of(mission, "auto")
    of_free = [shared.told(plan).time_with_traffic_s for plan in free]
    spread = [planned(mission, seed=seed) for seed in range(seeds)]
    assert all(plan.complete and plan.time_without_traffic_s <= plan.time_with_traffic_s for plan in spread)
    assert sum(plan.time_with_traffic_s for plan in spread) < 0.95 * sum(of_free)
    assert spread[0].routes == planned(mission).routes
    assert spread[0].objective_value == pytest.approx(muster.verify(mission, spread[0]).value())


@pytest.mark.long
def test_varied_by_its_traffic_a_plan_is_better_than_those_it_comes_from(mission, monkeypatch):
    """What varies keeps the rules, and the plan tells the time that the traffic of its own routes takes."""
    monkeypatch.setattr(spreading, "VARIATIONS_BY_ITERATIONS", 200)
    varied = [planned(mission, seed=seed) for seed in range(2)]
    monkeypatch.setattr(spreading, "VARIATIONS_BY_ITERATIONS", 0)
    first = [planned(mission, seed=seed) for seed in range(2)]
    assert sum(plan.time_with_traffic_s for plan in varied) < sum(plan.time_with_traffic_s for plan in first)
    told = SharedPassages.of(mission, "auto").told(varied[0])
    assert told.time_without_traffic_s == pytest.approx(varied[0].time_without_traffic_s)
    assert told.time_with_traffic_s == pytest.approx(varied[0].time_with_traffic_s, rel=0.25)


def test_plans_of_other_allocators_are_told_alone(mission):
    plan, free = (planned(mission, allocator="greedy", traffic=traffic) for traffic in ("auto", "free"))
    assert plan.routes == free.routes
    assert plan.time_with_traffic_s >= plan.time_without_traffic_s > 0
    assert "time_with_traffic_s" not in free.as_dict()


def test_robots_that_are_in_nobodys_way_are_planned_as_without():
    alone = muster.load("market-rescue-arena")
    plan = planned(alone)
    assert plan.objective_value == planned(alone, traffic="free").objective_value
    assert plan.time_with_traffic_s == pytest.approx(plan.time_without_traffic_s)


def test_where_no_passages_are_shared_nothing_is_told():
    assert SharedPassages.of(muster.load("31T-6R50"), "auto") is None
    assert planned(muster.load("31T-6R50")).time_with_traffic_s is None


def test_interrupted_the_first_plan_is_kept(mission):
    interrupt = Stop()
    interrupt.interrupt()
    solution = answer(Request(mission=mission, time_limit=600.0), interrupt=interrupt)
    assert solution.plan.complete
    assert solution.plan.time_with_traffic_s is None


@pytest.mark.long
def test_progress_is_that_of_the_whole(mission):
    reports = []
    plan = answer(Request(mission=mission, iterations=1500), on_progress=reports.append).plan
    shares = [report.share for report in reports]
    assert all(0 <= share <= 1 for share in shares)
    assert (reports[-1].objective, reports[-1].weight) == (plan.objective_value, plan.weight_completed)


@pytest.mark.long
def test_a_plan_that_begins_with_fixed_routes_keeps_them(mission):
    first = planned(mission, allocator="greedy", traffic="free")
    fixed = dataclasses.replace(
        first, routes=tuple(dataclasses.replace(r, tasks=r.tasks[:1], stops=()) for r in first.routes), unassigned=()
    )
    plan = answer(Request(mission=mission, iterations=400, fixed=fixed)).plan
    assert [route.tasks[:1] for route in plan.routes] == [route.tasks for route in fixed.routes]
