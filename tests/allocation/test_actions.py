"""Tasks whose way points tell what they cost: plans are made of what the judge finds, for every robot and leg."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from tests.action_missions import random_mission

import muster
from muster import Mission, Robot, Rules, Task
from muster.allocation.bounds.feasibility import impossible
from muster.mission.model import Action, Camera, Map, Zone
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem
from muster.verification.travel import Travel, doing_at, place_at_end, place_of_start, place_of_task

CASES = [*((seed, False) for seed in range(8)), *((seed, True) for seed in range(4))]
CAMERA = Camera(fov_deg=90, tilt_deg=90)


def a_mission(seed, over_map):
    return random_mission(seed, spatial=False if over_map else None, over_map=over_map)


def assert_as_judged(mission, problem, rel):
    """Legs and costs of all pairs that are allowed; where an action's own way is blocked, no way leads to its task."""
    travel, in_time = Travel(mission), mission.rules.usage == "time"
    for i, robot in enumerate(problem.robots):
        own = [j for j in range(len(problem.tasks)) if problem.may(i, j)]
        places = [(j, place_of_task(problem.tasks[j], robot)) for j in own]
        costs = {j: travel.work_metres(robot, problem.tasks[j]) for j in own}
        start, end = (problem.start(i), place_of_start(robot)), place_at_end(robot, mission.rules)
        legs = [(a, b) for a in [start, *places] for b in places if a is not b]
        legs += [(a, (problem.end(i), end)) for a in places] if end is not None else []
        for (a, here), (b, there) in legs:
            metres = None if costs.get(b, 0.0) is None else travel.metres(robot, here, there)
            usage = math.inf if metres is None else metres / robot.speed_mps if in_time else metres
            assert problem.legs(i, [a], [b])[0, 0] == pytest.approx(usage, rel=rel, abs=1e-9)
        for j, cost in costs.items():
            task = problem.tasks[j]
            duration = task.action.duration_s if task.action and task.action.duration_s is not None else task.duration_s
            seconds = (cost or 0.0) / robot.speed_mps if duration is None else duration / robot.efficiency
            assert problem.work_usage(i)[j] == pytest.approx(seconds if in_time else cost or 0.0, rel=rel)


@pytest.mark.parametrize(("seed", "over_map"), CASES)
def test_legs_and_costs_are_those_of_the_judge(seed, over_map):
    mission = a_mission(seed, over_map)
    assert_as_judged(mission, Problem.compile(mission), rel=1e-6)


@pytest.mark.parametrize("seed", range(2))
def test_in_space_over_a_map_they_are_nearly(seed):
    mission = random_mission(seed, tasks=4, robots=2, spatial=True, over_map=True)
    assert_as_judged(mission, Problem.compile(mission), rel=1e-2)


@pytest.mark.parametrize(("seed", "over_map"), CASES)
def test_who_may_do_what_is_what_the_judge_says(seed, over_map):
    problem = Problem.compile(a_mission(seed, over_map))
    for i, robot in enumerate(problem.robots):
        for j, task in enumerate(problem.tasks):
            found = doing_at(robot, task)
            reason = getattr(found, "reason", None)
            assert problem.refusal(i, j) == (None if reason is None else ("skill", reason))


@pytest.mark.long(keep=2)
@pytest.mark.parametrize(("seed", "over_map"), CASES)
def test_plans_are_admissible(seed, over_map):
    """By each of four allocators, over a map and without."""
    allocator = ("search", "greedy", "auction", "consensus-bundle")[seed % 4]
    mission = a_mission(seed, over_map)
    limits = {"iterations": 100} if allocator == "search" else {}
    plan = muster.solve(mission, allocator, seed=seed, **limits)
    verdict = muster.verify(mission, plan)
    assert verdict.valid
    never = {item.task for item in impossible(Problem.compile(mission))}
    assert never <= {left.task for left in plan.unassigned}
    assert plan.routes


