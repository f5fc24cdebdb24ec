"""The port of a robot on ROS 2, with the test's own time and middleware: what it hears, and what it tells the robot."""

import math

import pytest
from tests.muster_robots.ros2.fake_middleware import Middleware, Navigator, Told, moved, posed

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.port import Waypoint
from muster_robots.navigation import Outcome
from muster_robots.ros2.goals import Nav2Goals, PoseGoals
from muster_robots.ros2.map_frame import Ros2MapFrame
from muster_robots.ros2.message_types import Header, Quaternion, TFMessage, Time, Transform, TransformStamped, Vector3
from muster_robots.ros2.port import Arrival, Ros2Port, yaw_of


class There:
    """A port, and what the robot says on its topics."""

    def __init__(self, goals):
        self.middleware = middleware = Middleware()
        robot = Robot(id="r", position=(0.0, 0.0))
        self.port = Ros2Port(robot, middleware, "/r", goals, Arrival(), flat=True, clock=middleware.now)
        self.poses, self.odometry = middleware.heard["/r/pose"], middleware.heard["/r/odom"]

    def hear(self, now):
        self.middleware.now_s = now
        return self.port.hear()


@pytest.fixture
def navigator():
    return Navigator()


def test_nav2_with_odometry_only_is_heard_after_its_goal_and_holds_to_the_end(navigator):
    robot = There(Nav2Goals(navigator, "/r/navigate_to_pose"))
    robot.odometry.append(moved(0.0, frame="map"))
    robot.hear(0.0)
    robot.port.send([Waypoint((5.0, 0.0, 0.0), hold_s=8.0), Waypoint((5.0, 5.0, 0.0))])
    feedback = navigator.given[0][1]
    feedback.append(posed(4.9))
    robot.hear(1.0)
    feedback.outcome = Outcome("succeeded")
    for now in range(2, 12):
        robot.odometry.append(moved(4.9))
        robot.hear(float(now))
        assert robot.port.telemetry().time_s == now
        assert robot.port.telemetry().passed == (now >= 9)
    assert len(navigator.given) == 2


def test_a_hold_ends_by_time_where_nothing_is_heard_and_times_stand_still(navigator):
    robot = There(Nav2Goals(navigator, "/r/navigate_to_pose"))
    robot.odometry.append(moved(5.0, frame="map"))
    robot.hear(0.0)
    robot.port.send([Waypoint((5.0, 0.0, 0.0), hold_s=2.0)])
    navigator.given[0][1].outcome = Outcome("succeeded")
    assert not robot.hear(1.0)
    assert not robot.hear(2.9)
    assert robot.hear(3.0)
    said = robot.port.telemetry()
    assert (said.time_s, said.order, said.passed) == (0.0, 1, 1)


def test_where_poses_stop_odometry_goes_on_from_the_last(navigator):
    robot = There(Nav2Goals(navigator, "/r/navigate_to_pose"))
    robot.odometry.append(moved(10.0, 0.0, 0.0))
    robot.poses.append(posed(1.0, 2.0, math.pi / 2))
    robot.hear(0.0)
    robot.odometry.append(moved(10.5, 0.0, 0.0))
    robot.hear(0.5)
    assert robot.port.telemetry().position == (1.0, 2.0, 0.0)  # by its pose, of half a second ago
    robot.odometry.append(moved(12.0, 0.0, 0.0, ahead=1.0))
    robot.hear(2.0)
    said = robot.port.telemetry()
    assert said.position == pytest.approx((1.0, 4.0, 0.0))
    assert said.heading == pytest.approx(math.pi / 2)
    assert said.velocity == pytest.approx((0.0, 1.0, 0.0))
    robot.poses.append(posed(7.0, 7.0))
    robot.hear(2.1)
    assert robot.port.telemetry().position == (7.0, 7.0, 0.0)


def test_odometry_that_begins_after_the_pose_is_tied_to_it(navigator):
    robot = There(Nav2Goals(navigator, "/r/navigate_to_pose"))
    robot.poses.append(posed(1.0, 2.0))
    robot.hear(0.0)
    robot.odometry.append(moved(0.0))
    robot.hear(2.0)
    robot.odometry.append(moved(0.5))
    robot.hear(2.1)
    assert robot.port.telemetry().position == pytest.approx((1.5, 2.0, 0.0))


def test_poses_in_other_frames_and_such_as_are_none_do_not_count():
    robot = There(PoseGoals(Told(), "/r/goal_pose"))
    robot.poses += [posed(9.0, frame="odom"), posed(math.nan)]
    robot.odometry += [moved(math.inf), moved(3.0)]
    robot.hear(0.0)
    assert robot.port.telemetry() is None
    expected = "tf from map to odom, or a pose in map"
    assert robot.port.missing == f"/r/pose is in frame odom, which tf does not tie to map; expected {expected}"
    robot.odometry.append(moved(3.0, frame="map"))
    robot.hear(0.1)
    assert robot.port.telemetry().position == (3.0, 0.0, 0.0)
    assert robot.port.missing == ""


def test_a_robot_whose_place_on_the_map_is_not_known_is_sent_nowhere():
    told = Told()
    robot = There(PoseGoals(told, "/r/goal_pose"))
    robot.odometry.append(moved(0.0))
    robot.hear(0.0)
    robot.port.send([Waypoint((5.0, 0.0, 0.0))])
    robot.odometry.append(moved(1.0))
    robot.hear(1.0)
    assert told == []
    robot.poses.append(posed(2.0))
    robot.hear(2.0)
    assert told == [(5.0, 0.0)]


