"""Plans whose routes begin as they are told to: what is done, or under way, stays while the rest is planned anew."""

from random import Random

import pytest
from tests.all_plans import best_plan
from tests.allocation.test_bounds import by_table, forgiving
from tests.random_missions import random_mission

import muster
from muster import core
from muster.allocation.allocator import routes_of
from muster.allocation.bounds.of_objective import lower_bound
from muster.allocation.exact import solve_exactly
from muster.allocation.fixed import with_fixed_routes
from muster.allocation.registry import ALLOCATORS
from muster.cli.main import run
from muster.generation.uniform import large_mission
from muster.mission.errors import ParameterError
from muster.mission.model import OBJECTIVES
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem
from muster.planning.judging import admits


def plan_of(mission, routes):
    return Plan(
        mission=mission.name, routes=tuple(Route(r.id, tuple(routes.get(r.id, ())), None) for r in mission.robots)
    )


def beginning_of(mission, seed):
    """A plan of the mission, cut off somewhere: a task stays if what it waits for stays, and what is before it."""
    random = Random(seed)
    plan = muster.solve(mission, iterations=200, seed=seed)
    before = {task.id: set(task.prerequisites) for task in mission.tasks}
    cuts = {route.robot: random.randint(0, len(route.tasks)) for route in plan.routes}
    while True:
        routes = {route.robot: route.tasks[: cuts[route.robot]] for route in plan.routes}
        stay = {task for tasks in routes.values() for task in tasks}
        shorter = {
            robot: next((k for k, task in enumerate(tasks) if not before[task] <= stay), len(tasks))
            for robot, tasks in routes.items()
        }
        if shorter == cuts:
            return plan_of(mission, routes)
        cuts = shorter


def begins_with(plan, fixed):
    routes = {route.robot: route.tasks for route in plan.routes}
    return all(routes[route.robot][: len(route.tasks)] == route.tasks for route in fixed.routes)


def fits(mission, fixed):
    """A part of an admissible plan is one, but where a task lies on a short cut, or the way home is longer from it."""
    try:
        with_fixed_routes(Problem.compile(mission), fixed)
    except ParameterError:
        return False
    return True


@pytest.mark.long(keep=20)
@pytest.mark.parametrize("allocator", ["search", "greedy"])
@pytest.mark.parametrize("seed", range(30))
def test_routes_begin_with_them_and_the_plan_is_admissible(allocator, seed):
    mission = random_mission(seed, tasks=12, robots=3)
    fixed = beginning_of(mission, seed)
    if not fits(mission, fixed):
        fixed = plan_of(mission, {})
    plan = muster.solve(mission, allocator, fixed=fixed, iterations=None if allocator == "greedy" else 300, seed=seed)
    assert begins_with(plan, fixed)
    assert muster.verify(mission, plan).valid


@pytest.mark.long
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_it_finds_the_best_of_all_such_plans(objective):
    """The exact solver, the search and the bounds, against all plans."""
    tried = 0
    for seed in range(9):
        mission = (random_mission(seed, tasks=5, robots=2), forgiving(seed), by_table(seed))[seed % 3]
        fixed = beginning_of(mission, seed)
        if not any(route.tasks for route in fixed.routes) or not fits(mission, fixed):
            continue
        tried += 1
        problem = with_fixed_routes(Problem.compile(mission, objective), fixed)
        weight, value, _ = best_plan(problem)
        exact = solve_exactly(problem, 30.0, judge=admits)
        assert exact.optimal
        assert exact.weight == pytest.approx(weight)
        assert problem.value(exact.routes)[1] == pytest.approx(value, rel=1e-7, abs=1e-7)
        found = muster.solve(mission, objective=objective, fixed=fixed, iterations=2000)
        assert found.weight_completed <= weight + 1e-9
        if found.weight_completed == pytest.approx(weight):
            assert found.objective_value >= value - 1e-7 * abs(value) - 1e-9
        if found.complete:
            assert lower_bound(problem) <= value + 1e-9
    assert tried > 4


def test_they_change_what_is_best():
    """Two tasks on a line: the far one first costs the way back."""
    mission = muster.Mission(
        name="line",
        robots=(muster.Robot(id="r", position=(0.0, 0.0)),),
        tasks=(muster.Task(id="near", position=(1.0, 0.0)), muster.Task(id="far", position=(3.0, 0.0))),
    )
    assert muster.solve(mission, iterations=50, objective="total").objective_value == 3
    fixed = plan_of(mission, {"r": ("far",)})
    plan = muster.solve(mission, iterations=50, objective="total", fixed=fixed)
    assert plan.routes[0].tasks == ("far", "near")
    assert plan.objective_value == 5
    assert muster.solve(mission, iterations=50, objective="total", fixed=fixed, bound="exact").lower_bound == 5


