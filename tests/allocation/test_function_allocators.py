"""Any function that makes routes is an allocator; what it returns is checked."""

import pytest

import muster
from muster.allocation.allocator import Allocator
from muster.allocation.registry import ALLOCATORS, allocator_of
from muster.allocation.stop import Stop
from muster.mission.model import Robot, Rules, Task
from muster.model.problem import Problem


def nearest(problem, stop, seed, most=2):
    """Give each robot the first tasks that it may do."""
    routes = [[] for _ in problem.robots]
    free = [j for j in range(len(problem.tasks)) if not problem.prerequisites[j]]
    for i, route in enumerate(routes):
        route += [j for j in free if problem.may(i, j)][:most]
        free = [j for j in free if j not in route]
    return routes


def solved(allocator, **parameters):
    problem = Problem.compile(muster.load("31T-6R50")).ready()
    chosen = allocator_of(allocator)
    params = chosen.parameters(**parameters)
    return problem, chosen.solve(problem, Stop(), seed=3, params=params)


def test_a_function_with_a_parameter_of_its_own_makes_a_plan():
    _, plan = solved(nearest)
    assert plan.allocator == "nearest"
    assert max(len(route.tasks) for route in plan.routes) == 2
    assert muster.verify(muster.load("31T-6R50"), plan).valid
    assert plan.history[-1][1] == plan.objective_value
    _, fewer = solved(nearest, most=1)
    assert max(len(route.tasks) for route in fewer.routes) == 1


def test_an_allocator_whose_algorithm_returns_plain_routes():
    def allocate(problem, stop, seed, params, start):
        return nearest(problem, stop, seed)

    described = Allocator(
        name="first", summary="-", anytime=False, parameters=ALLOCATORS["greedy"].parameters, algorithm=allocate
    )
    assert solved(described)[1].routes == solved(nearest)[1].routes


def test_a_function_is_given_what_it_asks_for():
    seen = {}

    def watch(problem, *, start, seed, params, stop):
        seen.update(start=start, seed=seed, stop=stop)
        return [[] for _ in problem.robots]

    solved(watch)
    assert seen["start"] is None
    assert seen["seed"] == 3
    assert isinstance(seen["stop"], Stop)


@pytest.mark.parametrize(
    ("returned", "message"),
    [
        (lambda m, n: None, "returned NoneType; expected {m} routes, one for each robot"),
        (lambda m, n: [[]], "returned 1 routes; expected {m} routes, one for each robot"),
        (lambda m, n: [["a"]] + [[]] * (m - 1), "returned a route that is no list of indices of tasks; expected"),
        (lambda m, n: [[n]] + [[]] * (m - 1), "returned index {n}; expected indices from 0 to {last}"),
        (lambda m, n: [[0], [0]] + [[]] * (m - 2), "returned task 0 twice; expected each at most once"),
    ],
)
def test_what_a_function_returns_is_checked(returned, message):
    problem = Problem.compile(muster.load("31T-6R50"))
    m, n = len(problem.robots), len(problem.tasks)

    def wrong(problem):
        return returned(m, n)

    with pytest.raises(muster.ParameterError) as refusal:
        solved(wrong)
    assert f"allocator wrong: {message.format(m=m, n=n, last=n - 1)}" in str(refusal.value)


def nothing():
    return []


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (nothing, "no parameters; expected the problem as the first"),
        (lambda problem, sead: [], "expected a default, or one of stop, seed, params, start; did you mean 'seed'?"),
        (3, "allocator: 3; expected a name, an Allocator or a function"),
        ("serch", "did you mean 'search'?"),
    ],
)
def test_what_cannot_be_called_as_an_allocator_is_refused(function, message):
    with pytest.raises(muster.ParameterError) as refusal:
        allocator_of(function)
    assert message in str(refusal.value)


