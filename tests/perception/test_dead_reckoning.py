"""Dead reckoning against its own equations: ways of arcs, derivatives, weights of gyro and odometry, landmarks."""

import math

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.perception import dead_reckoning
from muster.perception.dead_reckoning import BIAS, HEADING, SLIP, Odometry, by_landmark, by_pose, by_range_and_bearing
from muster.perception.errors import ReckoningErrors

ERRORS = ReckoningErrors()
SURE = (1e-3, 1e-3, 1e-3, 1e-3)


def test_a_square_that_is_counted_comes_back():
    estimate = dead_reckoning.standing_at([1.0, 2.0, 0.5, 0.3], SURE, ERRORS)
    for _ in range(4):
        for step in (Odometry(1.0, (0.7, 0.2, 0.1), 0.0), Odometry(1.0, (0.0, 0.0, -0.1), math.pi / 2)):
            estimate = dead_reckoning.moved(estimate, step, ERRORS)
    assert estimate.mean[:4] == pytest.approx([1.0, 2.0, 0.5, 0.3])
    assert (estimate.deviations[:2] > 0.005).all()


def test_an_error_of_the_heading_leads_aside():
    """By the sine of it, and the covariance knows."""
    estimate = dead_reckoning.standing_at([0.0, 0.0, 0.0, 0.1], (1e-6, 1e-6, 1e-6, 0.1), ERRORS)
    for _ in range(10):
        estimate = dead_reckoning.moved(estimate, Odometry(0.1, (1.0, 0.0, 0.0), 0.0), ERRORS)
    assert estimate.mean[:2] == pytest.approx([10 * math.cos(0.1), 10 * math.sin(0.1)])
    assert estimate.deviations[1] == pytest.approx(10 * 0.1, rel=0.1)


def test_the_derivative_is_that_of_the_motion():
    step = dead_reckoning._Step(Odometry(0.5, (0.4, -0.1, 0.2), 0.6), 1.3, 0.7)
    state = np.array([1.0, -2.0, 0.5, 0.7, 0.05, 0.1])
    _, derivative = step.taken(state)
    for number in range(6):
        shift = 1e-6 * np.eye(6)[number]
        numeric = (step.taken(state + shift)[0] - step.taken(state - shift)[0]) / 2e-6
        assert derivative[:, number] == pytest.approx(numeric, abs=1e-7)


def test_a_gyro_whose_bias_is_found_out_keeps_the_heading():
    """At rest odometry counts no turn: what the gyro gives is its bias."""
    errors = ReckoningErrors(gyro_radps=0.01, gyro_bias_radps=0.1)
    random = np.random.default_rng(1)
    estimate = dead_reckoning.standing_at([0, 0, 0, 0], SURE, errors)
    for _ in range(400):
        still = Odometry(0.1, (0.0, 0.0, 0.0), 0.0)
        estimate = dead_reckoning.moved(estimate, still, errors, 0.07 + random.normal(0, 0.01))
    assert estimate.mean[BIAS] == pytest.approx(0.07, abs=0.003)
    assert abs(estimate.mean[HEADING]) < 0.002


def test_landmarks_tell_where_a_robot_is():
    """Two at known places, seen exactly: (2.7) solved for the robot gives its pose."""
    truth = np.array([1.0, 0.5, 0.0, 0.4])
    estimate = dead_reckoning.standing_at([1.2, 0.3, 0.0, 0.2], (0.3, 0.3, 0.01, 0.3), ERRORS)
    c, s = math.cos(truth[3]), math.sin(truth[3])
    for _ in range(50):
        for place in ([3.0, 1.0], [0.0, 2.0]):
            seen = np.array([[c, s], [-s, c]]) @ (np.array(place) - truth[:2])
            estimate = by_landmark(estimate, place, seen, 1e-3 * np.eye(2)).estimate
    assert estimate.mean[[0, 1, 3]] == pytest.approx(truth[[0, 1, 3]], abs=3e-3)


def test_range_and_bearing_are_a_place_ahead_and_to_the_left():
    estimate = dead_reckoning.standing_at([0.1, 0.0, 0.0, 0.1], (0.1, 0.1, 0.1, 0.1), ERRORS)
    polar = by_range_and_bearing(estimate, [2.0, 1.0], 2.0, 0.5, (0.01, 0.02))
    turn = np.array([[math.cos(0.5), -math.sin(0.5)], [math.sin(0.5), math.cos(0.5)]])
    spread = turn @ np.diag([0.01**2, (2.0 * 0.02) ** 2]) @ turn.T
    flat = by_landmark(estimate, [2.0, 1.0], 2.0 * turn[:, 0], spread)
    assert polar.estimate.mean == pytest.approx(flat.estimate.mean)
    assert polar.estimate.covariance == pytest.approx(flat.estimate.covariance)


def test_a_measured_heading_is_taken_the_short_way_around():
    estimate = dead_reckoning.standing_at([0, 0, 0, math.pi - 0.05], (0.1, 0.1, 0.1, 0.1), ERRORS)
    after = by_pose(estimate, [0, 0, 0, -math.pi + 0.05], [0.1] * 4).estimate
    assert abs(after.mean[HEADING]) == pytest.approx(math.pi, abs=1e-9)


def test_fixes_tell_the_slip():
    errors = ReckoningErrors(slip=0.1)
    estimate = dead_reckoning.standing_at([0, 0, 0, 0], SURE, errors)
    for step in range(1, 41):
        estimate = dead_reckoning.moved(estimate, Odometry(1.0, (1.0, 0.0, 0.0), 0.0), errors)
        estimate = by_pose(estimate, [0.95 * step, 0, 0, 0], [0.01, 0.01, 0.01, 0.01]).estimate
    assert estimate.mean[SLIP] == pytest.approx(0.05, abs=0.005)


def test_a_step_takes_time():
    with pytest.raises(ParameterError, match="dt: 0"):
        dead_reckoning.moved(dead_reckoning.standing_at([0] * 4, SURE, ERRORS), Odometry(0.0, (0, 0, 0), 0), ERRORS)
