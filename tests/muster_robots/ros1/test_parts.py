"""What needs no ROS: following way points, steering, discovery, the clock."""

import math
import threading
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.avoidance_names import require_avoidance
from muster.motion.frames import flu_to_enu
from muster.motion.kinematics.registry import KINEMATICS
from muster.motion.port import Waypoint
from muster_robots.discovery import robots_in
from muster_robots.follower import Follower
from muster_robots.ros1.clock import MissionClock
from muster_robots.simulated_time import Forward
from muster_robots.steering import STILL, SteeredRobot, Steering

DT = 0.05


def follower():
    return Follower(arrival_m=0.1, turned_rad=0.1, flat=True)


def test_way_points_are_passed_in_order_with_headings_and_holds():
    it = follower()
    assert it.take([Waypoint((1, 0, 0)), Waypoint((2, 0, 0), heading=math.pi, hold_s=2.0)]) == 1
    assert not it.hear(0.0, (2, 0, 0), math.pi)  # the second before the first does not count
    assert it.hear(1.0, (1, 0.05, 9), 0.0)  # in the plane heights are of no account
    assert not it.hear(2.0, (2, 0, 0), 0.0)  # not turned
    assert not it.hear(3.0, (2, 0, 0), -math.pi + 0.05)  # the hold begins
    assert not it.hear(4.9, (2, 0, 0), 0.0)
    assert it.hear(5.0, (2, 0, 0), 0.0)
    assert (it.passed, it.aim) == (2, None)
    assert it.take([Waypoint((0, 0, 0))]) == 2
    assert it.passed == 0


def test_it_is_there_where_one_says_so_who_knows_better():
    it = follower()
    it.arrive(0.0)  # without way points it is nowhere
    it.take([Waypoint((1, 0, 0), hold_s=2.0), Waypoint((2, 0, 0))])
    it.arrive(1.0)
    assert not it.hear(2.9, (0, 0, 0), 0.0)
    it.arrive(2.9)  # the hold goes on
    assert it.hear(3.0, (0, 0, 0), 0.0)
    assert not it.hear(9.0, (0, 0, 0), 0.0)


def test_only_who_has_passed_a_way_point_that_it_was_sent_to_waits():
    it = follower()
    it.hear(0.0, (0, 0, 0), 0.0)
    assert not it.waits  # nobody has sent it
    it.take([Waypoint((1, 0, 0))])
    assert not it.waits
    it.hear(1.0, (1, 0, 0), 0.0)
    assert it.waits
    it.take([])
    assert not it.waits  # told to stay


def test_trembling_is_no_travel_and_creeping_is():
    it = follower()
    for k in range(1000):
        it.hear(k, ((-1) ** k * 0.004, 0, 0), 0)
    assert it.odometry_m == 0
    for k in range(1001):
        it.hear(1000 + k, (0.001 * k, 0, 0), 0)
    assert it.odometry_m == pytest.approx(1.0, abs=0.03)


def test_robots_are_found_by_namespace_topic_and_type():
    topics = [
        ("/r_1/odom", "nav_msgs/Odometry"),
        ("/r_0/pose", "geometry_msgs/PoseStamped"),
        ("/r_0/odom", "nav_msgs/Odometry"),
        ("/turtle1/pose", "turtlesim/Pose"),
        ("/odom", "nav_msgs/Odometry"),
        ("/team/r_7/odom", "nav_msgs/Odometry"),
    ]
    assert robots_in(topics) == ["r_0", "r_1"]
    assert robots_in(topics, "/team") == ["r_7"]


def test_the_clock_stands_still_in_a_pause():
    times = iter([10.0, 11.0, 12.0, 15.0, 16.0])
    clock = MissionClock(lambda: next(times))
    assert clock.time_s == 1.0
    clock.pause()
    assert clock.time_s == 2.0
    clock.resume()
    assert clock.time_s == 3.0


@given(st.lists(st.floats(0, 1e6), min_size=1))
def test_a_simulators_clock_goes_forward_by_what_it_gains_and_never_back(said):
    readings = iter(said)
    clock = Forward(lambda: next(readings))
    told = [clock() for _ in said]
    assert told[0] == 0
    for before, after, a, b in zip(said, said[1:], told, told[1:], strict=False):
        assert b - a == pytest.approx(max(0.0, after - before) if before > 0 else 0.0, abs=1e-6)


def test_the_clock_never_goes_back_while_others_pause_it():
    clock, over = MissionClock(), threading.Event()

    def fidget():
        while not over.is_set():
            clock.pause()
            clock.resume()

    other = threading.Thread(target=fidget)
    other.start()
    try:
        times = [clock.time_s for _ in range(50_000)]
    finally:
        over.set()
        other.join()
    assert all(a <= b for a, b in pairwise(times))


