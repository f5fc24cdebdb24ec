"""When tasks have to end for what waits for them, and auctions that look ahead by that."""

import math
from random import Random

import pytest
from tests.muster_team.networks import agree, network
from tests.muster_team.trials.random_missions import random_mission, with_times

import muster
from muster import Mission, Robot, Rules, Task
from muster.allocation.auctions.auction import AUCTION, Parameters
from muster.allocation.auctions.latest_ends import LatestEnds
from muster.allocation.stop import Stop
from muster.mission.model import Lag
from muster.model.problem import Problem
from muster_team.negotiators.participation import plan_of


def mission_of(*tasks, robots=2, **rules):
    """Of robots at 0, 10, 20, ... on a line."""
    made = tuple(Robot(id=f"r_{k}", position=(10 * k, 0)) for k in range(robots))
    return Mission(rules=Rules(timing="constant", **rules), robots=made, tasks=tasks)


def task(name, x, **more):
    return Task(id=name, position=(x, 0), **{"duration_s": 5, **more})


def latest(*tasks, routes=((), ())):
    """The deadlines by which an auction looks ahead."""
    bound = LatestEnds(Problem.compile(mission_of(*tasks)).ready()).binding(routes)
    return [None if math.isinf(end) else end for end in bound.model.ends_by]


def test_a_task_ends_in_time_for_the_deadline_of_what_waits_for_it():
    after = task("b", 0, prerequisites=("a",), lags={"a": Lag(after_s=4)}, deadline_s=30)
    assert latest(task("a", 0), after) == [30 - 5 - 4, 30]
    assert latest(
        task("a", 0), task("b", 0, prerequisites=("a",)), task("c", 0, prerequisites=("b",), deadline_s=30)
    ) == [
        20,
        25,
        30,
    ]


def test_what_is_too_late_whenever_the_other_ends_binds_nothing():
    late = task("b", 0, prerequisites=("a",), lags={"a": Lag(after_s=6)}, deadline_s=8, robots_needed=2)
    assert latest(task("a", 0), late) == [None, 8]
    plan = muster.solve(mission_of(task("a", 0), late), "auction")
    assert [item.task for item in plan.unassigned] == ["b"]


def test_a_window_binds_when_work_begins():
    assert latest(task("a", 0), task("b", 0, prerequisites=("a",), window_s=((2, 8), (20, 22)))) == [22, 27]
    late = task("b", 0, prerequisites=("a",), window_s=((2, 8), (20, 22)), deadline_s=24)
    assert latest(task("a", 0), late) == [8, 13]


def test_what_begins_together_is_in_time_together():
    assert latest(task("a", 0), task("b", 0, starts_with=("a",), duration_s=9, deadline_s=30)) == [26, 30]


def test_nothing_is_kept_in_time_for_what_nobody_may_do():
    assert latest(task("a", 0), task("b", 0, prerequisites=("a",), requires=("wings",), deadline_s=30)) == [None, 30]
    assert latest(task("a", 0), task("b", 0, prerequisites=("a",), deadline_s=3)) == [None, 3]


def test_what_is_too_late_already_has_its_own_deadline():
    tasks = task("a", 9, duration_s=20), task("b", 0, prerequisites=("a",), deadline_s=30)
    assert latest(*tasks) == [25, 30]
    assert latest(*tasks, routes=((0,), ())) == [None, 30]
    assert latest(*tasks, routes=((), (0,))) == [25, 30]


def test_a_bid_that_leaves_time_wins_over_a_better_one():
    far = task("far", 0, duration_s=30)
    base, roof = task("base", 1, duration_s=10), task("roof", 1, prerequisites=("base",), deadline_s=27)
    mission = mission_of(far, base, roof, objective="total")
    plan = AUCTION.solve(Problem.compile(mission), Stop(), params=Parameters(placement="append"))
    assert plan.tasks_completed == 3
    assert {route.robot: route.tasks for route in plan.routes} == {"r_0": ("far",), "r_1": ("base", "roof")}


def test_all_of_the_rescue_is_sold_with_and_without_a_centre():
    problem, terms = Problem.compile(muster.load("collapsed-building")).ready(), Parameters()
    central = AUCTION.solve(problem, Stop(), params=terms)
    assert central.tasks_completed == 10
    net = network(problem, terms, delay_s=0.02)
    net.start()
    agree(net)
    assert all(plan_of(problem, node).routes == central.routes for node in net.nodes.values())


@pytest.mark.parametrize("seed", range(50))
def test_no_plan_with_all_tasks_ends_one_later(seed):
    random = Random(seed)
    mission = with_times(random_mission(random, robots=3, tasks=4, once=0.0), random)
    problem = Problem.compile(mission).ready()
    plan = muster.solve(mission, "search", iterations=60, seed=seed)
    if plan.unassigned:
        return
    bound = LatestEnds(problem).binding([[] for _ in problem.robots])
    ends = {task.id: end for task, end in zip(bound.tasks, bound.model.ends_by, strict=True)}
    for route in plan.routes:
        for stop in route.stops or ():
            assert ends[stop.name] is None or stop.end_s <= ends[stop.name] + 1e-6, stop
