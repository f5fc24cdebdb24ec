"""What the monitor notices of one robot."""

import pytest
from tests.execution.world import Point

from muster import Robot
from muster.execution.robots.monitor import Limits, exceeds, is_silent, is_stuck
from muster.execution.robots.robot_state import Activity, RobotState
from muster.mission.errors import ParameterError
from muster.motion.leg_times import LegTimes
from muster.motion.port import Waypoint
from muster.state.robots import KnownRobot


def driving(speed=1.0, way=100.0):
    robot = Robot(id="r", position=(0, 0), speed_mps=speed)
    point = Point(robot)
    state = RobotState(robot, KnownRobot(robot), point, None, LegTimes(speed), in_time=False, last_heard_s=0.0)
    point.step(0.0)
    state.hear(0.0)
    state.send(0.0, Activity.DRIVING, [Waypoint((way, 0.0, 0.0))])
    return state, point


def stuck_at(state, point, until, limits):
    now = 0.0
    while now < until:
        point.step(0.5)
        now += 0.5
        state.hear(now)
        if is_stuck(state, now, limits):
            return now
    return None


def test_telemetry_is_missed_after_the_limit():
    state, point = driving()
    limits = Limits(silent_after_s=5)
    point.step(1.0)
    state.hear(1.0)
    point.mute = True
    point.step(5.0)
    state.hear(6.0)
    assert not is_silent(state, 6.0, limits)
    assert is_silent(state, 6.1, limits)


@pytest.mark.parametrize("speed", [0.05, 0.26, 5.0])
def test_a_robot_that_gets_on_is_not_stuck(speed):
    state, point = driving(speed, way=200 * speed)
    assert stuck_at(state, point, 195, Limits(stuck_after_s=10)) is None


def test_a_robot_that_stands_is_stuck_after_the_limit():
    state, point = driving()
    point.broken = True
    assert stuck_at(state, point, 100, Limits(stuck_after_s=10)) == pytest.approx(10.5, abs=0.6)


def test_a_robot_far_slower_than_it_should_be_is_stuck():
    state, point = driving()
    point.speed = 0.02
    assert stuck_at(state, point, 200, Limits(stuck_after_s=10)) is not None


def test_capacity_with_room_for_rounding():
    assert not exceeds(1e9, None)
    assert not exceeds(10.0, 10.0)
    assert exceeds(10.001, 10.0)


@pytest.mark.parametrize("limit", ["silent_after_s", "stuck_after_s", "aside_s", "jam_after_s", "look_every_s"])
def test_limits_are_above_0(limit):
    with pytest.raises(ParameterError, match=f"{limit}: 0; expected seconds above 0"):
        Limits(**{limit: 0})
