"""Solvers from elsewhere on routes: orienteering, longest routes, many depots, long tours; instances and tables."""

import math
from dataclasses import replace

import pytest

import muster
from muster.cli.main import run as cli
from muster.generation.clustered import Clustered, clustered_mission
from muster.model.problem import Problem
from muster_studies.effort import Effort
from muster_studies.instances.orienteering import (
    BEST_SCORES,
    LIMITS,
    orienteering_instance,
    orienteering_mission,
)
from muster_studies.instances.routing import (
    LONGEST_ROUTES,
    SHORTER_ROUTES,
    routing_instance,
    shorter_plan,
    uniform_tour,
)
from muster_studies.peers.contest import OWN, PEERS, Result, Standing, mission_of
from muster_studies.peers.instance import Instance
from muster_studies.peers.study import mean_cell, ratio_cell, worst_cell
from muster_studies.peers.timed_studies import ROUTES, peers_routes_study
from muster_studies.tables import Notes

BY_NUMBER = {family.number: family for family in ROUTES}
TASKS = {"mtsp100": 99, "rand100": 99, "mtsp150": 149, "kroa200": 199, "rat783": 782}
DEPOTS = {"md2": 200, "md4": 395, "md12": 100, "md24": 400}


@pytest.mark.long
@pytest.mark.parametrize("number", BY_NUMBER)
def test_a_family_is_compared_in_its_smallest_form(number):
    for package in ("ortools", "pyvrp"):
        pytest.importorskip(package)
    (table,) = peers_routes_study().run(Effort(quick=True, tables=(number,))).tables
    row, mean = table.records()
    solvers = BY_NUMBER[number].solvers
    assert {OWN, *solvers} <= set(table.columns)
    assert row["mission"] == BY_NUMBER[number].quick
    assert row["search"] == pytest.approx(0, abs=1e-3)
    assert all(row[solver] >= -1e-3 for solver in solvers)
    assert mean["search"] == row["search"]


def test_orienteering_instances_have_their_robots_and_limits():
    assert set(BEST_SCORES) == set(LIMITS)
    for name, limit in LIMITS.items():
        mission = orienteering_instance(name)
        assert len(mission.robots) == int(name.split(".")[1])
        assert {robot.work_capacity for robot in mission.robots} == {limit}
        assert BEST_SCORES[name] <= sum(task.priority for task in mission.tasks)


def test_a_plan_of_an_orienteering_instance_is_worth_its_score():
    mission = orienteering_instance("p1.3.p")
    assert (mission.robots[0].position, mission.robots[0].end_position) == ((10.5, 14.4), (11.2, 14.1))
    plan = muster.solve(mission, "search", iterations=2000, seed=1)
    score = sum(task.priority for task in mission.tasks if task.id in {t for r in plan.routes for t in r.tasks})
    assert 0.9 * BEST_SCORES["p1.3.p"] <= score <= BEST_SCORES["p1.3.p"]
    assert muster.verify(mission, plan).weight_completed == score


def test_points_that_are_none_are_told():
    with pytest.raises(muster.ParameterError, match="point: '1 2'; expected x, y, score"):
        orienteering_mission("0 0 0\n1 2\n3 3 0\n", 1, 5.0, "short")
    with pytest.raises(muster.ParameterError, match="2 points; expected the start"):
        orienteering_mission("0 0 0\n3 3 0\n", 1, 5.0, "empty")
    with pytest.raises(muster.ParameterError, match=r"instance: p9\.2\.a; expected p1\.3\.p or"):
        orienteering_instance("p9.2.a")


@pytest.mark.parametrize(("name", "robots"), LONGEST_ROUTES)
def test_instances_of_the_longest_route(name, robots):
    mission = routing_instance(name, robots)
    assert (len(mission.robots), len(mission.tasks)) == (robots, {**TASKS, **DEPOTS}[name])
    assert (mission.rules.objective, mission.rules.return_to_start) == ("max", True)
    assert len({robot.position for robot in mission.robots}) == (robots if name in DEPOTS else 1)
    farthest = max(
        2 * min(math.dist(robot.position, task.position) for robot in mission.robots) for task in mission.tasks
    )
    assert farthest <= LONGEST_ROUTES[name, robots]


@pytest.mark.parametrize(("name", "robots"), SHORTER_ROUTES)
def test_shipped_plans_are_better_than_all_published(name, robots):
    verdict = muster.verify(routing_instance(name, robots), shorter_plan(name, robots))
    assert verdict.valid
    assert verdict.tasks_completed == verdict.tasks_total
    assert verdict.value("max") == pytest.approx(SHORTER_ROUTES[name, robots], abs=1e-4)
    assert verdict.value("max") < LONGEST_ROUTES[name, robots]


def test_instances_and_numbers_of_robots_that_are_none_are_told():
    with pytest.raises(muster.ParameterError, match="instance: rat1; expected cc64 or kroa200 or"):
        routing_instance("rat1", 5)
    with pytest.raises(muster.ParameterError, match="robots: 3; expected 8, the depots of cc64"):
        routing_instance("cc64", 3)
    with pytest.raises(muster.ParameterError, match="robots: 0; expected one at least, the depots of rat783"):
        routing_instance("rat783", 0)


