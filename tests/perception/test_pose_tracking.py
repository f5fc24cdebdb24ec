"""Telemetry fused: nearer to the truth than what was said, in the kinematic world with noise."""

import math

import numpy as np
import pytest

import muster
from muster.mission.errors import ParameterError
from muster.motion.noise import Noise
from muster.motion.port import Inertial, Telemetry, Waypoint
from muster.perception.errors import AirErrors, GroundErrors
from muster.perception.pose_tracking import AirTracker, FusedPort, GroundTracker
from muster.simulation import KinematicWorld

NOISE = Noise(velocity=0.05, slip=0.05, odometry=0.02, position_m=0.1, heading_rad=0.05)


def flown(mission, tracker, waypoints, steps, seed=1):
    """Root mean square errors of place: as said, as fused, from reports that are so many steps apart."""
    truth = []
    world = KinematicWorld(mission, seed=seed, noise=NOISE, observer=lambda t, at, facing, going: truth.append(at[0]))
    port = world.ports["r_0"]
    fused = FusedPort(port, tracker)
    fused.send([Waypoint(place) for place in waypoints])
    off = []
    while not world.idle("r_0"):
        for _ in range(steps):
            world.step()
        off.append([np.array(told.position) - truth[-1] for told in (port.telemetry(), fused.telemetry())])
    return np.sqrt((np.array(off) ** 2).sum(axis=2).mean(axis=0))


def mission(tmp_path, robot):
    file = tmp_path / "m.yaml"
    file.write_text(f"schema: muster/1\nrobots: [{{id: r_0, {robot}}}]\ntasks: []\n", encoding="utf-8")
    return muster.load(str(file))


@pytest.mark.parametrize(("steps", "share"), [(1, 0.25), (5, 0.45), (10, 0.55)])
def test_a_robot_on_the_ground(tmp_path, steps, share):
    """Around a square's corners, which it takes turning on the spot."""
    drives = mission(
        tmp_path, "position: [0, 0], kinematics: differential-drive, speed_mps: 0.26, yaw_rate_radps: 1.82"
    )
    tracker = GroundTracker(GroundErrors(position_m=0.1, heading_rad=0.05, odometry_share=0.05))
    said, fused = flown(drives, tracker, [(3, 0, 0), (3, 3, 0), (0, 3, 0), (0, 0, 0)] * 2, steps)
    assert said == pytest.approx(0.1 * math.sqrt(2), rel=0.2)
    assert fused < share * said


@pytest.mark.parametrize(("steps", "share"), [(1, 0.35), (5, 0.7), (10, 0.95)])
def test_a_drone(tmp_path, steps, share):
    flies = mission(tmp_path, "position: [0, 0, 1], kind: air, kinematics: quadcopter, speed_mps: 1")
    tracker = AirTracker(AirErrors(position_m=0.1, acceleration_mps2=1.0, odometry_slip=0.05))
    said, fused = flown(flies, tracker, [(10, 0, 3), (10, 10, 3), (0, 0, 1)] * 2, steps)
    assert said == pytest.approx(0.1 * math.sqrt(3), rel=0.2)
    assert fused < share * said


@pytest.mark.parametrize(
    "tracker", [GroundTracker(GroundErrors(heading_rad=0.3, yaw_acceleration_radps2=50.0)), AirTracker(AirErrors())]
)
def test_a_gyro_tells_a_turn_that_the_heading_said_hides(tracker):
    """It says 0 all the time, and is far less sure of that than its gyro is of 0.5 rad in a step."""
    tracker.fused(Telemetry(0.0, (0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0), 0.0, 1, 0))
    for time, rate in ((0.1, 0.0), (0.2, 5.0)):
        felt = Inertial(0.1, (0.0, 0.0, 0.0), rate)
        fused = tracker.fused(Telemetry(time, (0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0), 0.0, 1, 0, felt))
    assert 0.2 < fused.heading < 0.5


