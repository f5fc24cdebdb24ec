"""The best plans of tiny missions by trying all: against plans found by hand, and every plan without stations."""

from dataclasses import replace

import pytest
from tests.carry_charge import battery, charger, depot, mission, robot, swapper, task
from tests.judged_plans import best_plan
from tests.random_carry_charge import random_mission, random_plan
from tests.timed_missions.every_plan import EveryPlan
from tests.timed_missions.meaning import Meaning

from muster.verification import verify


def routes(found):
    return {route.robot: " ".join(route.tasks) for route in found.plan.routes}


def test_a_robot_charges_once_where_it_has_to():
    given = mission([robot(battery=battery(10))], [task("a", 6), task("b", 12)], [charger(x=7), charger("far", -2)])
    found = best_plan(given)
    assert (found.weight, found.objective, routes(found)) == (2, 24, {"r": "a dock b"})


def test_a_robot_unloads_between_two_trips():
    tasks = [task("a", 2, load=2), task("b", 3, load=2), task("c", 4, load=2)]
    found = best_plan(mission([robot(load_capacity=4)], tasks, [depot(x=3)], objective="total"))
    assert (found.weight, found.objective, routes(found)) == (3, 4, {"r": "a b depot c"})


def test_a_pair_goes_to_the_robot_that_can_carry_it():
    tasks = [task("p", 1, load=3), task("d", 5, delivers="p"), task("e", 9)]
    given = mission([robot("r", load_capacity=2), robot("s", x=8, load_capacity=3)], tasks, objective="total")
    found = best_plan(given)
    assert (found.weight, found.objective, routes(found)) == (3, 1 + 8 + 4, {"r": "", "s": "e p d"})


def test_where_times_count_no_more_is_charged_than_is_needed():
    given = mission(
        [robot(battery=battery(20, at_start=0.5))], [task("a", 14)], [charger(x=4, rate=0.5)], objective="makespan"
    )
    found = best_plan(given)
    assert found.objective == 4 + 4 / 0.5 + 10
    assert found.plan.routes[0].stops[0].charged == 4


def test_where_times_count_who_is_in_a_hurry_is_served_first():
    """Both arrive at once; s has the longer way after it."""
    robots = [robot("r", battery=battery(20, at_start=0)), robot("s", battery=battery(20, at_start=0))]
    tasks = [task("a", 2, only_robots=("r",)), task("b", 20, only_robots=("s",))]
    given = mission(robots, tasks, [swapper(swap_s=10)], objective="makespan")
    found = best_plan(given)
    assert (found.weight, found.objective) == (2, 30)


@pytest.mark.parametrize("seed", range(12))
def test_without_goods_and_energy_it_is_the_best_of_every_plan(seed):
    given = random_mission(seed, tasks=3, robots=2, stations=0)
    given = replace(
        given,
        robots=tuple(replace(one, battery=None, load_capacity=None, load_at_start=None) for one in given.robots),
        tasks=tuple(replace(one, load=None, delivers=None) for one in given.tasks),
    )
    value, _ = EveryPlan(Meaning(given)).best()
    found = best_plan(given)
    assert (found.weight, found.objective) == pytest.approx(value[:2])


@pytest.mark.parametrize("seed", [1, 2, 8, *(pytest.param(k, marks=pytest.mark.long) for k in (3, 5, 6, 7, 10))])
def test_no_valid_plan_is_better(seed):
    given = random_mission(seed, tasks=3, robots=2, stations=2)
    found = best_plan(given)
    assert verify(given, found.plan).valid
    for k in range(300):
        verdict = verify(given, random_plan(given, k))
        if verdict.valid:
            assert verdict.weight_completed <= found.weight
            assert verdict.weight_completed < found.weight or verdict.value() >= found.objective - 1e-9
