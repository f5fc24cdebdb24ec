"""The core's verbs against the judge, which shares no code with them."""

from dataclasses import replace
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission, with_travel_tables

import muster
from muster import core
from muster.allocation.allocator import Outcome, finished_plan, routes_of
from muster.allocation.stop import Stop
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem

seeds = st.integers(0, 10**6)
STEPS = {
    "replace_worst": lambda population: population.replace_worst(0.4),
    "mutate": lambda population: population.mutate(1.0),
    "cross": lambda population: population.cross(1.0),
}


def plan_of(problem, routes):
    by_robot = {robot.id: route for robot, route in zip(problem.robots, routes, strict=True)}
    names = [[problem.tasks[j].id for j in by_robot[robot.id]] for robot in problem.mission.robots]
    return Plan(
        objective=problem.objective,
        ignored=problem.ignored,
        routes=tuple(Route(r.id, tuple(tasks)) for r, tasks in zip(problem.mission.robots, names, strict=True)),
    )


def some_population(problem, seed, size=6):
    population = core.Population(problem.core, size, seed)
    for member in range(size):
        population.set_random(member)
    return population


@given(seed=seeds, steps=st.lists(st.sampled_from(sorted(STEPS)), max_size=12))
def test_every_step_keeps_members_admissible_and_their_values_true(seed, steps):
    problem = Problem.compile(random_mission(seed, tasks=9))
    population = some_population(problem, seed)
    for step in steps:
        STEPS[step](population)
    for member in range(len(population)):
        verdict = muster.verify(
            problem.mission, plan_of(problem, population.routes(member)), problem.ignored, problem.objective
        )
        assert verdict.violations == ()
        assert population.objective(member) == pytest.approx(verdict.value(), rel=1e-9)
        assert population.weight(member) == pytest.approx(verdict.weight_completed)


@given(seed=seeds)
def test_mutation_never_makes_a_member_worse_and_crossover_keeps_the_best_two(seed):
    problem = Problem.compile(random_mission(seed, tasks=9))
    population = some_population(problem, seed, size=2)

    def values():
        return [(-population.weight(k), population.objective(k)) for k in range(2)]

    for _ in range(10):
        before = values()
        population.mutate(1.0)
        after = values()
        assert all(new <= (old[0], old[1] + 1e-9) for old, new in zip(before, after, strict=True))
        population.cross(1.0)
        crossed = sorted(values())
        assert crossed[0] <= (min(after)[0], min(after)[1] + 1e-9)
        assert crossed[1] <= (max(after)[0], max(after)[1] + 1e-9)


@given(seed=seeds)
def test_a_mutant_differs_by_one_task_at_the_most(seed):
    problem = Problem.compile(random_mission(seed, tasks=9))
    population = some_population(problem, seed, size=2)
    population.set_mutant(1, 0)
    holder = [
        {j: (i, k) for i, route in enumerate(population.routes(member)) for k, j in enumerate(route)}
        for member in range(2)
    ]
    moved = [j for j in range(len(problem.tasks)) if holder[0].get(j, (None,))[0] != holder[1].get(j, (None,))[0]]
    assert len(moved) <= 1
    orders = [[[j for j in route if j not in moved] for route in population.routes(member)] for member in range(2)]
    assert orders[0] == orders[1]


@given(seed=seeds, tasks=st.integers(1, 7))
def test_cheapest_insertion_is_the_cheapest_of_all_places(seed, tasks):
    mission = random_mission(seed, tasks=tasks, robots=2)
    problem = Problem.compile(mission)
    routes = muster.solve(mission, "genetic", seed=seed, iterations=1)
    routes = routes_of(problem, routes)
    done = {j for route in routes for j in route}
    inspection = core.Inspection(problem.core, routes)
    unlimited = Problem.compile(mission, ignored=("capacity",))
    for j in sorted(set(range(len(problem.tasks))) - done):
        if any(k not in done for k in problem.prerequisites[j]):
            continue
        for i in range(len(problem.robots)):
            usages = []
            for at in range(len(routes[i]) + 1):
                trial = [list(route) for route in routes]
                trial[i].insert(at, j)
                verdict = muster.verify(mission, plan_of(unlimited, trial), unlimited.ignored)
                if not any(v.kind in ("deadlock", "prerequisite") for v in verdict.violations):
                    robot = [route.robot for route in verdict.routes].index(problem.robots[i].id)
                    usages.append(verdict.routes[robot].usage)
            found = inspection.cheapest_insertion(i, j)
            assert (found.usage if found else None) == (pytest.approx(min(usages)) if usages else None)


@given(seed=seeds, order=st.randoms(use_true_random=False))
def test_insertions_into_routes_that_lack_ways(seed, order):
    """By travel tables with missing legs, the route itself may lack a way, which the task may bring back."""
    mission = with_travel_tables(random_mission(seed, tasks=5, robots=2), seed)
    problem = Problem.compile(mission, ignored=("prerequisites",))
    first, *others = order.sample(range(5), 5)
    routes = [others[:3], []]
    inspection = core.Inspection(problem.core, routes)
    for i in range(2):
        trials = [
            [[*route[:at], first, *route[at:]] if k == i else route for k, route in enumerate(routes)]
            for at in range(len(routes[i]) + 1)
        ]
        usages = [core.Inspection(problem.core, trial).usages[i] for trial in trials]
        found = inspection.cheapest_insertion(i, first)
        assert found.usage == pytest.approx(min(usages))
        assert usages[found.at] == pytest.approx(min(usages))