@pytest.mark.long
@pytest.mark.parametrize("over_map", [False, True])
def test_there_is_something_to_test(over_map):
    """Of each action some robot does one, some robots cannot, and over the map some are blocked."""
    done, refused, blocked = set(), set(), 0
    for seed in range(3):
        mission = a_mission(seed, over_map)
        problem = Problem.compile(mission)
        plan = muster.solve(mission, "greedy")
        names = {task.id: task.action.name if task.action else None for task in mission.tasks}
        done |= {names[name] for route in plan.routes for name in route.tasks}
        lacking = np.argwhere(~problem.allowed)
        refused |= {problem.tasks[j].action.name for _, j in lacking}
        if over_map:
            blocked += int(np.isinf(problem._over_map.costs).sum())
    assert done == {
        None,
        "go-to-goal",
        "sensor-activation",
        "stationary-observation",
        "raster-search",
        "ground-patrol",
        "delivery",
    }
    assert "stationary-observation" in refused
    assert (blocked > 0) == over_map


@pytest.mark.parametrize("over_map", [False, True])
def test_a_part_costs_what_it_costs_in_the_whole(over_map):
    problem = Problem.compile(replace(a_mission(3, over_map)))
    robots, tasks = [0, 1, 3], [2, 4, 5, 6]
    part = problem.part(robots, tasks)
    for one in (part, pickle.loads(pickle.dumps(part))):
        for k, i in enumerate(robots):
            np.testing.assert_array_equal(one.work_usage(k), problem.work_usage(i)[tasks])
            mine = [a for a, j in enumerate(tasks) if problem.may(i, j)]
            theirs = [tasks[a] for a in mine]
            np.testing.assert_allclose(
                one.legs(k, [one.start(k), *mine], mine), problem.legs(i, [problem.start(i), *theirs], theirs)
            )


@pytest.mark.long
@pytest.mark.parametrize("over_map", [False, True])
def test_a_team_with_actions_can_be_divided(over_map):
    mission = random_mission(2, tasks=28, over_map=over_map, spatial=False)
    plan = muster.solve(mission, iterations=300, parts=2)
    assert muster.verify(mission, plan).valid
    assert plan.tasks_completed > 14


def looked_at(*robots, **more):
    look = Action(name="stationary-observation", width_m=4)
    return Mission(robots=robots, tasks=(Task(id="look", position=(10, 0), action=look, **more),))


def test_straight_travel_needs_no_table_where_all_robots_see_alike():
    one = Robot(id="a", position=(0, 0), kind="air", camera=CAMERA)
    blind = Robot(id="b", position=(0, 0))
    tilted = replace(one, id="c", camera=Camera(fov_deg=90, tilt_deg=60))
    assert len(Problem.compile(looked_at(one, blind)).travel[0]) == 0
    assert len(Problem.compile(looked_at(one, blind, tilted)).travel[0]) == 2


def test_who_is_nearer_by_where_its_camera_puts_it_goes():
    """Both start at the same place; the one that looks ahead stands 10 - r away, the other at the target."""
    down = Robot(id="down", position=(0, 0), camera=CAMERA)
    ahead = Robot(id="ahead", position=(0, 0), camera=Camera(fov_deg=60, tilt_deg=45))
    mission = looked_at(down, ahead)
    plan = muster.solve(mission, iterations=50)
    assert {route.robot: route.tasks for route in plan.routes} == {"down": (), "ahead": ("look",)}
    assert muster.verify(mission, plan).total_cost == pytest.approx(10 - 2 / (math.sqrt(3) - 1))


def test_what_no_robot_can_do_is_impossible_and_says_why():
    mission = looked_at(Robot(id="a", position=(0, 0)), Robot(id="b", position=(0, 0), camera=Camera(fov_deg=60)))
    (item,) = impossible(Problem.compile(mission, ignored=("skills",)))
    assert [(reason.reason, reason.detail) for reason in item.reasons] == [
        ("skill", "it has no camera"),
        ("skill", "its camera (tilt_deg 0) does not look down"),
    ]
    plan = Plan(routes=(Route("a", ("look",)),))
    verdict = muster.verify(mission, plan, ignore=("skills",))
    assert [(v.kind, v.robot, v.task, v.detail) for v in verdict.violations] == [
        ("skill", "a", "look", "it has no camera")
    ]


def walled(*tasks, **rules):
    wall = Zone(polygon=((9, -5), (11, -5), (11, 5), (9, 5)))
    arena = Map(boundary=((-20, -20), (40, -20), (40, 20), (-20, 20)), zones=(wall,))
    return Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=tasks, map=arena, rules=Rules(**rules))


