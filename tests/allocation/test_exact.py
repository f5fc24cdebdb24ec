"""The exact solver against all plans of small missions, and against bounds and search on larger ones."""

import builtins
import math
from dataclasses import replace

import pytest
from tests.all_plans import best_plan
from tests.allocation.test_bounds import by_table, forgiving
from tests.carried_missions.missions import carried_mission
from tests.random_missions import random_mission

import muster
from muster import Mission, Robot, Rules, Task, core
from muster.allocation.allocator import routes_of
from muster.allocation.bounds.of_objective import lower_bound
from muster.allocation.exact import solve_exactly
from muster.allocation.exact.scale import Scale, whole_weights
from muster.mission.errors import MissingExtraError, ParameterError
from muster.mission.model import OBJECTIVES
from muster.model.problem import Problem
from muster.planning.judging import admits

pytest.importorskip("ortools", reason="needs the extra exact")
SHARP = pytest.approx
CLOSE = {"rel": 1e-7, "abs": 1e-7}


def assert_exact(problem, **more):
    weight, value, _ = best_plan(problem)
    result = solve_exactly(problem, 30.0, **more, judge=admits)
    assert core.Inspection(problem.core, result.routes).admissible
    assert all(problem.allowed[i, j] for i, route in enumerate(result.routes) for j in route)
    assert result.weight_proven
    assert result.optimal
    assert result.weight == SHARP(weight)
    assert problem.value(result.routes)[1] == SHARP(value, **CLOSE)
    assert result.lower_bound == SHARP(value, **CLOSE)
    assert result.lower_bound <= value * (1 + 1e-12)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_it_finds_the_best_of_all_plans(objective):
    for seed in range(8):
        assert_exact(Problem.compile(random_mission(seed, tasks=5, robots=2), objective))


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_it_finds_the_best_where_travel_is_by_table(objective):
    for seed in range(5):
        assert_exact(Problem.compile(by_table(seed), objective))


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_it_finds_the_best_where_most_tasks_can_be_done(objective):
    for seed in range(5):
        assert_exact(Problem.compile(forgiving(seed), objective))


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_like_robots_are_told_apart_by_their_routes_alone(objective):
    """Salesmen: the order of like robots in the program does not hide plans, and a start fits into it."""
    mission = Mission(
        rules=Rules(objective=objective, return_to_start=True),
        robots=tuple(Robot(id=f"r_{k}", position=(0, 0), work_capacity=40) for k in range(3)),
        tasks=tuple(Task(id=str(k), position=p) for k, p in enumerate([(1, 9), (-8, 2), (7, 7), (0, -4)])),
    )
    problem = Problem.compile(mission)
    assert_exact(problem)
    assert_exact(problem, start=[[], [3], [0, 2, 1]])


def test_it_does_not_deadlock():
    """Without prerequisites across robots the nearest tasks would be done in an order in which both robots wait."""
    mission = Mission(
        rules=Rules(objective="average"),
        robots=(Robot(id="r_0", position=(0, 0)), Robot(id="r_1", position=(0, 100))),
        tasks=(
            Task(id="a", position=(1, 0), prerequisites=("d",)),
            Task(id="b", position=(2, 0)),
            Task(id="c", position=(1, 100), prerequisites=("b",)),
            Task(id="d", position=(2, 100)),
        ),
    )
    for objective in OBJECTIVES:
        assert_exact(Problem.compile(mission, objective))


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_bound_exact_search(objective):
    for seed in range(3):
        mission = replace(random_mission(seed, tasks=8, robots=3, min_suitability=0), suitability=None)
        problem = Problem.compile(mission, objective)
        plan = muster.solve(mission, "search", iterations=500, objective=objective)
        result = solve_exactly(problem, 30.0, start=routes_of(problem, plan), judge=admits)
        assert result.optimal
        weight, value = problem.value(result.routes)
        assert weight >= plan.weight_completed
        if weight == plan.weight_completed:
            assert value <= plan.objective_value * (1 + 1e-9)
        if sum(map(len, result.routes)) == len(problem.tasks):
            assert lower_bound(problem) <= value * (1 + 1e-9)


def test_the_solver_rules_out_no_plan_that_is_the_best():
    """After its presolve OR-Tools 9.15 rules out the best plan of this mission in two of three runs."""
    problem = Problem.compile(carried_mission(552))
    for seed in range(6):
        result = solve_exactly(problem, 30.0, seed=seed, judge=admits)
        assert (result.optimal, problem.value(result.routes)[1]) == (True, SHARP(22.56741, rel=1e-6))