def test_a_reading_of_another_time_is_left():
    """Of the last tenth of the second between two reports."""
    drone = AirTracker(AirErrors())
    for time in (0.0, 1.0, 2.0):
        felt = Inertial(0.1, (3.0, 0.0, 0.0), 1.0)
        fused = drone.fused(Telemetry(time, (0.0, 0.0, 0.0), 0.1, (0.0, 0.0, 0.0), 0.0, 1, 0, felt))
    assert fused.heading == 0.1
    assert fused.velocity == (0.0, 0.0, 0.0)


@pytest.mark.long
def test_a_robot_on_a_slope_climbs_as_its_odometry_says(tmp_path):
    """Two in ten; fixes alone would be 5 cm off."""
    drives = mission(tmp_path, "position: [0, 0, 0], kinematics: differential-drive, speed_mps: 0.5")
    tracker = GroundTracker(GroundErrors(position_m=0.1, heading_rad=0.05, odometry_share=0.05))
    said, fused = flown(drives, tracker, [(20, 0, 4), (40, 0, 0)], 1)
    assert said == pytest.approx(0.1 * math.sqrt(3), rel=0.2)
    assert fused < 0.3 * said


def test_orders_go_through(tmp_path):
    robot = mission(tmp_path, "position: [0, 0]")
    world = KinematicWorld(robot)
    port = FusedPort(world.ports["r_0"], AirTracker(AirErrors()))
    assert port.robot == "r_0"
    assert port.send([Waypoint((1.0, 0.0, 0.0), label="there")]) == 1
    assert [passing.label for passing in world.advance(10.0)] == ["there"]
    assert port.cancel() == 2
    world.step()
    assert (port.telemetry().order, port.telemetry().passed) == (2, 0)


@pytest.mark.parametrize("tracker", [GroundTracker(GroundErrors()), AirTracker(AirErrors())])
def test_a_report_that_is_no_newer_changes_nothing(tracker):
    assert tracker.estimate is None
    said = Telemetry(1.0, (1.0, 2.0, 0.0), 0.5, (0.0, 0.0, 0.0), 0.0, 3, 1)
    first = tracker.fused(said)
    assert first.position == (1.0, 2.0, 0.0)
    assert (first.order, first.passed, first.time_s, first.odometry_m) == (3, 1, 1.0, 0.0)
    before = tracker.estimate
    again = tracker.fused(Telemetry(1.0, (9.0, 9.0, 0.0), 0.5, (0.0, 0.0, 0.0), 0.0, 4, 0))
    assert tracker.estimate is before
    assert again.position == first.position
    assert again.order == 4


@pytest.mark.parametrize("tracker", [GroundTracker(GroundErrors()), AirTracker(AirErrors())])
def test_after_a_long_silence_the_place_is_the_one_that_is_said(tracker):
    tracker.fused(Telemetry(0.0, (0.0, 0.0, 0.0), 0.0, (0.2, 0.0, 0.0), 0.0, 1, 0))
    tracker.fused(Telemetry(0.1, (0.02, 0.0, 0.0), 0.0, (0.2, 0.0, 0.0), 0.02, 1, 0))
    late = tracker.fused(Telemetry(200.0, (3.0, 20.0, 0.0), 2.0, (0.0, 0.0, 0.0), 35.0, 1, 1))
    assert math.dist(late.position, (3.0, 20.0, 0.0)) < 0.05
    assert late.heading == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: GroundTracker(GroundErrors(position_m=0)), "position_m: 0; expected a number above 0"),
        (lambda: GroundTracker(GroundErrors(heading_rad=0)), "heading_rad: 0; expected a number above 0"),
        (lambda: AirTracker(AirErrors(heading_rad=0)), "heading_rad: 0; expected a number above 0"),
        (lambda: AirTracker(AirErrors(velocity_mps=0)), "velocity_mps: 0; expected a number above 0"),
    ],
)
def test_what_is_exact_needs_no_filter(make, message):
    with pytest.raises(ParameterError, match=f"^{message}"):
        make()