def test_parameters_of_functions_are_of_the_kind_of_their_defaults():
    seen = []

    def flagged(problem, fast=True, most=2_000_000, name="x"):
        seen.append((fast, most, name))
        return nearest(problem, None, 0)

    mission = muster.load("6T-2R")
    muster.solve(mission, flagged)
    muster.solve(mission, flagged, parameters={"fast": False, "most": 3_000_000, "name": "y"})
    assert seen == [(True, 2_000_000, "x"), (False, 3_000_000, "y")]
    for name, value, expected in (("fast", 1, "true or false"), ("most", True, "a number")):
        with pytest.raises(muster.ParameterError, match=f"^{name}: .*; expected {expected}$"):
            muster.solve(mission, flagged, parameters={name: value})


def test_a_function_says_which_rules_it_keeps():
    def one_each(problem):
        return [[i] if problem.may(i, i) else [] for i in range(len(problem.robots))]

    (mission,) = muster.generate("windows", robots=2, tasks=4)
    with pytest.raises(muster.ParameterError, match=r"window.*greedy.*by its attribute can \(docs/extending.md\)$"):
        muster.solve(mission, one_each)
    one_each.can = ["window"]
    assert muster.verify(mission, muster.solve(mission, one_each)).valid
    for wrong, said in (
        (["windw"], "\"windw\"; expected a set of words of .*'window'"),
        ("window", '"window"; expected a set'),
        (3, "3; exp"),
    ):
        one_each.can = wrong
        with pytest.raises(muster.ParameterError, match=f"^allocator one_each: can: {said}"):
            allocator_of(one_each)


def test_routes_that_deadlock_are_refused_in_one_line():
    def waiting_for_each_other(problem):
        j = next(j for j, before in enumerate(problem.prerequisites) if before)
        return [[j, *problem.prerequisites[j]], *([] for _ in problem.robots[1:])]

    with pytest.raises(muster.ParameterError, match=r"^routes: tasks wait for each other for ever; expected"):
        solved(waiting_for_each_other)


MISSIONS = {
    "euclidean": {},
    "in time": {"usage": "time", "return_to_start": True},
    "profile": {"usage": "time", "timing": "profile"},
}


def tour(problem):
    """Give the first robot all tasks that it may do, in order."""
    return [[j for j in range(len(problem.tasks)) if problem.may(0, j)], *([] for _ in problem.robots[1:])]


@pytest.mark.parametrize("rules", MISSIONS.values(), ids=MISSIONS)
def test_the_legs_of_a_problem_sum_to_what_the_judge_measures(rules):
    """docs/extending.md, Distances: usage is the sum of legs, work and the way to the end of the route."""
    first, second = (Robot(id=name, position=(k, 1), speed_mps=2, acceleration_mps2=1) for k, name in enumerate("ab"))
    tasks = tuple(
        Task(id=str(k), position=(3 * k, k * k), exit=(3 * k, 9), duration_s=2, actuation_cost=k) for k in range(4)
    )
    mission = muster.Mission(rules=Rules(**rules), robots=(first, second), tasks=tasks)
    problem = Problem.compile(mission)
    assert_legs_are_those_of_the_judge(mission, problem)


@pytest.mark.parametrize("name", ["depot", "31T-6R50", "field-survey"])
def test_the_legs_of_shipped_missions_sum_to_what_the_judge_measures(name):
    mission = muster.load(name)
    assert_legs_are_those_of_the_judge(mission, Problem.compile(mission))


def assert_legs_are_those_of_the_judge(mission, problem):
    (route, *_) = routes = tour(problem)
    robot = problem.robots[0]
    places = [problem.start(0), *route]
    legs = problem.legs(0, places, [*route, problem.end(0)])
    usage = sum(float(legs[k, k]) for k in range(len(route))) + float(problem.work_usage(0)[route].sum())
    if robot.place_at_end(mission.rules) is not None:
        usage += float(legs[len(route), len(route)])
    by_robot = {r.id: [problem.tasks[j].id for j in own] for r, own in zip(problem.robots, routes, strict=True)}
    verdict = muster.verify(mission, by_robot)
    judged = next(figures.usage for figures in verdict.routes if figures.robot == robot.id)
    assert usage == pytest.approx(judged, rel=1e-6)