def test_a_delivery_goes_around_the_wall():
    """From (5, 0) to (15, 0) over two corners of the wall: 2 sqrt(4**2 + 5**2) + 2."""
    mission = walled(Task(id="bring", position=(15, 0), action=Action(name="delivery", pickup=(5, 0))))
    verdict = muster.verify(mission, muster.solve(mission, iterations=10))
    assert verdict.valid
    assert verdict.routes[0].travel == pytest.approx(5)
    assert verdict.routes[0].work == pytest.approx(2 * math.hypot(4, 5) + 2)
    straight = replace(mission, rules=Rules(travel="euclidean"))
    assert muster.solve(straight, iterations=10).routes[0].tasks == ()
    straight = replace(straight, map=None)
    assert muster.verify(straight, muster.solve(straight, iterations=10)).routes[0].work == pytest.approx(10)


def test_an_action_with_a_way_point_in_a_wall_is_unreachable():
    search = Action(name="raster-search", side_m=4, height_m=2, spacing_m=2)
    mission = walled(Task(id="search", position=(12, 0), action=search), Task(id="else", position=(1, 1)))
    (item,) = impossible(Problem.compile(mission))
    assert [(r.reason, r.detail) for r in item.reasons] == [("unreachable", "goal blocked: (10, -2): inside zone 0")]
    patrol = replace(mission, tasks=(Task(id="p", position=(7, 0), action=Action(name="ground-patrol", side_m=6)),))
    (item,) = impossible(Problem.compile(patrol))
    (reason,) = item.reasons
    assert (reason.reason, reason.detail) == (
        "unreachable",
        "goal blocked on the way of its action: (10, 3): inside zone 0",
    )
    plan = Plan(routes=(Route("r", ("p",)),))
    assert [(v.kind, v.detail) for v in muster.verify(patrol, plan).violations] == [
        ("closed-area", "the work at (10, 3) enters zone 0")
    ]


@pytest.mark.parametrize(
    ("out", "why", "judged"),
    [
        ((10, 0), "(10, 0): inside zone 0", "(10, 0) enters zone 0"),
        ((-20.5, 0), "(-20.5, 0): outside the boundary", "(-20.5, 0) leaves the boundary"),
    ],
)
def test_an_exit_to_which_no_way_leads_is_unreachable_for_planner_and_judge(out, why, judged):
    mission = walled(Task(id="a", position=(7, 0), exit=out), Task(id="fine", position=(7, 0), exit=(15, 0)))
    (item,) = impossible(Problem.compile(mission))
    assert [(item.task, r.reason, r.detail) for r in item.reasons] == [
        ("a", "unreachable", f"goal blocked on the way to its exit: {why}")
    ]
    verdict = muster.verify(mission, Plan(routes=(Route("r", ("fine", "a")),)))
    assert [(v.kind, v.task, v.detail) for v in verdict.violations] == [("closed-area", "a", f"the work at {judged}")]
    plan = muster.solve(mission, iterations=10)
    assert (plan.routes[0].tasks, muster.verify(mission, plan).valid) == (("fine",), True)


def test_the_smallest_change_is_never_at_a_robot_that_cannot():
    mission = looked_at(
        Robot(id="able", position=(0, 0), camera=CAMERA, work_capacity=1), Robot(id="blind", position=(10, 0))
    )
    from muster.allocation.remedies.remedies import remedies, smallest, smallest_as_is

    problem = Problem.compile(mission)

    def judge(mission, plan, ignored):
        return muster.verify(mission, plan, ignored).valid

    found = remedies(problem, [[], []], 0, judge)
    assert [(r.robot, r.unable, r.enough) for r in found] == [("able", "", True), ("blind", "it has no camera", False)]
    assert smallest(found).robot == smallest_as_is(problem, [[], []], 0, judge).robot == "able"
    alone = looked_at(Robot(id="blind", position=(10, 0)))
    assert smallest_as_is(Problem.compile(alone), [[]], 0, judge) is None


@pytest.mark.parametrize("seed", range(4))
def test_bounds_hold_with_actions(seed):
    """The best of a long search is never below what is proven."""
    mission = random_mission(seed, tasks=6, robots=3, over_map=bool(seed % 2), spatial=False)
    plan = muster.solve(mission, seed=seed, iterations=400, bound="exact" if seed < 2 else "quick")
    if plan.lower_bound is not None:
        assert plan.lower_bound <= muster.verify(mission, plan).value() * (1 + 1e-9)