def test_odometry_counts_where_tf_ties_its_frame_to_the_map():
    middleware = Middleware()
    frames = Ros2MapFrame(middleware)
    there = {"clock": middleware.now, "flat": True, "frames": frames}
    port = Ros2Port(
        Robot(id="r", position=(0.0, 0.0)), middleware, "/r", PoseGoals(Told(), "/r/goal_pose"), Arrival(), **there
    )
    middleware.heard["/r/odom"].append(moved(3.0, frame="r/odom"))
    frames.hear(0.0)
    port.hear()
    assert port.telemetry() is None
    middleware.heard["/tf_static"].append(tied("map", "site", 10.0, 0.0, 0.0))
    middleware.heard["/tf"].append(tied("site", "r/odom", 0.0, 5.0, math.pi / 2))
    frames.hear(0.1)
    middleware.heard["/r/odom"].append(moved(3.0, frame="r/odom"))
    port.hear()
    said = port.telemetry()
    assert said.position == pytest.approx((10.0, 8.0, 0.0))
    assert said.heading == pytest.approx(math.pi / 2)
    assert port.missing == ""


def tied(parent, child, x, y, turn):
    rotation = Quaternion(0.0, 0.0, math.sin(turn / 2), math.cos(turn / 2))
    header = Header(stamp=Time(1, 0), frame_id=parent)
    return TFMessage((TransformStamped(header, child, Transform(Vector3(x, y, 0.0), rotation)),))


def test_who_is_cancelled_stays_where_it_said_last_that_it_is():
    told = Told()
    robot = There(PoseGoals(told, "/r/goal_pose"))
    robot.poses.append(posed(0.0))
    robot.hear(0.0)
    robot.port.send([Waypoint((50.0, 0.0, 0.0))])
    robot.poses.append(posed(1.0))
    robot.hear(1.0)
    robot.poses.append(posed(1.2))  # not taken in yet
    robot.port.cancel()
    assert told == [(50.0, 0.0), (1.2, 0.0)]
    assert robot.port.at_rest


def test_who_is_silent_keeps_its_goal_until_it_is_heard():
    told = Told()
    robot = There(PoseGoals(told, "/r/goal_pose"))
    robot.poses.append(posed(1.0))
    robot.hear(0.0)
    robot.port.send([Waypoint((50.0, 0.0, 0.0))])
    robot.hear(5.0)
    robot.port.cancel()
    robot.hear(6.0)
    assert told == [(50.0, 0.0)]
    assert not robot.port.at_rest
    robot.poses.append(posed(6.0))
    robot.hear(7.0)
    robot.poses.append(posed(6.1))
    robot.hear(7.1)
    assert told == [(50.0, 0.0), (6.0, 0.0)]
    assert robot.port.at_rest


def test_what_is_sent_to_a_silent_robot_holds_when_it_is_heard():
    told = Told()
    robot = There(PoseGoals(told, "/r/goal_pose"))
    robot.port.cancel()
    robot.port.send([Waypoint((50.0, 0.0, 0.0))])
    robot.poses.append(posed(6.0))
    robot.hear(7.0)
    assert set(told) == {(50.0, 0.0)}


def test_nav2_cancels_without_a_pose(navigator):
    robot = There(Nav2Goals(navigator, "/r/navigate_to_pose"))
    robot.port.send([Waypoint((50.0, 0.0, 0.0))])
    robot.port.cancel()
    robot.hear(1.0)
    assert navigator.given[0][1].outcome == Outcome("canceled")
    assert robot.port.at_rest


def test_the_velocity_is_that_between_poses():
    robot = There(PoseGoals(Told(), "/r/goal_pose"))
    robot.poses.append(posed(0.0))
    robot.hear(0.0)
    assert robot.port.telemetry().velocity == (0.0, 0.0, 0.0)
    robot.poses.append(posed(1.0, 2.0))
    robot.hear(2.0)
    assert robot.port.telemetry().velocity == (0.5, 1.0, 0.0)
    robot.poses.append(posed(1.1, 2.0))
    robot.hear(2.001)
    assert robot.port.telemetry().velocity == (0.5, 1.0, 0.0)  # of that which came before


@pytest.mark.parametrize(
    ("waypoint", "wanted"),
    [
        (Waypoint((0.0, 5.0, 0.0)), math.pi / 2),
        (Waypoint((0.0, 5.0, 0.0), heading=1.0), 1.0),
        (Waypoint((0.0, 0.0, 0.0)), -2.0),  # it is there, and stays as it stands
    ],
)
def test_a_goal_has_the_heading_of_the_way_there_if_none_is_wanted(navigator, waypoint, wanted):
    robot = There(Nav2Goals(navigator, "/r/navigate_to_pose"))
    robot.poses.append(posed(0.0, 0.0, -2.0))
    robot.hear(0.0)
    robot.port.send([waypoint])
    assert yaw_of(navigator.given[0][0].pose.orientation) == pytest.approx(wanted)


def test_way_points_that_are_none_are_not_sent():
    told = Told()
    robot = There(PoseGoals(told, "/r/goal_pose"))
    with pytest.raises(ParameterError, match=r"^way point of r: .*expected finite numbers$"):
        robot.port.send([Waypoint((math.nan, 0.0, 0.0))])
    assert told == []