@pytest.mark.long
def test_they_stay_in_a_team_that_is_divided():
    mission = large_mission(900, 30)
    whole = muster.solve(mission, "greedy")
    fixed = plan_of(mission, {route.robot: route.tasks[:5] for route in whole.routes[::2]})
    plan = muster.solve(mission, fixed=fixed, iterations=4000, parts=4)
    assert begins_with(plan, fixed)
    assert plan.complete
    assert muster.verify(mission, plan).valid
    assert plan.objective_value < muster.solve(mission, "greedy", fixed=fixed).objective_value


def test_a_start_goes_on_from_them_or_is_refused():
    mission = muster.load("eil51-5")
    start = muster.solve(mission, "greedy")
    fixed = plan_of(mission, {route.robot: route.tasks[:3] for route in start.routes})
    assert begins_with(muster.solve(mission, start=start, fixed=fixed, iterations=100), fixed)
    others = plan_of(mission, {"r_0": start.routes[1].tasks})
    with pytest.raises(ParameterError, match="start: robot r_0 does not begin with the fixed tasks"):
        muster.solve(mission, start=start, fixed=others, iterations=100)


@pytest.mark.parametrize("name", sorted(set(ALLOCATORS) - {"search", "greedy", "auction"}))
def test_allocators_that_would_move_them_refuse(name):
    mission = muster.load("eil51-5")
    fixed = plan_of(mission, {mission.robots[0].id: (mission.tasks[0].id,)})
    with pytest.raises(ParameterError, match="fixed: with"):
        muster.solve(mission, name, fixed=fixed, time_limit=0.1)


def test_a_task_that_waits_for_one_outside_is_refused():
    mission = muster.load("31T-6R")
    waiting = next(task for task in mission.tasks if task.prerequisites)
    with pytest.raises(ParameterError, match="fixed: the plan is not admissible"):
        muster.solve(mission, fixed=plan_of(mission, {"r_0": (waiting.id,)}), iterations=10, ignore=("suitability",))


def test_reasons_know_of_them():
    """A task is left out because it would have to come behind a task that stays."""
    mission = muster.Mission(
        name="line",
        robots=(muster.Robot(id="r", position=(0.0, 0.0), work_capacity=3.5),),
        tasks=(muster.Task(id="near", position=(1.0, 0.0)), muster.Task(id="far", position=(3.0, 0.0))),
    )
    plan = muster.solve(mission, iterations=50, fixed=plan_of(mission, {"r": ("far",)}))
    (left,) = plan.unassigned
    reason = ("not-chosen", "fits only before tasks that stay where they are")
    assert (left.task, left.reasons[0].reason, left.reasons[0].detail) == ("near", *reason)
    assert muster.verify(mission, plan).valid, "capacity would not be true for who knows nothing of what is fixed"


def test_from_the_command(tmp_path, capsys):
    mission = muster.load("eil51-5")
    first = muster.solve(mission, "greedy")
    fixed = plan_of(mission, {route.robot: route.tasks[:3] for route in first.routes})
    fixed.save(tmp_path / "fixed.json")
    out = tmp_path / "plan.json"
    command = ["solve", "eil51-5", "--fixed", str(tmp_path / "fixed.json"), "--iterations", "200", "-q", "-o", str(out)]
    assert run(command) == 0
    capsys.readouterr()
    assert begins_with(muster.read_plan(out), fixed)
    assert run([*command, "--allocator", "auction"]) == 0
    assert begins_with(muster.read_plan(out), fixed)
    assert run([*command, "--allocator", "market"]) == 2
    assert "fixed: with market, which would move tasks; expected search, greedy or auction" in capsys.readouterr().err


def test_the_start_of_the_search_has_them():
    mission = muster.load("eil51-5")
    fixed = plan_of(mission, {mission.robots[0].id: [task.id for task in mission.tasks[:4]]})
    problem = with_fixed_routes(Problem.compile(mission), fixed)
    assert routes_of(problem, fixed) == [list(route) for route in problem.fixed]
    assert core.Inspection(problem.core, routes_of(problem, fixed)).admissible
