"""What a robot would need to do a task: examples with exact numbers, and all plans there are."""

import math
from dataclasses import replace

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from tests.all_plans import AllPlans
from tests.allocation.test_conflicts import crowded, judge, mission, robot, task
from tests.mission.strategies import examples, tiny_missions
from tests.random_missions import random_mission

from muster.allocation.algorithms import greedy
from muster.allocation.remedies.remedies import changed, remedies, smallest, smallest_as_is
from muster.allocation.remedies.remedy import Before
from muster.allocation.stop import Stop
from muster.mission.model import Mission, Rules, TravelTable
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem
from muster.model.rules.capacity import CapacityChange
from muster.model.rules.suitability import LowScore
from muster.verification import verify

ROUNDING = 1e-8


def look(asked, name, *routes, ignored=()):
    """What each robot would need to do a task beside the routes: lists of names, in the order of the robots."""
    problem = Problem.compile(asked, ignored=ignored)
    return remedies(problem, indices(problem, asked, routes), problem.task_index[name], judge)


def indices(problem, asked, routes):
    listed = [[] for _ in problem.robots]
    for one, names in zip(asked.robots, routes, strict=False):
        listed[problem.robot_index[one.id]] = [problem.task_index[name] for name in names]
    return listed


def one_of(asked, name, *routes, ignored=()):
    """What the first robot would need."""
    return look(asked, name, *routes, ignored=ignored)[0]


def works(asked, remedy, name):
    """Whether the judge admits the remedy's plan in the mission changed by hand of this test, and the robot does it."""
    assert remedy.enough
    by_id = {one.id: one for one in asked.robots}
    abler = by_id[remedy.robot]
    abler = replace(abler, skills=(*abler.skills, *remedy.as_dict()["skills"]))
    if remedy.capacity.now is not None:
        abler = replace(abler, work_capacity=remedy.capacity.enough)
    table = asked.suitability
    low = remedy.changes.get("suitability")
    if low is not None:
        table = {**table, low.robot_type: {**table[low.robot_type], low.task_type: low.needed}}
    freer = [
        replace(one, only_robots=(*one.only_robots, remedy.robot))
        if "lock" in remedy.changes and one.id == name
        else one
        for one in asked.tasks
    ]
    team = [abler if one.id == remedy.robot else one for one in asked.robots]
    new = replace(asked, robots=tuple(team), tasks=tuple(freer), suitability=table)
    route = next(route for route in remedy.routes if route.robot == remedy.robot)
    return name in route.tasks and verify(new, Plan(routes=remedy.routes)).valid


# --- skills, scores, locks -------------------------------------------------------------------------------------------

TABLE = {"beta": {"D": 0.9, "E": 0.5}, "tau": {"D": 0.3, "E": 0.8}}


def test_the_skills_that_are_lacking():
    asked = mission([robot(skills=("camera",))], [task("lift", 1, 0, requires=("camera", "gripper", "arm"))])
    found = one_of(asked, "lift")
    assert (found.changes["skill"].skills, found.kinds, found.enough) == (("gripper", "arm"), ("skill",), True)
    assert works(asked, found, "lift")
    assert one_of(asked, "lift", ignored=("skills",)).kinds == ()


def test_the_score_that_is_too_low():
    asked = replace(mission([robot(type="beta")], [task("1", 1, 0, type="E")], min_suitability=0.6), suitability=TABLE)
    found = one_of(asked, "1")
    assert found.changes["suitability"] == LowScore("beta", "E", 0.5, 0.6)
    assert found.kinds == ("suitability",)
    assert works(asked, found, "1")


def test_the_lock():
    asked = mission([robot("r_0"), robot("r_1")], [task("1", 1, 0, only_robots=("r_1",))])
    first, second = look(asked, "1")
    assert (first.as_dict()["lock"], first.kinds, second.as_dict()["lock"]) == (("r_1",), ("lock",), None)
    assert works(asked, first, "1")


def test_all_of_them_at_once_and_the_robot_that_needs_least():
    work = task("1", 20, 0, type="E", requires=("arm",), only_robots=("r_1",))
    team = [robot("r_0", type="beta", work_capacity=15), robot("r_1", type="tau", work_capacity=15)]
    asked = replace(mission(team, [work]), suitability=TABLE)
    found = look(asked, "1")
    assert found[0].kinds == ("skill", "suitability", "lock", "capacity")
    assert found[1].kinds == ("skill", "capacity")
    assert all(works(asked, one, "1") for one in found)
    assert smallest(found) is found[1]
    problem = Problem.compile(asked)
    assert smallest_as_is(problem, [[], []], 0, judge).kinds == ("skill", "capacity")


# --- capacity --------------------------------------------------------------------------------------------------------

EAST, WEST = task("east", 40, 0), task("west", -40, 0)


def test_the_capacity_for_two_tasks():
    asked = mission([robot(work_capacity=60)], [EAST, WEST])
    found = one_of(asked, "west", ["east"])
    assert found.capacity == CapacityChange(now=60, as_is=120, at_least=120, enough=120)
    assert works(asked, found, "west")
    assert one_of(asked, "west", ["east"], ignored=("capacity",)).kinds == ()