def test_generated_missions_are_those_of_their_seed():
    size = Clustered(robots=8, tasks=120)
    mission = clustered_mission(size, 0)
    assert (len(mission.robots), len(mission.tasks)) == (8, 120)
    assert mission == clustered_mission(size, 0) != clustered_mission(size, 1)
    nearest = [min(math.dist(a.position, b.position) for b in mission.tasks if b != a) for a in mission.tasks]
    assert sum(nearest) / len(nearest) < 30  # of as many places all over the square: 46
    tour = uniform_tour(500, 0)
    assert (len(tour.robots), len(tour.tasks)) == (1, 499)
    assert tour == uniform_tour(500, 0) != uniform_tour(500, 1)


def test_every_mission_of_the_tables_has_a_name():
    for family in ROUTES:
        for name in family.missions:
            assert mission_of(name).tasks


def test_scores_are_told_to_others_as_they_are():
    scores = [1, 3, 29, 3]
    instance = Instance(Problem.compile(line(scores), "total"))
    assert instance.weights == scores
    assert instance.prize < instance.usage.bound
    halves = Instance(Problem.compile(line([0.5, 1.0]), "total"))
    assert halves.weights == [50, 100]


@pytest.mark.parametrize("peer", ["PyVRP", "OR-Tools"])
def test_the_greater_score_is_worth_any_way(peer):
    pytest.importorskip(PEERS[peer].distribution)
    instance = Instance(Problem.compile(line([1, 1, 1, 29]), "total"))
    answer = PEERS[peer].solve(instance, 0.15, 0)
    verdict = muster.verify(instance.problem.mission, instance.plan(answer.routes, peer), (), "total")
    assert verdict.valid
    assert verdict.weight_completed == 30


def test_pyvrp_has_a_plan_where_robots_are_at_their_limits():
    """With prizes far above all routes together it has none in ten times as long."""
    pytest.importorskip("pyvrp")
    instance = Instance(Problem.compile(orienteering_instance("p4.2.k"), "total"))
    assert PEERS["PyVRP"].solve(instance, 0.5, 0).routes is not None


def line(scores):
    """A robot at 0 that may go 14 there and back, tasks at -1, -2 ... and the last at 6."""
    places = [*(-k for k in range(1, len(scores))), 6]
    return muster.Mission(
        robots=(muster.Robot(id="r", position=(0, 0), work_capacity=14),),
        tasks=tuple(
            muster.Task(id=str(k), position=(x, 0), priority=score)
            for k, (x, score) in enumerate(zip(places, scores, strict=True))
        ),
        rules=muster.Rules(return_to_start=True),
    )


def results_of(family, effort, values, **more):
    """What each solver comes to, a value by seed."""
    return {
        run: Result(run=run, value=values[run.solver][run.seed], weight=1, tasks=9, tasks_total=9, **more)
        for run in family.jobs(effort)
    }


def test_the_least_value_is_the_reference_where_none_is_known():
    family, effort = BY_NUMBER["tour"], Effort(quick=True, seeds=2)
    found = results_of(family, effort, {OWN: (101.0, 103.0), "PyVRP": (100.0, 110.0), "OR-Tools": (120.0,)})
    row, _ = family.table(effort, found).records()
    assert row["reference"] == 100
    assert (row["search"], row["search, worst"]) == (pytest.approx(2), pytest.approx(3))
    assert (row["PyVRP"], row["PyVRP, worst"], row["OR-Tools"]) == pytest.approx((5, 10, 20))
    left_out = {run: replace(result, tasks=8, value=1.0) for run, result in found.items() if run.solver == "PyVRP"}
    row, mean = family.table(effort, {**found, **left_out}).records()
    assert (row["reference"], row["PyVRP"], mean["search"]) == (101, "8 tasks", None)


def test_scores_are_told_as_what_is_missing():
    family, effort = BY_NUMBER["orienteering"], Effort(quick=True)
    found = results_of(family, effort, dict.fromkeys(family.solvers, (5.0,)))
    found = {run: replace(result, weight=145 if run.solver == OWN else 116.0) for run, result in found.items()}
    row, _ = family.table(effort, found).records()
    assert (row["search"], row["PyVRP"], row["greedy"]) == (0, pytest.approx(20), pytest.approx(20))


def test_what_is_done_is_told_by_weight_where_priorities_differ():
    run = next(iter(BY_NUMBER["orienteering"].jobs(Effort(quick=True))))
    plan = Result(run=run, value=10.0, weight=3, tasks=3, tasks_total=4)
    assert worst_cell(Standing((plan,))) == "10.000 (3 tasks)"
    heavier = replace(plan, value=20.0, weight=7.5)
    assert mean_cell(Standing((heavier,)), Notes()) == "20.000 (3 tasks, weight 7.5)"
    assert ratio_cell(Standing((plan,)), Standing((heavier,))) == "less done"
    assert ratio_cell(Standing((heavier,)), Standing((plan,))) == "more done"


def test_a_solver_without_a_plan_is_told():
    family, effort = BY_NUMBER["longest"], Effort(quick=True)
    found = results_of(family, effort, {OWN: (160.0,), "OR-Tools": (0.0,)})
    found = {run: replace(result, fault="no plan" if run.solver != OWN else None) for run, result in found.items()}
    row, mean = family.table(effort, found).records()
    assert (row["OR-Tools"], mean["search"]) == ("no plan", None)


def test_the_bench_leads_to_the_study(asked_of_studies):
    assert cli(["bench", "peers-routes", "--tables", "tour", "--seeds", "2"]) == 2
    assert asked_of_studies == [("peers-routes", Effort(seeds=2, tables=("tour",)))]


def test_iterations_are_refused():
    with pytest.raises(muster.ParameterError, match="all solvers have the same time"):
        peers_routes_study().run(Effort(iterations=5))
