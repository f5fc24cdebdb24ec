"""The bounds against the best of all plans of small missions, and on missions whose best plan is known."""

import math
import re
from dataclasses import replace
from random import Random

import numpy as np
import pytest
from tests.all_plans import best_plan
from tests.random_missions import TYPES, random_mission

import muster
from muster import Mission, Robot, Rules, Task, core
from muster.allocation.bounds.arrival_bounds import least_arrivals
from muster.allocation.bounds.arrival_paths import least_arrivals_on_paths
from muster.allocation.bounds.easier_problems import opened
from muster.allocation.bounds.of_objective import WHY, best_bound, lower_bound
from muster.allocation.bounds.spanning import Ways, route_bounds
from muster.allocation.bounds.weighed_shares import far_shares, weighed_shares
from muster.mission.model import OBJECTIVES, TravelTable
from muster.model.problem import Problem

ROUNDING = 1e-9


def forgiving(seed, **rules):
    """A random mission of 4 or 5 tasks in which all tasks can often be done."""
    tasks = 4 + seed % 2
    mission = random_mission(seed, tasks=tasks, robots=2 + (seed // 2) % 2 if tasks == 4 else 2, **rules)
    return replace(
        mission,
        suitability=mission.suitability if seed % 5 == 0 else None,
        tasks=tuple(replace(task, requires=task.requires if seed % 3 == 0 else ()) for task in mission.tasks),
    )


def by_table(seed):
    """A mission by travel tables that are asymmetric, break the triangle inequality, and lack some ways."""
    random, mission = Random(seed), forgiving(seed, return_to_start=seed % 2 == 0)
    places = tuple(one.id for one in (*mission.robots, *mission.tasks))

    def metres():
        return math.inf if random.random() < 0.1 else random.choice((0, 1, random.uniform(0, 20), 30))

    tables = {kind: TravelTable(places, tuple(tuple(metres() for _ in places) for _ in places)) for kind in TYPES}
    return replace(
        mission,
        rules=replace(mission.rules, travel="matrix"),
        robots=tuple(replace(robot, end_position=None) for robot in mission.robots),
        tasks=tuple(replace(task, entry=None, exit=None) for task in mission.tasks),
        travel={kind: f"{kind}.csv" for kind in TYPES},
        travel_tables=tables,
    )


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("make", [forgiving, by_table])
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_no_plan_that_does_every_task_is_below_the_bound(make, objective):
    complete = gap = 0
    for seed in range(10):
        problem = Problem.compile(make(seed), objective)
        _, value, routes = best_plan(problem)
        bound = lower_bound(problem)
        if sum(map(len, routes)) == len(problem.tasks):
            complete += 1
            assert bound <= value * (1 + ROUNDING) + ROUNDING, (seed, bound, value)
            gap += 1 - bound / value if value else 0
    assert complete >= 5
    assert gap / complete < 0.7  # a bound that is always 0 is none


@pytest.mark.long(keep=10)
@pytest.mark.parametrize("seed", range(40))
def test_route_bounds_hold_for_each_number_of_routes_and_for_weighted_robots(seed):
    random = Random(seed)
    problem = Problem.compile((by_table if seed % 2 else forgiving)(seed), "total", ("capacity", "prerequisites"))
    weights = np.array([random.choice((0.0, 0.5, 1.0, 2.0)) for _ in problem.robots])
    if not problem.allowed.any(axis=0).all():
        return
    bounds = route_bounds(Ways.of(problem, problem.allowed, weights), np.asarray)
    weighed, far = weighed_shares(problem, problem.allowed), far_shares(problem, problem.allowed)
    shares = np.maximum(np.broadcast_to(weighed, bounds.shape), far)
    tasks = list(range(len(problem.tasks)))
    for _ in range(200):
        routes = [[] for _ in problem.robots]
        for j in random.sample(tasks, len(tasks)):
            routes[random.choice(np.flatnonzero(problem.allowed[:, j]).tolist())].append(j)
        usages = np.array(core.Inspection(problem.core, routes).usages)
        used = sum(bool(route) for route in routes)
        if np.isfinite(usages).all():
            assert bounds[used - 1] <= usages @ weights * (1 + ROUNDING) + ROUNDING
            assert shares[used - 1] <= usages.max() * (1 + ROUNDING) + ROUNDING


@pytest.mark.long(keep=20)
@pytest.mark.parametrize("merged", [False, True])
@pytest.mark.parametrize("seed", range(40))
def test_no_routes_have_a_lower_sum_of_arrivals_than_forests_and_paths(seed, merged, monkeypatch):
    if merged:
        monkeypatch.setattr("muster.allocation.bounds.arrival_paths._EFFORT", 9 * 9 * 9 * 30)
    random = Random(seed)
    ignored = ("capacity", "prerequisites")
    mission = random_mission(seed, tasks=9, robots=3, return_to_start=False) if seed % 2 else by_table(seed)
    problem = opened(Problem.compile(mission, "average", ignored))
    if not problem.allowed.any(axis=0).all():
        return
    robots, tasks = problem.allowed.any(axis=1).sum(), list(range(len(problem.tasks)))
    forests = least_arrivals(Ways.of(problem, problem.allowed, with_surplus=False), robots)
    least = max(forests, least_arrivals_on_paths(problem, problem.allowed, forests))
    for _ in range(200):
        routes = [[] for _ in problem.robots]
        for j in random.sample(tasks, len(tasks)):
            routes[random.choice(np.flatnonzero(problem.allowed[:, j]).tolist())].append(j)
        arrivals = problem.value(routes)[1] * len(tasks)
        assert least <= arrivals * (1 + ROUNDING) + ROUNDING


def test_forests_tell_what_nearest_neighbours_do_not():
    """Pairs of tasks that are close, and far from the next pair: a forest has to join the pairs, too."""
    places = [(10.0 * pair + off, 0.0) for pair in range(1, 6) for off in (0.0, 1.0)]
    mission = Mission(
        rules=Rules(objective="average"),
        robots=(Robot(id="r", position=(0, 0)),),
        tasks=tuple(Task(id=str(k), position=place) for k, place in enumerate(places)),
    )
    problem = Problem.compile(mission)
    bound, best = best_bound(problem), problem.value([list(range(10))])[1]
    assert bound.value == pytest.approx(best)  # all lie on one line
    ways = Ways.of(problem, problem.allowed)
    nearest = np.sort(ways.entering(after_work=True))[::-1] @ np.arange(1, 11)
    assert 1.2 * nearest < least_arrivals(ways, 1) <= 10 * best * (1 + ROUNDING)


def test_prices_do_not_run_away_where_paths_are_a_plan():
    """Three tasks whose cheapest path soon is the best route: steps to better prices would be of any length."""
    mission = Mission(
        rules=Rules(objective="average", usage="time"),
        robots=(Robot(id="r", position=(6.61, 0.998)),),
        tasks=tuple(
            Task(id=str(k), position=place, duration_s=seconds)
            for k, (place, seconds) in enumerate([((-8.575, 4.674), 3.1), ((9.205, -5.46), 4.5), ((2.346, 2.919), 3.1)])
        ),
    )
    problem = Problem.compile(mission)
    bound = least_arrivals_on_paths(problem, problem.allowed, 0.0)
    assert bound <= 3 * best_plan(problem)[1] * (1 + ROUNDING)


def test_paths_tell_nearly_all_of_what_clusters_far_apart_cost():
    """Two robots between two clusters of tasks: each takes one of them, along a line."""
    places = [(side * (50.0 + k), 0.0) for side in (-1, 1) for k in range(6)]
    mission = Mission(
        rules=Rules(objective="average"),
        robots=tuple(Robot(id=f"r_{k}", position=(0, 0)) for k in range(2)),
        tasks=tuple(Task(id=str(k), position=place, actuation_cost=5.0) for k, place in enumerate(places)),
    )
    problem = Problem.compile(mission)
    _, best = problem.value([list(range(6)), list(range(6, 12))])
    assert 0.95 * best < least_arrivals_on_paths(problem, problem.allowed, 0.0) / 12 <= best * (1 + ROUNDING)


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_a_bound_that_was_cut_short_holds_and_says_so(objective):
    problem = Problem.compile(muster.load("31T-6R50"), objective)
    whole, looks = best_bound(problem), iter(range(10**9))
    cut = best_bound(problem, lambda: next(looks) > 40)
    assert (whole.cut_short, cut.cut_short) == (False, objective != "lateness")
    assert 0 <= cut.value <= whole.value


def test_where_every_robot_has_a_route_its_start_is_left():
    """One robot far away: for the greatest usage it has to have a route, or the other one does all."""
    mission = Mission(
        rules=Rules(objective="max"),
        robots=(Robot(id="near", position=(0, 0)), Robot(id="far", position=(60, 0))),
        tasks=tuple(Task(id=str(k), position=(float(k), 0.0), actuation_cost=20.0) for k in range(1, 9)),
    )
    problem = Problem.compile(mission)
    bounds = route_bounds(Ways.of(problem, problem.allowed), lambda totals: totals / (1, 2))
    assert bounds[0] == pytest.approx(168.0)
    assert bounds[1] == pytest.approx(160.0 + 52.0 + 7.0 - 1.0, abs=2.0)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(("objective", "seconds"), [("makespan", 5.0), ("max", 0.0), ("max", 5.0)])
def test_slow_robots_help_no_more_than_they_can(objective, seconds):
    """Two robots on a lattice, one of them three times as fast: in a time they do a number of tasks between them."""
    mission = Mission(
        rules=Rules(objective=objective, usage="time"),
        robots=tuple(Robot(id=f"r_{speed}", position=(0, -10), speed_mps=speed) for speed in (1, 3)),
        tasks=tuple(Task(id=str(k), position=(10 * (k // 6), 10 * (k % 6)), duration_s=seconds) for k in range(36)),
    )
    bound = best_bound(Problem.compile(mission))
    shared = 36 / (1 / (10 + seconds) + 3 / (10 + 3 * seconds))
    assert bound.arguments == ("a weighed share",)
    assert bound.value > 0.97 * shared


def test_tasks_far_away_tell_what_tasks_at_hand_hide():
    """With a task at hand for each robot but one, that one seems to do all the others in one round."""
    places = [*((0.0, float(k)) for k in range(1, 4)), *((100.0, 10.0 * k) for k in range(-4, 5))]
    mission = Mission(
        rules=Rules(objective="max", return_to_start=True),
        robots=tuple(Robot(id=f"r_{k}", position=(0, 0)) for k in range(4)),
        tasks=tuple(Task(id=str(k), position=place, actuation_cost=60.0) for k, place in enumerate(places)),
    )
    bound = best_bound(Problem.compile(mission))
    assert bound.arguments == ("the tasks far away",)
    assert bound.value > (4 * 2 * 100 + 9 * 60 - 1) / 4  # four rounds and the work


def test_robots_with_tasks_at_hand_need_not_go_far_away():
    """Of two robots far apart one has a single task: without it the best plan has one route, not two."""
    mission = Mission(
        rules=Rules(objective="max"),
        robots=(Robot(id="many", position=(0, 0)), Robot(id="one", position=(10000, 0))),
        tasks=tuple(Task(id=str(x), position=(float(x), 0.0)) for x in (*range(10, 120, 10), 10001)),
    )
    problem = Problem.compile(mission)
    assert far_shares(problem, problem.allowed).max() <= 110 * (1 + ROUNDING)
    assert best_bound(problem).value <= 110 * (1 + ROUNDING)


@pytest.mark.long
def test_every_argument_says_why_it_holds():
    seen = set()
    for name in ("6T-2R", "31T-6R50"):
        for objective in OBJECTIVES:
            bound = best_bound(Problem.compile(muster.load(name), objective))
            assert all(f"{one}: {WHY[one]}" in bound.why for one in bound.arguments)
            assert all(re.search(r"\(.*19\d\d\)", WHY[one]) for one in bound.arguments)
            seen.update(bound.arguments)
    assert len(seen) >= 5


def test_large_missions_are_bounded_row_by_row_as_well(monkeypatch):
    problem = Problem.compile(by_table(3), "total")
    usual = best_bound(problem).value
    monkeypatch.setattr("muster.allocation.bounds.spanning._DENSE", 0)
    assert best_bound(problem).value == pytest.approx(usual, rel=1e-12)
    monkeypatch.setattr("muster.allocation.bounds.spanning._MOST_KINDS", 0)
    monkeypatch.setattr("muster.allocation.bounds.feasibility._MOST_WAYS", 0)
    assert best_bound(problem).value <= usual * (1 + ROUNDING)


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_of_one_task_the_bound_is_exact(objective):
    mission = Mission(
        rules=Rules(objective=objective, return_to_start=True),
        robots=(Robot(id="near", position=(0, 0), speed_mps=0.5), Robot(id="far", position=(50, 0))),
        tasks=(Task(id="1", position=(3, 4), actuation_cost=2),),
    )
    problem = Problem.compile(mission)
    assert lower_bound(problem) == pytest.approx(best_plan(problem)[1])


def test_no_tasks():
    mission = Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=())
    assert lower_bound(Problem.compile(mission)) == 0


@pytest.mark.parametrize("robots", [1, 2])
def test_it_is_infinite_where_capacities_cannot_hold_all_tasks(robots):
    mission = Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(0, 0), work_capacity=24) for k in range(robots)),
        tasks=tuple(Task(id=str(k), position=(0, 10), actuation_cost=10) for k in range(3)),
    )
    assert lower_bound(Problem.compile(mission, "total")) == math.inf


def test_farthest_task_bounds_the_greatest_usage():
    """eil51 with 7 salesmen: twice the way to the farthest node, which the best plan known has."""
    bound = best_bound(Problem.compile(muster.load("eil51-7"), "max"))
    assert bound.value == pytest.approx(112.0714, abs=1e-4)
    assert bound.arguments == ("the farthest task",)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    ("name", "best_known", "gap"),
    [("31T-6R", 213.5616, 0.17), ("16T-3R", 342.9002, 0.11), ("24T-5R", 189.2523, 0.14), ("eil51-5", 629.9602, 0.11)],
)
def test_shipped_missions(name, best_known, gap):
    bound = lower_bound(Problem.compile(muster.load(name), "total+max"))
    assert (1 - gap) * best_known <= bound <= best_known


def test_critical_path_bounds_the_makespan():
    """Three tasks in a chain, each by another robot, at the robots' starts: they wait for each other."""
    mission = Mission(
        rules=Rules(objective="makespan"),
        robots=tuple(Robot(id=f"r_{k}", position=(100 * k, 0), available_from_s=2) for k in range(3)),
        tasks=tuple(
            Task(id=str(k), position=(100 * k, 0), duration_s=10, prerequisites=(str(k - 1),) if k else ())
            for k in range(3)
        ),
    )
    bound = best_bound(Problem.compile(mission))
    assert bound.value == pytest.approx(32)
    assert bound.arguments == ("the critical path",)