@pytest.mark.long
def test_16t_3r_is_proven():
    """The best plan known of a shipped mission with prerequisites across robots is the best there is."""
    problem = Problem.compile(muster.load("16T-3R"))
    plan = muster.solve(muster.load("16T-3R"), "search", iterations=500)
    result = solve_exactly(problem, 60.0, start=routes_of(problem, plan), judge=admits)
    assert result.optimal
    assert result.lower_bound == pytest.approx(342.9001, abs=1e-4)


def test_without_time_only_what_is_known_is_claimed():
    problem = Problem.compile(muster.load("16T-3R"))
    nothing = solve_exactly(problem, 0.0, judge=admits)
    assert (nothing.weight, nothing.weight_proven, nothing.lower_bound, nothing.optimal) == (0, False, None, False)
    plan = muster.solve(muster.load("16T-3R"), "greedy")
    start = routes_of(problem, plan)
    result = solve_exactly(problem, 0.0, start=start, judge=admits)
    assert result.routes == start
    assert result.weight_proven  # all tasks are done
    assert not result.optimal
    assert result.lower_bound == lower_bound(problem)


def test_a_start_that_is_not_admissible_is_refused():
    problem = Problem.compile(muster.load("16T-3R"))
    with pytest.raises(ParameterError, match="not admissible"):
        solve_exactly(problem, 1.0, start=[[1], [], []], judge=admits)  # without its prerequisite


def test_no_tasks():
    mission = Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=())
    result = solve_exactly(Problem.compile(mission), 1.0, judge=admits)
    assert (result.routes, result.lower_bound, result.optimal) == ([[]], 0, True)


@pytest.mark.parametrize(("above", "routes"), [(1e-11, [[0]]), (1e-8, [[]])])
def test_a_capacity_holds_as_far_as_the_judge_says(above, routes):
    """A usage above a capacity by less than the judge's rounding keeps it; by more it does not."""
    mission = Mission(
        rules=Rules(objective="total"),
        robots=(Robot(id="r", position=(0, 0), work_capacity=5 * (1 - above)),),
        tasks=(Task(id="1", position=(3, 4)),),
    )
    result = solve_exactly(Problem.compile(mission), 5.0, judge=admits)
    assert result.routes == routes
    assert result.optimal


def test_scale_rounds_costs_down():
    scale = Scale(8.0, 0.5)
    assert scale.down(pytest.importorskip("numpy").array([0.124, 0.125, math.inf])).tolist() == [0, 1, -1]
    assert scale.at_most(1.0) == 8
    assert scale.at_least(1.0) == 3


def test_weights_become_whole():
    assert whole_weights([1, 2.5, 0.1]) == [10, 25, 1]
    assert whole_weights([1e-30, 1]) is None


def test_priorities_too_fine_are_refused():
    tasks = tuple(Task(id=str(k), position=(k, 0), priority=p) for k, p in enumerate((1e-30, 1)))
    mission = Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=tasks)
    with pytest.raises(ParameterError, match="too many digits"):
        solve_exactly(Problem.compile(mission), 1.0, judge=admits)


def test_without_ortools_one_line_says_what_to_install(monkeypatch):
    real = builtins.__import__

    def absent(name, *args, **kwargs):
        if name.startswith("ortools"):
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", absent)
    with pytest.raises(MissingExtraError, match=r"pip install 'muster-robotics\[exact\]'"):
        solve_exactly(Problem.compile(muster.load("6T-2R")), 1.0, judge=admits)


@pytest.mark.long
def test_an_interrupted_proof_ends_with_what_is_proven():
    """Interrupted at once nothing but the quick bounds is known; interrupted under way, soon after it."""
    problem = Problem.compile(muster.load("24T-5R"))
    start = routes_of(problem, muster.solve(problem.mission, iterations=300))
    at_once = solve_exactly(problem, 1000.0, start, interrupted=lambda: True, judge=admits)
    assert at_once.routes == start
    assert not at_once.optimal
    assert at_once.lower_bound == SHARP(lower_bound(problem))
    looks = iter(range(10))
    under_way = solve_exactly(problem, 1000.0, start, interrupted=lambda: next(looks, None) is None, judge=admits)
    assert under_way.weight == at_once.weight
    assert under_way.lower_bound >= at_once.lower_bound
