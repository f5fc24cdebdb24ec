"""A fleet on ROS 2 that is stopped: all robots are told, with the test's own time and middleware."""

import pytest
from tests.muster_robots.ros2.fake_middleware import Middleware, posed

from muster.mission.errors import NetworkError
from muster.mission.model import Mission, Robot
from muster.motion.port import Waypoint
from muster_robots.ros2.fleet import Ros2Fleet

NAMES = ("r_0", "r_1", "r_2")


@pytest.fixture
def middleware():
    return Middleware()


@pytest.fixture
def fleet(middleware):
    """Three robots on their way."""
    robots = tuple(Robot(id=name, position=(0.0, 0.0)) for name in NAMES)
    fleet = Ros2Fleet(Mission(robots=robots, tasks=()), middleware=middleware, clock=middleware)
    say(middleware, 0.0)
    fleet.advance(0.1)
    for port in fleet.ports.values():
        port.send([Waypoint((50.0, 0.0, 0.0))])
    return fleet


def say(middleware, x):
    for name in NAMES:
        middleware.heard[f"/{name}/pose"].append(posed(x))


def told(middleware):
    return [[x for x, _ in middleware.told[f"/{name}/goal_pose"]] for name in NAMES]


def test_stop_hears_first(fleet, middleware):
    """By rclpy nothing comes but while it waits."""
    quiet, middleware.now_s = middleware.wait, middleware.now_s + 0.2

    def wait(seconds):
        quiet(seconds)
        middleware.wait = quiet
        say(middleware, 1.0)

    middleware.wait = wait
    fleet.stop()
    assert told(middleware) == [[50.0, 1.0]] * 3


def test_who_is_silent_is_not_sent_back_and_that_is_said(fleet, middleware, caplog):
    middleware.wait(5.0)
    middleware.heard["/r_0/pose"].append(posed(5.0))
    middleware.heard["/r_2/pose"].append(posed(5.0))
    fleet.stop()
    assert told(middleware) == [[50.0, 5.0], [50.0], [50.0, 5.0]]
    said = "robot r_1 was not heard, and not told to stay: it may go on to its last goal"
    assert [record.getMessage() for record in caplog.records] == [said]


def test_all_are_told_where_one_cannot_be(fleet, middleware):
    middleware.told["/r_0/goal_pose"].breaks = 10**6
    with pytest.raises(NetworkError) as caught:
        fleet.stop()
    assert str(caught.value) == "robot r_0 was not told to stay: timed out"
    assert told(middleware) == [[50.0], [50.0, 0.0], [50.0, 0.0]]


def test_one_that_could_not_be_told_is_told_again(fleet, middleware):
    middleware.told["/r_0/goal_pose"].breaks = 1
    fleet.stop()
    assert told(middleware) == [[50.0, 0.0]] * 3


def test_all_are_told_where_nothing_can_be_heard(fleet, middleware):
    def broken(_):
        middleware.now_s += 0.1
        raise RuntimeError("no executor")

    middleware.wait = broken
    with pytest.raises(NetworkError, match="no executor"):
        fleet.stop()
    assert told(middleware) == [[50.0, 0.0]] * 3
