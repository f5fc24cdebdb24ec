"""Telemetry fused: nearer to the truth than what was said, in the kinematic world with noise."""

import math

import numpy as np
import pytest

import muster
from muster.motion.port import Telemetry, Waypoint
from muster.perception.errors import AirErrors, GroundErrors
from muster.perception.tracking import AirTracker, GroundTracker
from muster.simulation import KinematicWorld
from muster.simulation.noise import Noise

NOISE = Noise(velocity=0.05, slip=0.05, odometry=0.02, position_m=0.1, heading_rad=0.05)


def flown(mission, tracker, waypoints, seed):
    """Root mean square errors of place: as said, as fused."""
    truth = []
    world = KinematicWorld(mission, seed=seed, noise=NOISE, observer=lambda t, at, facing, going: truth.append(at[0]))
    port = world.ports["r_0"]
    port.send([Waypoint(place) for place in waypoints])
    off = []
    while not world.idle("r_0"):
        world.step()
        said = port.telemetry()
        off.append([np.array(t.position) - truth[-1] for t in (said, tracker.fused(said))])
    return np.sqrt((np.array(off) ** 2).sum(axis=2).mean(axis=0))


def mission(tmp_path, robot):
    file = tmp_path / "m.yaml"
    file.write_text(f"schema: muster/1\nrobots: [{{id: r_0, {robot}}}]\ntasks: []\n", encoding="utf-8")
    return muster.load(str(file))


def test_a_robot_on_the_ground(tmp_path):
    drives = mission(
        tmp_path, "position: [0, 0], kinematics: differential-drive, speed_mps: 0.26, yaw_rate_radps: 1.82"
    )
    for seed in range(3):
        tracker = GroundTracker(GroundErrors(position_m=0.1, heading_rad=0.05, odometry_share=0.05))
        said, fused = flown(drives, tracker, [(3, 0, 0), (3, 3, 0), (0, 0, 0)], seed)
        assert said == pytest.approx(0.1 * math.sqrt(2), rel=0.15)
        assert fused < 0.4 * said


def test_a_drone(tmp_path):
    flies = mission(tmp_path, "position: [0, 0, 1], kind: air, kinematics: quadcopter, speed_mps: 1")
    for seed in range(3):
        tracker = AirTracker(AirErrors(position_m=0.1, acceleration_mps2=1.0))
        said, fused = flown(flies, tracker, [(10, 0, 3), (10, 10, 3), (0, 0, 1)], seed)
        assert said == pytest.approx(0.1 * math.sqrt(3), rel=0.15)
        assert fused < 0.4 * said


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