@pytest.mark.parametrize(("reserve", "needed"), [(0.2, 150), (0.5, 240)])
def test_the_reserve_is_part_of_the_capacity(reserve, needed):
    asked = mission([robot(work_capacity=60)], [EAST, WEST], capacity_reserve=reserve)
    found = one_of(asked, "west", ["east"])
    assert found.capacity == CapacityChange(now=60, as_is=needed, at_least=needed, enough=needed)
    assert works(asked, found, "west")


def shared_yard():
    """r_0 does a, r_1 does b; c is 15 m from r_0, the other way."""
    team = [robot("r_0", work_capacity=20, skills=("C",)), robot("r_1", 20, 0, work_capacity=20)]
    return mission(team, [task("a", 5, 0), task("b", 15, 0), task("c", 0, 15, requires=("C",))])


def test_tasks_that_can_be_moved_need_no_capacity():
    asked = shared_yard()
    found = one_of(asked, "c", ["a"], ["b"])
    assert found.kinds == ()
    assert found.capacity.as_is == pytest.approx(5 + math.hypot(5, 15))
    assert works(asked, found, "c")
    assert {name for route in found.routes for name in route.tasks} == {"a", "b", "c"}


def test_less_capacity_where_tasks_can_be_moved():
    """With the plan as it is r_1 goes to b first, then to c; alone it goes straight to c, 25 m away."""
    asked = shared_yard()
    found = look(asked, "c", ["a"], ["b"])[1]
    assert found.kinds == ("skill", "capacity")
    assert found.capacity.as_is == pytest.approx(5 + math.hypot(15, 15))
    assert (found.capacity.at_least, found.capacity.enough) == (25, 25)
    assert works(asked, found, "c")


def test_a_task_that_is_done_by_another():
    asked = mission([robot("r_0", work_capacity=9), robot("r_1")], [task("a", 10, 0), task("b", -2, 0)])
    first, second = look(asked, "a", ["b"], ["a"])
    assert first.capacity == CapacityChange(now=9, as_is=14, at_least=10, enough=10)
    assert works(asked, first, "a")
    assert (second.kinds, second.capacity.now, second.enough) == ((), None, True)


def test_what_bounds_a_capacity_among_many_tasks():
    """Of the tasks that only r_0 can do the ten that are hardest are looked at; the bound is below what is found."""
    row = [task(str(k), k, 0, only_robots=("r_0",)) for k in range(15)]
    asked = mission([robot("r_0", work_capacity=20), robot("r_1")], [*row, task("back", -9, 0)])
    found = one_of(asked, "back", [str(k) for k in range(15)])
    assert found.capacity == CapacityChange(now=20, as_is=32, at_least=32, enough=32)
    free = [replace(one, only_robots=None) for one in row]
    found = one_of(replace(asked, tasks=(*free, task("back", -21, 0))), "back", [str(k) for k in range(15)])
    assert (found.capacity.at_least, found.capacity.enough, found.capacity.as_is) == (21, 21, 49)


def test_a_plan_that_breaks_rules_is_enough_for_nothing():
    """r_1 does more than it has capacity for: the plan stays wrong whatever r_0 has, but not if r_1 has more."""
    team = [robot("r_0", work_capacity=5), robot("r_1", work_capacity=5)]
    work = [task("a", 1, 0), task("b", 20, 0, only_robots=("r_1",))]
    asked = mission(team, work)
    found = one_of(asked, "a", [], ["b"])
    assert (found.enough, found.impossible, found.routes) == (False, True, ())
    short = smallest_as_is(Problem.compile(asked), [[], [1]], 0, judge)
    assert (short.robot, short.capacity) == ("r_1", CapacityChange(now=5, as_is=20, enough=20))


# --- prerequisites, ways ---------------------------------------------------------------------------------------------


def test_a_prerequisite_that_is_left_out():
    asked = mission([robot(work_capacity=10)], [task("then", -4, 0, prerequisites=("first",)), task("first", 4, 0)])
    found = one_of(asked, "then")
    assert found.before == (Before("first", possible=True),)
    assert found.kinds == ("prerequisite", "capacity")
    assert found.capacity == CapacityChange(now=10, as_is=None, at_least=12, enough=12)
    assert works(asked, found, "then")
    assert smallest_as_is(Problem.compile(asked), [[]], 1, judge).kinds == ("prerequisite",)


def test_a_prerequisite_that_can_never_be_done():
    work = [task("then", 1, 0, prerequisites=("first",)), task("first", 1, 0, requires=("arm",))]
    found = one_of(mission([robot()], work), "then")
    assert found.before == (Before("first", possible=False),)
    assert (found.enough, found.impossible) == (False, True)


def test_the_skill_for_a_task_is_one_for_its_prerequisite():
    work = [task("then", 1, 0, prerequisites=("first",), requires=("arm",)), task("first", 1, 0, requires=("arm",))]
    asked = mission([robot()], work)
    found = one_of(asked, "then")
    assert found.before == (Before("first", possible=True),)
    assert (found.kinds, works(asked, found, "then")) == (("skill", "prerequisite"), True)