@given(seed=seeds, order=st.randoms(use_true_random=False))
def test_evaluation_agrees_with_the_judge_on_any_routes(seed, order):
    problem = Problem.compile(random_mission(seed, tasks=7), ignored=("suitability", "skills"))
    tasks = list(range(len(problem.tasks)))
    order.shuffle(tasks)
    routes = [[] for _ in problem.robots]
    for j in tasks:
        allowed = [i for i in range(len(routes)) if problem.allowed[i, j]]
        if allowed and order.random() < 0.8:
            routes[order.choice(allowed)].append(j)
    inspection = core.Inspection(problem.core, routes)
    verdict = muster.verify(problem.mission, plan_of(problem, routes), problem.ignored, problem.objective)
    assert inspection.admissible == verdict.valid
    assert (inspection.makespan is None) == any(v.kind == "deadlock" for v in verdict.violations)
    usage = {route.robot: route.usage for route in verdict.routes}
    assert inspection.usages == pytest.approx([usage[robot.id] for robot in problem.robots])
    if verdict.valid:
        assert inspection.objective == pytest.approx(verdict.value())
        plan = finished_plan(problem, Stop(), Outcome(routes), allocator="test", seed=0)
        assert muster.verify(problem.mission, plan, problem.ignored, problem.objective).valid


def small_problem():
    return Problem.compile(random_mission(1)).core


@pytest.mark.parametrize(
    ("routes", "message"),
    [
        ([[0]], "a route for each robot"),
        ([[0], [0], []], "a task stands twice"),
        ([[99], [], []], "no such task"),
        ([[-1], [], []], "no such task"),
    ],
)
def test_routes_that_cannot_be_are_refused(routes, message):
    with pytest.raises(ValueError, match=message):
        core.Inspection(small_problem(), routes)


def test_indices_out_of_range_are_refused():
    problem = small_problem()
    population = core.Population(problem, 2, 0)
    for call in (population.routes, population.weight, population.objective, population.set_random):
        with pytest.raises(IndexError):
            call(2)
    inspection = core.Inspection(problem, [[], [], []])
    with pytest.raises(ValueError, match="no such robot or task"):
        inspection.cheapest_insertion(3, 0)
    greedy = core.Greedy(problem, balanced=True)
    with pytest.raises(ValueError, match="no such robot or task"):
        greedy.assign(0, 99)
    with pytest.raises(ValueError, match="a population needs a member"):
        core.Population(problem, 0, 0)


def test_the_problem_outlives_its_python_name():
    population = core.Population(Problem.compile(random_mission(2)).core, 3, 0)
    population.set_random(0)
    assert len(population) == 3


@given(
    seed=seeds,
    allocator=st.sampled_from(["greedy", "hill-climbing", "genetic", "greedy+genetic", "greedy+hill-climbing"]),
)
def test_a_capacity_that_is_filled_exactly_is_enough(seed, allocator):
    random, work = Random(seed), seed % 2
    places = sorted(random.sample(range(1, 60), 5))
    tasks = tuple(
        muster.Task(id=str(k), position=(place / 10, 0), actuation_cost=work * random.randrange(30) / 10)
        for k, place in enumerate(places)
    )
    free = muster.Mission(robots=(muster.Robot(id="r", position=(0, 0)),), tasks=tasks)
    usage = muster.verify(free, muster.Plan(routes=(muster.Route("r", tuple("01234")),))).total_cost
    limited = replace(free, robots=(muster.Robot(id="r", position=(0, 0), work_capacity=usage),))
    plan = muster.solve(limited, allocator, iterations=200)
    assert muster.verify(limited, plan).valid
    if allocator.startswith("greedy") and not work:  # along a line the nearest task is always the next
        assert plan.complete


@pytest.mark.parametrize("share", [-0.1, 1.1, 50.0, float("nan")])
@pytest.mark.parametrize("step", ["replace_worst", "mutate", "cross"])
def test_shares_and_probabilities_out_of_range_are_refused(step, share):
    population = core.Population(small_problem(), 3, 0)
    with pytest.raises(ValueError, match="from 0 to 1"):
        getattr(population, step)(share)


def test_the_objective_of_routes_above_capacity_is_theirs():
    robots = (muster.Robot(id="a", position=(0, 0), work_capacity=5), muster.Robot(id="b", position=(0, 0)))
    tasks = (muster.Task(id="1", position=(10, 0)), muster.Task(id="2", position=(0, 10)))
    problem = Problem.compile(muster.Mission(robots=robots, tasks=tasks))
    inspection = core.Inspection(problem.core, [[0], [1]])
    assert not inspection.admissible
    assert inspection.objective == 30.0


def test_a_knot_has_no_objective():
    tasks = (muster.Task(id="1", position=(1, 0), prerequisites=("2",)), muster.Task(id="2", position=(2, 0)))
    problem = Problem.compile(muster.Mission(robots=(muster.Robot(id="a", position=(0, 0)),), tasks=tasks))
    inspection = core.Inspection(problem.core, [[0, 1]])
    assert inspection.objective is inspection.makespan is None
