"""The time of a leg by the motion profile: in Python, in the core, and in the simulated world."""

import math
from dataclasses import replace

import numpy as np
import pytest

import muster
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.reading.plan_reader import plan_of
from muster.model.problem import Problem
from muster.motion.leg_times import LegTimes

ROBOTS = (
    {},
    {"acceleration_mps2": 1.0},
    {"acceleration_mps2": 0.5, "speed_mps": 2.0},
    {"kinematics": "differential-drive", "yaw_rate_radps": 0.5},
    {"kinematics": "differential-drive", "yaw_rate_radps": 1.0, "acceleration_mps2": 0.3},
    {"kinematics": "quadcopter", "kind": "air", "climb_mps": 0.5, "acceleration_mps2": 2.0, "speed_mps": 3.0},
)


def mission_of(robot, goal, timing="profile", heading=90.0):
    robot = Robot(id="r", position=(0.0, 0.0, 0.0), heading_deg=heading, **robot)
    return Mission(robots=(robot,), tasks=(Task(id="a", position=goal, duration_s=1.0),), rules=Rules(timing=timing))


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("goal", [(10.0, 0.0, 0.0), (0.7, 0.0, 0.0), (6.0, 0.0, 8.0), (0.0, 0.0, 2.0), (0.0, 0.0, 0.0)])
def test_planner_judge_and_core_agree(robot, goal):
    mission = mission_of(robot, goal)
    plan = muster.solve(mission, "greedy")
    problem = Problem.compile(mission)
    seconds = float(problem.travel_seconds(0, [problem.start(0)], [0])[0, 0])
    assert plan.makespan_s == pytest.approx(seconds + 1.0, abs=1e-9)
    assert muster.verify(mission, plan).makespan_s == pytest.approx(seconds + 1.0, abs=1e-9)


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_profile_is_what_the_world_flies(robot):
    goal = (6.0, 0.0, 8.0) if robot.get("kind") == "air" else (10.0, 0.0, 0.0)
    mission = mission_of(robot, goal)
    flown = muster.simulate(mission, plan_of({"r": ["a"]})).ends_s
    planned = muster.verify(mission, plan_of({"r": ["a"]})).makespan_s
    assert max(flown.values()) == pytest.approx(planned, abs=0.35)


def test_a_trapezoid_and_a_triangle():
    times = LegTimes(2.0, acceleration_mps2=0.5)
    assert times.seconds([20.0, 8.0, 2.0, 0.0]).tolist() == [14.0, 8.0, 4.0, 0.0]
    assert LegTimes(2.0, climb_mps=0.5).seconds(10.0, 6.0) == 12.0
    assert LegTimes(2.0, turn_s=1.5).seconds([4.0, 0.0]).tolist() == [3.5, 0.0]


def test_a_bent_way_is_turned_by_the_least_angle_and_has_stops():
    sliding = LegTimes(1.0, acceleration_mps2=0.5, over_map=True)
    turning = replace(sliding, turn_s=3.0)
    apart = 24.0 * math.cos(math.pi / 6)  # two equal pieces that make an angle of 60 degrees
    assert sliding.seconds(24.0, 0.0, apart) == pytest.approx(24.0 + 2 * 2.0)
    assert turning.seconds(24.0, 0.0, apart) == pytest.approx(24.0 + 3 * 2.0 + 3.0 * (1 + 60 / 90))
    assert turning.seconds(24.0, 0.0, 24.0) == 24.0 + 2.0 + 3.0
    assert replace(turning, over_map=False).seconds(24.0, 0.0, apart) == 24.0 + 2.0 + 3.0


def test_work_that_drives_stops_and_turns_at_each_way_point():
    times = LegTimes(1.0, acceleration_mps2=1.0, turn_s=2.0)
    square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0)]
    assert times.work_seconds(square, [4.0] * 4) == pytest.approx(4 * 5.0 + 4 * 2.0)
    assert times.work_seconds(square[:1], []) == 0.0
    assert LegTimes(2.0).work_seconds(square, [4.0] * 4) == 8.0


def test_the_rest_of_a_leg_takes_less_than_a_leg():
    times = LegTimes(1.0, acceleration_mps2=0.5, turn_s=2.0)
    assert times.rest_seconds(10.0) == pytest.approx(10.0 + 1.0)
    assert times.rest_seconds(0.5) == pytest.approx(math.sqrt(2 * 0.5 / 0.5))
    assert times.rest_seconds(0.0) == 0.0
    assert times.least_seconds(10.0) == 12.0


def test_constant_timing_takes_the_speed_alone():
    mission = mission_of(ROBOTS[4], (10.0, 0.0, 0.0), timing="constant")
    assert muster.solve(mission, "greedy").makespan_s == 11.0
    assert LegTimes.in_mission(mission.robots[0], mission).is_constant


def test_a_right_angle_is_turned_by_what_drives_where_it_looks():
    turning, sliding = (
        Robot(id="r", position=(0, 0), yaw_rate_radps=0.5, kinematics=k) for k in ("differential-drive", "holonomic")
    )
    assert LegTimes.of(turning, Rules(), over_map=False).turn_s == math.pi
    assert LegTimes.of(sliding, Rules(), over_map=False).turn_s == 0.0


def test_longer_legs_take_longer():
    times = LegTimes(1.3, acceleration_mps2=0.4, climb_mps=0.2, turn_s=1.0)
    assert (np.diff(times.seconds(np.linspace(0, 30, 400), 0.05)) > 0).all()