def test_no_way():
    inf = math.inf
    asked = Mission(
        robots=(robot(type="beta", work_capacity=1),),
        tasks=(task("1", 1, 0), task("2", 1, 0)),
        rules=Rules(travel="matrix"),
        travel={"beta": "beta.csv"},
        travel_tables={"beta": TravelTable(("r_0", "1", "2"), ((0, 3, inf), (3, 0, inf), (1, 1, 0)))},
    )
    found = one_of(asked, "2")
    assert (found.unreachable, found.impossible, found.enough) == (True, True, False)
    assert found.capacity == CapacityChange(now=1)
    assert one_of(asked, "1").capacity == CapacityChange(now=1, as_is=3, at_least=3, enough=3)
    assert smallest_as_is(Problem.compile(asked), [[]], 1, judge) is None


# --- against all plans there are -------------------------------------------------------------------------------------


def check_task(asked, name, routes, remedy):
    """Whether what is said of a robot and a task is true of all plans of the changed mission."""
    problem = Problem.compile(asked)
    i, j = problem.robot_index[remedy.robot], problem.task_index[name]
    new = changed(problem, replace(remedy, capacity=replace(remedy.capacity, enough=None)), i, j).mission
    k = [one.id for one in asked.robots].index(remedy.robot)
    wanted = {name}.union(*routes)
    plans = AllPlans(new, unlimited=remedy.robot)
    usages = [
        plans.usage(k, plan[k]) for plan in plans.admissible() if name in plan[k] and wanted <= set().union(*plan)
    ]
    least = min(usages, default=math.inf) / (1 - asked.rules.capacity_reserve)
    now, capacity = remedy.capacity.now, remedy.capacity
    assert capacity.at_least is None or capacity.at_least <= least * (1 + ROUNDING)
    assert not remedy.impossible or least == math.inf
    if remedy.enough:
        assert works(asked, remedy, name)
        assert wanted <= {task for route in remedy.routes for task in route.tasks}
        assert least <= (math.inf if now is None else capacity.enough) * (1 + ROUNDING)
        if not capacity.grows and now is not None:
            assert least <= now * (1 + ROUNDING)
    if capacity.as_is is not None:
        check_as_is(plans, k, name, routes, capacity.as_is * (1 - asked.rules.capacity_reserve))
    return remedy.enough, least


def check_as_is(plans, k, name, routes, usage):
    """The usage is the least over all places in the robot's route at which no robot waits in a circle."""
    rest = [tuple(other for other in route if other != name) for route in routes]
    around = [(*rest[k][:at], name, *rest[k][at:]) for at in range(len(rest[k]) + 1)]
    ordered = [route for route in around if (*rest[:k], route, *rest[k + 1 :]) in plans.plans]
    assert usage == pytest.approx(min(plans.usage(k, route) for route in ordered), rel=ROUNDING)


def check_all(asked):
    """Everything said of the greedy plan; how often a plan was found, and how often there is one."""
    problem = Problem.compile(asked)
    found = greedy.allocate(problem, Stop(), 0, greedy.Parameters(), None).routes
    routes = [[problem.tasks[j].id for j in found[problem.robot_index[one.id]]] for one in asked.robots]
    results = []
    for one in [one.id for one in asked.tasks][:3]:
        results += [check_task(asked, one, routes, remedy) for remedy in look(asked, one, *routes)]
        short = smallest_as_is(problem, found, problem.task_index[one], judge)
        if short is not None and short.enough:
            assert works(asked, short, one)
    return results


seeds = st.integers(0, 10**6)


@pytest.mark.long
@examples(25)
@given(seed=seeds, tasks=st.integers(2, 5), robots=st.integers(2, 3))
def test_what_is_said_of_random_missions_is_true(seed, tasks, robots):
    check_all(random_mission(seed, tasks=tasks, robots=robots))


@pytest.mark.long
@examples(5)
@given(seed=seeds)
def test_what_is_said_of_six_tasks_is_true(seed):
    check_all(random_mission(seed, tasks=6, robots=2))


LATENESS = mission([robot(), robot("r_1")], [task("0", 0, 0), task("1", 0, 1)], objective="lateness")
"""Where no task is ever late, any place costs the same; the remedy names the one that takes least."""


@pytest.mark.long
@examples(50)
@given(asked=tiny_missions(max_robots=2, max_tasks=4))
@example(asked=LATENESS)
def test_what_is_said_of_tiny_missions_is_true(asked):
    check_all(asked)


@pytest.mark.long
def test_what_could_be_is_found():
    results = [one for seed in range(12) for one in check_all(crowded(seed, tasks=4))]
    possible = [enough for enough, least in results if least < math.inf]
    assert len(possible) > 50
    assert all(possible)


def test_plans_of_nothing():
    asked = mission([robot()], [task("1", 1, 0)])
    found = one_of(asked, "1")
    assert found.routes == (Route("r_0", ("1",)),)
    assert (found.kinds, found.capacity) == ((), CapacityChange(now=None, as_is=1, enough=None))
