"""Goods, batteries and stations against a second judge that lets the robots live through their routes."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.carry_charge import stating
from tests.random_carry_charge import random_mission, random_plan
from tests.verification.ticking_judge import TickingJudge

from muster.mission.model import Lag
from muster.mission.reading.plan_reader import read_plan
from muster.verification import verify

seeds = st.integers(0, 10**6)


def close(found, expected):
    return found is None if expected is None else found == pytest.approx(expected, abs=1e-9)


@given(seeds, seeds, st.booleans())
def test_the_second_judge_finds_the_same(mission_seed, plan_seed, stated):
    mission = random_mission(mission_seed)
    plan = random_plan(mission, plan_seed, stated=stated)
    verdict, slow = verify(mission, plan), TickingJudge(mission, plan)
    kinds = {fault.kind for fault in verdict.violations}
    if slow.deadlocked:
        assert "deadlock" in kinds
        return
    assert "deadlock" not in kinds
    for route, life in zip(verdict.routes, slow.lives, strict=True):
        assert route.usage == pytest.approx(life.usage)
        assert [stop.name for stop in route.stops] == [stop[0] for stop in life.stops]
        for stop, (_, arrives, starts, ends, before, after, load) in zip(route.stops, life.stops, strict=True):
            assert (stop.arrives_s, stop.starts_s, stop.ends_s) == pytest.approx((arrives, starts, ends))
            assert close(stop.arrival_level, before)
            assert close(stop.level_after, after)
            assert stop.load_after == pytest.approx(load)
    found = {(fault.kind, fault.robot) for fault in verdict.violations if fault.kind in ("load", "battery")}
    assert found == slow.broken


@given(seeds, seeds)
def test_a_plan_that_states_its_stops_means_what_it_meant_without(mission_seed, plan_seed):
    mission = random_mission(mission_seed, robots=3)
    plan = random_plan(mission, plan_seed)
    bare = verify(mission, plan)
    if bare.makespan_s is None:
        return
    for charged in (False, True):
        stated = verify(mission, stating(mission, plan, charged=charged))
        assert stated.violations == bare.violations
        for one, other in zip(stated.routes, bare.routes, strict=True):
            for a, b in zip(one.stops, other.stops, strict=True):
                assert (a.starts_s, a.ends_s) == pytest.approx((b.starts_s, b.ends_s))


@given(seeds, seeds, st.sampled_from(["load", "battery"]))
def test_what_is_ignored_is_not_found_and_changes_nothing_else(mission_seed, plan_seed, word):
    mission = random_mission(mission_seed)
    plan = random_plan(mission, plan_seed)
    strict, lax = verify(mission, plan), verify(mission, plan, word)
    assert [fault for fault in strict.violations if fault.kind != word] == list(lax.violations)
    assert strict.routes == lax.routes


@given(seeds, seeds, st.randoms(use_true_random=False))
def test_the_order_of_routes_tasks_and_stations_changes_nothing(mission_seed, plan_seed, random):
    mission = random_mission(mission_seed, robots=3)
    plan = random_plan(mission, plan_seed)
    robots, tasks, stations, routes = (
        list(some) for some in (mission.robots, mission.tasks, mission.stations, plan.routes)
    )
    for items in (robots, tasks, stations, routes):
        random.shuffle(items)
    mixed = replace(mission, robots=tuple(robots), tasks=tuple(tasks), stations=tuple(stations))
    before, after = verify(mission, plan), verify(mixed, replace(plan, routes=tuple(routes)))
    assert {route.robot: route for route in before.routes} == {route.robot: route for route in after.routes}
    key = [(fault.kind, fault.robot or "", fault.task or "") for fault in before.violations if fault.kind != "deadlock"]
    other = [
        (fault.kind, fault.robot or "", fault.task or "") for fault in after.violations if fault.kind != "deadlock"
    ]
    assert sorted(key) == sorted(other)


def test_a_random_plan_with_stations_survives_its_file(tmp_path):
    @given(seeds, seeds)
    def survives(mission_seed, plan_seed):
        mission = random_mission(mission_seed)
        stated = stating(mission, random_plan(mission, plan_seed), charged=True)
        stated.save(tmp_path / "plan.json")
        assert read_plan(tmp_path / "plan.json").routes == stated.routes

    survives()


def with_lags(mission, random):
    """Every prerequisite of a mission with a greatest lag, and some more of them."""
    tasks = []
    for k, task in enumerate(mission.tasks):
        names = task.prerequisites or ((mission.tasks[k - 1].id,) if k and random.random() < 0.5 else ())
        lags = {name: Lag(after_s=random.choice((0, 2)), within_s=random.choice((2, 5, 20))) for name in names}
        tasks.append(replace(task, prerequisites=names, lags=lags))
    return replace(mission, tasks=tuple(tasks))


@given(seeds, seeds, st.booleans(), st.randoms(use_true_random=False))
def test_a_schedule_with_lags_keeps_slots_orders_and_lags(mission_seed, plan_seed, stated, random):
    mission = with_lags(random_mission(mission_seed, robots=3), random)
    plan = random_plan(mission, plan_seed, stated=stated)
    verdict = verify(mission, plan)
    if verdict.makespan_s is None:
        return
    ends = {visit.task: visit.ends_s for route in verdict.routes for visit in route.visits}
    begins = {visit.task: visit.starts_s for route in verdict.routes for visit in route.visits}
    for task in mission.tasks:
        for name, lag in task.lags.items():
            if task.id in begins and name in ends:
                assert ends[name] + lag.after_s <= begins[task.id] + 1e-6
                assert begins[task.id] <= ends[name] + lag.within_s + 1e-6
    for station in mission.stations:
        visits = [(s, r.robot) for r in verdict.routes for s in r.stops if s.name == station.id]
        for visit, _ in visits:
            served = [s for s, _ in visits if s.starts_s <= visit.starts_s < s.ends_s]
            assert len(served) <= station.slots
        if not stated:
            by_arrival = sorted(visits, key=lambda one: (one[0].arrives_s, one[1]))
            assert [s.starts_s for s, _ in by_arrival] == sorted(s.starts_s for s, _ in visits)
