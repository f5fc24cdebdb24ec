"""Dead reckoning against its own equations: ways of arcs, derivatives, weights of gyro and odometry, landmarks."""

import math
from dataclasses import replace

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped
from muster.perception import dead_reckoning
from muster.perception.dead_reckoning import (
    Odometry,
    Seen,
    by_landmark,
    by_mark,
    by_pose,
    by_range_and_bearing,
    with_mark,
)
from muster.perception.errors import ReckoningErrors
from muster.perception.joint_estimate import BIAS, HEADING, SKID, SLIP, JointEstimate, Z, turned_places

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


def numeric(function, estimate):
    """The derivative of errors after a function by those before, of an estimate with one mark."""
    columns = []
    after = function(estimate)
    for number in range(len(estimate.mean)):
        shifts = []
        for sign in (1, -1):
            state = estimate.shifted(sign * 1e-6 * np.eye(len(estimate.mean))[number])
            shifts.append(errors_between(function(JointEstimate(state, estimate.errors)).mean, after))
        columns.append((shifts[0] - shifts[1]) / 2e-6)
    return np.array(columns).T


def errors_between(state, estimate):
    """Right-invariant errors of a state against an estimate, to first order."""
    off = state - estimate.mean
    off[HEADING] = wrapped(off[HEADING])
    return off - off[HEADING] * turned_places(estimate.mean)


def with_a_mark(*, errors=ERRORS):
    estimate = dead_reckoning.standing_at([1.0, -2.0, 0.5, 0.7], (0.1, 0.1, 0.1, 0.1), errors)
    estimate = with_mark(estimate, Seen(np.array([2.0, 0.5]), 0.01 * np.eye(2)))
    return estimate.with_new_picture(0.02)


@pytest.mark.parametrize("turning_radps", [None, 1.3])
def test_the_covariance_is_carried_by_the_derivative_of_the_motion(turning_radps):
    """Also where the gyro's difference corrects bias and slip: odometry without errors has none but that."""
    exact = ReckoningErrors(
        way_share=0, aside_share=0, turn_share=0.3, turn_per_m=0, gyro_radps=0.2, gyro_walk=0, slip=0.1
    )
    step, estimate = Odometry(0.5, (0.4, -0.1, 0.2), 0.6), with_a_mark()
    seen = numeric(lambda at: dead_reckoning.moved(at, step, exact, turning_radps), estimate)
    assert seen[:3, HEADING] == pytest.approx(0.0, abs=1e-6)  # a turn of all that is in the map stays one
    assert seen[HEADING, HEADING] == pytest.approx(1.0, abs=1e-6)
    if turning_radps is None:
        turn = exact.turn_share * step.turned_rad
        by_turn = np.zeros(len(seen))
        shifted = [dead_reckoning.moved(estimate, replace(step, turned_rad=0.6 + s * 1e-6), exact) for s in (1, -1)]
        after = dead_reckoning.moved(estimate, step, exact)
        by_turn = (errors_between(shifted[0].mean, after) - errors_between(shifted[1].mean, after)) / 2e-6
        spread = seen @ estimate.errors @ seen.T + turn**2 * np.outer(by_turn, by_turn)
        assert after.errors == pytest.approx(spread, abs=1e-7)


@pytest.mark.parametrize("fix", ["by_mark", "by_landmark", "by_pose"])
def test_sensors_have_the_derivatives_of_what_they_expect(fix):
    estimate = with_a_mark()
    seen = Seen(np.array([2.0, 0.5]), 0.01 * np.eye(2), np.array([0.4, 0.1]), np.array([[0.1, 2.0], [-1.5, 0.2]]))
    take = {
        "by_mark": lambda at: by_mark(at, 0, seen),
        "by_landmark": lambda at: by_landmark(at, [2.4, -0.5], seen),
        "by_pose": lambda at: by_pose(at, [1.1, -2.0, 0.5, 0.7], [0.1] * 4),
    }[fix]
    derivative = []
    for number in range(len(estimate.mean)):
        states = (estimate.shifted(sign * 1e-6 * np.eye(len(estimate.mean))[number]) for sign in (1, -1))
        ahead, back = (take(JointEstimate(state, estimate.errors)).innovation for state in states)
        derivative.append((back - ahead) / 2e-6)
    sensor = np.array(derivative).T
    if fix != "by_pose":
        sensor[:, Z] -= seen.by_height  # of the place that is seen, which moves with the height that is believed
    spread = sensor @ estimate.errors @ sensor.T + 0.01 * np.eye(len(sensor))
    assert take(estimate).innovation_covariance == pytest.approx(spread, abs=1e-4)


def test_a_gyro_finds_the_skid():
    """Odometry counts a tenth too much of the turn, the gyro is exact."""
    errors = ReckoningErrors(skid=0.1, gyro_radps=1e-4, gyro_bias_radps=1e-4)
    estimate = dead_reckoning.standing_at([0, 0, 0, 0], SURE, errors)
    for _ in range(100):
        estimate = dead_reckoning.moved(estimate, Odometry(0.1, (0.1, 0.0, 0.0), 0.1), errors, 0.9)
    assert estimate.mean[SKID] == pytest.approx(0.1, abs=0.01)
    assert estimate.mean[HEADING] == pytest.approx(wrapped(9.0), abs=0.01)


def test_what_was_seen_before_brings_back():
    """A mark that is seen at the beginning and at the end: the way between counts no more."""
    estimate = dead_reckoning.standing_at([0, 0, 0, 0], SURE, ERRORS)
    seen = Seen(np.array([1.0, 0.5]), 1e-6 * np.eye(2))
    estimate = with_mark(estimate, seen)
    at_first = estimate.place_covariance(0)
    for _ in range(50):
        estimate = dead_reckoning.moved(estimate, Odometry(0.1, (0.1, 0.0, 0.0), 0.0), ERRORS)
    before = estimate.place_covariance()
    back = Seen(np.array([1.0 - 5.0, 0.5]), 1e-6 * np.eye(2))
    estimate = by_mark(estimate, 0, back).estimate
    assert estimate.place_covariance(0) == pytest.approx(at_first, rel=0.01)
    assert estimate.place_covariance()[0, 0] < 0.1 * before[0, 0]


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
            estimate = by_landmark(estimate, place, Seen(seen, 1e-3 * np.eye(2))).estimate
    assert estimate.mean[[0, 1, 3]] == pytest.approx(truth[[0, 1, 3]], abs=3e-3)


def test_range_and_bearing_are_a_place_ahead_and_to_the_left():
    estimate = dead_reckoning.standing_at([0.1, 0.0, 0.0, 0.1], (0.1, 0.1, 0.1, 0.1), ERRORS)
    polar = by_range_and_bearing(estimate, [2.0, 1.0], 2.0, 0.5, (0.01, 0.02))
    turn = np.array([[math.cos(0.5), -math.sin(0.5)], [math.sin(0.5), math.cos(0.5)]])
    spread = turn @ np.diag([0.01**2, (2.0 * 0.02) ** 2]) @ turn.T
    flat = by_landmark(estimate, [2.0, 1.0], Seen(2.0 * turn[:, 0], spread))
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