def drive(robots, goals, steps, avoidance="orca"):
    """Robots that do as they are told; yields all places."""
    steering = Steering(interval_s=DT, space=False, avoidance=avoidance)
    states = np.array([[*robot.position, 0.0, math.radians(robot.heading_deg)] for robot in robots])
    velocities = np.zeros((len(robots), 3))
    for _ in range(steps):
        team = [
            SteeredRobot(robot, tuple(state[:3]), state[3], tuple(v), None if goal is None else Waypoint(goal), False)
            for robot, state, v, goal in zip(robots, states, velocities, goals, strict=True)
        ]
        told = steering.velocities(team)
        for k, robot in enumerate(robots):
            *body, turning = told[robot.id]
            velocities[k] = flu_to_enu(body, states[k, 3])
            states[k] += DT * np.array([*velocities[k], turning])
        yield states.copy(), told


def test_nobody_is_steered_faster_than_its_way_allows():
    robot = Robot(id="r", position=(0.0, 0.0), kind="ground", kinematics="holonomic", speed_mps=1.0)
    steering = Steering(interval_s=DT, space=False)
    for speed_mps, most_mps in ((0.3, 0.3), (2.0, 1.0)):
        aim = Waypoint((9.0, 0.0, 0.0), speed_mps=speed_mps)
        one = SteeredRobot(robot, (0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0), aim, False)
        told = [steering.velocities([one])["r"] for _ in range(30)]
        assert math.hypot(*told[-1][:2]) == pytest.approx(most_mps)


@pytest.mark.long
@settings(max_examples=30)
@given(
    kinematics=st.sampled_from(sorted(KINEMATICS)),
    heading=st.floats(-180, 180),
    goal=st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
    acceleration=st.sampled_from([None, 0.5]),
)
def test_every_kind_of_robot_gets_there_within_its_limits(kinematics, heading, goal, acceleration):
    one = Robot(
        id="r",
        position=(0.0, 0.0),
        heading_deg=heading,
        kinematics=kinematics,
        kind="air" if kinematics == "quadcopter" else "ground",
        acceleration_mps2=acceleration,
    )
    before = 0.0
    for states, told in drive([one], [(*goal, 0.0)], 300):
        speed = math.hypot(*told["r"][:3])
        assert speed <= one.speed_mps + 1e-9
        if acceleration is not None:
            assert abs(speed - before) <= acceleration * DT + 1e-9
        before, last = speed, states
    assert math.dist(last[0, :2], goal) < 0.1


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("avoidance", ["orca", "rvo", "hrvo"])
@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive"])
def test_robots_that_meet_head_on_pass_without_touching(kinematics, avoidance):
    robots = [
        Robot(id="a", position=(0.0, 0.0), radius_m=0.2, kinematics=kinematics),
        Robot(id="b", position=(6.0, 0.0), radius_m=0.2, kinematics=kinematics, heading_deg=180),
    ]
    apart = math.inf
    for states, _ in drive(robots, [(6.0, 0.0, 0.0), (0.0, 0.0, 0.0)], 400, avoidance):
        apart = min(apart, math.dist(states[0, :2], states[1, :2]))
    assert apart >= 0.4
    assert math.dist(states[0, :2], (6, 0)) < 0.1
    assert math.dist(states[1, :2], (0, 0)) < 0.1


def test_without_avoidance_robots_drive_through_each_other():
    robots = [
        Robot(id="a", position=(0.0, 0.0), radius_m=0.2, kinematics="holonomic"),
        Robot(id="b", position=(6.0, 0.0), radius_m=0.2, kinematics="holonomic", heading_deg=180),
    ]
    ways = drive(robots, [(6.0, 0.0, 0.0), (0.0, 0.0, 0.0)], 400, "none")
    assert min(math.dist(states[0, :2], states[1, :2]) for states, _ in ways) < 0.4


@pytest.mark.parametrize(("name", "size", "said"), [("rov", 2, "did you mean 'rvo'"), ("rvo", 3, "in space")])
def test_a_method_that_does_not_fit_is_refused(name, size, said):
    with pytest.raises(ParameterError, match=said):
        require_avoidance(name, size)


def test_who_stands_is_gone_around_and_told_to_stand():
    robots = [Robot(id="a", position=(0.0, 0.0), radius_m=0.2), Robot(id="b", position=(3.0, 0.0), radius_m=0.2)]
    for states, told in drive(robots, [(6.0, 0.0, 0.0), None], 300):
        assert told["b"] == STILL
        assert math.dist(states[0, :2], states[1, :2]) >= 0.4
    assert math.dist(states[0, :2], (6, 0)) < 0.1
