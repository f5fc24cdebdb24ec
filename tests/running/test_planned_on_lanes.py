"""What is planned along lanes is what is driven: by all allocators, in free and in managed traffic."""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from tests.motion.lane_missions import LIMITS, missions

from muster import Mission, Robot, Rules, Task, simulate, solve, verify
from muster.mission.errors import MissionError
from muster.mission.lanes import Lane, Lanes

AGREE = 0.1
"""By how much the time that is flown may differ from the planned one where nobody waits."""
YAW_RATE_RADPS = 1.5
TURN_S = math.pi / 2 / YAW_RATE_RADPS + 0.2
"""By how much the first turn of a leg may differ from one by a right angle, and what a step of the world adds."""
LOOP = Lanes(
    nodes={"a": (0, 0), "b": (30, 0), "c": (30, 10), "d": (0, 10)},
    edges=tuple(Lane(start=a, end=b) for a, b in ("ab", "bc", "cd", "da")),
)


def one_way_loop(**rules):
    """Work is ahead of one robot and behind the other, for both as near as can be the other way round."""
    robots = tuple(Robot(id=name, position=at, radius_m=0.3) for name, at in (("r1", (14, 0)), ("r2", (16, 10))))
    tasks = (Task(id="t1", position=(10, 0)), Task(id="t2", position=(20, 10)))
    return Mission(rules=Rules(objective="makespan", **rules), lanes=LOOP, robots=robots, tasks=tasks)


@pytest.mark.parametrize("allocator", ["search", "greedy", "auction", "consensus-bundle", "market", "genetic"])
def test_allocators_plan_along_one_way_lanes(allocator):
    mission = one_way_loop()
    plan = solve(mission, allocator, time_limit=0.5, seed=1)
    assert {route.robot: route.tasks for route in plan.routes} == {"r1": ("t2",), "r2": ("t1",)}
    verdict = verify(mission, plan)
    assert (verdict.valid, verdict.makespan_s) == (True, pytest.approx(36.0))


def test_the_exact_bound_is_along_lanes_too():
    pytest.importorskip("ortools")
    plan = solve(one_way_loop(), "greedy", bound="exact", time_limit=5.0)
    assert plan.lower_bound == pytest.approx(36.0, abs=1e-3)


@pytest.mark.parametrize("traffic", ["auto", "free", "reserve"])
def test_they_are_driven_as_planned(traffic):
    mission = one_way_loop()
    report = simulate(mission, solve(mission, "greedy"), traffic=traffic)
    assert (len(report.tasks_done), report.contacts) == (2, 0)
    assert report.mission_time_s == pytest.approx(36.0, rel=AGREE)


def test_who_asks_for_straight_travel_gets_it_planned_and_driven():
    mission = one_way_loop(travel="euclidean")
    plan = solve(mission, "greedy")
    report = simulate(mission, plan)
    assert {route.robot: route.tasks for route in plan.routes} == {"r1": ("t1",), "r2": ("t2",)}
    assert report.mission_time_s == pytest.approx(plan.makespan_s, rel=AGREE) == pytest.approx(4.0, rel=AGREE)


def alone(mission):
    """With a robot that states all that its times depend on, and tasks that are left where they are entered."""
    robot = replace(mission.robots[0], radius_m=0.3, acceleration_mps2=1.0, yaw_rate_radps=YAW_RATE_RADPS)
    tasks = tuple(replace(task, exit=None) for task in mission.tasks)
    return replace(mission, robots=(robot,), tasks=tasks)


@pytest.mark.long
@settings(max_examples=15)
@given(mission=missions(kinds=("ground",), limits=LIMITS[1:], most=1).map(alone))
def test_a_lone_robot_takes_the_time_that_is_planned(mission):
    try:
        plan = solve(mission, "greedy", objective="makespan")
    except MissionError:  # it starts where no lane that it can drive is near
        assume(False)
    planned = verify(mission, plan, objective="makespan")
    assert planned.valid
    report = simulate(mission, plan, traffic="reserve")
    assert len(report.tasks_done) == planned.tasks_completed
    flown_s = max(report.ends_s.values(), default=0.0)
    turns_s = len(mission.tasks) * TURN_S  # of a leg the first turn is reckoned as one by a right angle
    assert flown_s == pytest.approx(planned.makespan_s, rel=AGREE, abs=turns_s)
