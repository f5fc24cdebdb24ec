"""A robot in the plane: derivatives, turning the map turns the estimate, consistency, landmarks and gyro bias."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped
from muster.motion.kinematics.registry import kinematics_named
from muster.perception import ground_fusion as fusion
from muster.perception.errors import GroundErrors

ERRORS = GroundErrors(odometry_share=0.0)
angles = st.floats(-math.pi, math.pi)
states = st.tuples(
    *[st.floats(-10, 10)] * 2,
    angles,
    st.floats(-2, 2),
    st.floats(-2, 2) | st.floats(-1e-4, 1e-4),
    st.floats(-1, 1),
    st.just(0.0),
).map(np.array)


def derivative(function, state, step=1e-6):
    pushes = step * np.eye(len(state))
    return np.column_stack([(function(state + push) - function(state - push)) / (2 * step) for push in pushes])


@given(states, st.floats(0.01, 1))
def test_the_derivative_of_an_arc(state, dt):
    _, slopes = fusion.arc(state, dt)
    np.testing.assert_allclose(slopes, derivative(lambda x: fusion.arc(x, dt)[0], state), atol=1e-6)


@given(states, st.floats(0.01, 1))
def test_an_arc_is_that_of_the_kinematics(state, dt):
    x, y, heading, speed, yaw_rate = state[:5]
    drive = kinematics_named("differential-drive")
    (after,) = drive.step(np.array([[x, y, 0.0, heading]]), np.array([[speed * (1 - state[6]), yaw_rate]]), dt)
    np.testing.assert_allclose(fusion.arc(state, dt)[0][:3], after[[0, 1, 3]], atol=1e-7)


@given(st.tuples(*[st.floats(-5, 5)] * 2, angles), st.tuples(*[st.floats(-5, 5)] * 2), st.floats(0.5, 5), angles)
def test_the_derivative_of_a_landmark(pose, landmark, range_m, bearing):
    """By what a filter does: gain times innovation, from a covariance that is small and round."""
    assume(math.dist(pose[:2], landmark) >= 0.1)
    estimate = fusion.standing_at(pose, [1e-3] * 3, ERRORS)

    straight = math.atan2(landmark[1] - pose[1], landmark[0] - pose[0])

    def seen(state):
        east, north = landmark - state[:2]
        return np.array([math.hypot(east, north), straight + wrapped(math.atan2(north, east) - straight) - state[2]])

    correction = fusion.by_landmark(estimate, landmark, range_m, bearing, ERRORS)
    expected = seen(estimate.mean)
    innovation = [range_m - expected[0], wrapped(bearing - expected[1])]
    np.testing.assert_allclose(correction.innovation, innovation, atol=1e-9)
    slopes = np.column_stack([derivative(seen, estimate.mean[:3]), np.zeros((2, 4))])
    noise = np.diag([ERRORS.range_m**2, ERRORS.bearing_rad**2])
    spread = slopes @ estimate.covariance @ slopes.T + noise
    np.testing.assert_allclose(correction.innovation_covariance, spread, rtol=1e-5, atol=1e-12)


@given(angles, st.integers(0, 1000))
def test_a_turned_map_has_a_turned_estimate(turn, seed):
    random = np.random.default_rng(seed)
    c, s = math.cos(turn), math.sin(turn)
    turned = np.array([[c, -s], [s, c]])
    one = fusion.standing_at([1.0, 2.0, 0.5], [0.1, 0.1, 0.2], ERRORS)
    two = fusion.standing_at([*turned @ [1.0, 2.0], 0.5 + turn], [0.1, 0.1, 0.2], ERRORS)
    landmark = np.array([4.0, 3.0])
    for _ in range(3):
        speed, rate, fix, away, bearing = *random.normal(size=2), random.normal(size=2), 3.0, random.normal()
        ends = []
        for estimate, r in ((one, np.eye(2)), (two, turned)):
            after = fusion.moved(estimate, 0.1, ERRORS, 0.3)
            after = fusion.by_odometry(after, speed, rate, ERRORS).estimate
            after = fusion.by_position(after, r @ fix, ERRORS).estimate
            ends.append(fusion.by_landmark(after, r @ landmark, away, bearing, ERRORS).estimate)
        one, two = ends
    np.testing.assert_allclose(turned @ one.mean[:2], two.mean[:2], atol=1e-6)
    np.testing.assert_allclose(one.mean[3:], two.mean[3:], atol=1e-6)
    assert abs(wrapped(one.mean[2] + turn - two.mean[2])) < 1e-6
    np.testing.assert_allclose(turned @ one.covariance[:2, :2] @ turned.T, two.covariance[:2, :2], atol=1e-8)


@given(st.floats(-0.1, 0.1))
def test_headings_are_the_same_a_turn_apart(off):
    estimate = fusion.standing_at([0.0, 0.0, math.pi - 0.01], [0.1, 0.1, 0.1], ERRORS)
    near = fusion.by_heading(estimate, -math.pi + off, ERRORS)
    assert near.innovation[0] == pytest.approx(wrapped(0.01 + off))
    assert -math.pi <= near.estimate.mean[2] < math.pi


class Drive:
    """A robot that truly moves as the filter believes, and its sensors."""

    def __init__(self, seed):
        self.random = np.random.default_rng(seed)
        biases = self.random.normal(0, [ERRORS.gyro_bias_radps, ERRORS.odometry_slip])
        self.state = np.array([0.0, 0.0, 0.0, 0.0, 0.0, *biases])

    def step(self, dt):
        ahead = self.random.normal(0, ERRORS.acceleration_mps2)
        turn = self.random.normal(0, ERRORS.yaw_acceleration_radps2)
        heading = self.state[2]
        self.state, _ = fusion.arc(self.state, dt)
        push = dt * dt / 2 * ahead
        self.state[:5] += [
            push * math.cos(heading),
            push * math.sin(heading),
            dt * dt / 2 * turn,
            dt * ahead,
            dt * turn,
        ]
        self.state[5] += self.random.normal(0, ERRORS.gyro_walk * math.sqrt(dt))

    def corrections(self, fix):
        x, y, heading, speed, rate, bias, _ = self.state
        draw = self.random.normal
        turns = rate + draw(0, ERRORS.odometry_radps)
        yield lambda e: fusion.by_odometry(e, speed + draw(0, ERRORS.odometry_mps), turns, ERRORS)
        yield lambda e: fusion.by_gyro(e, rate + bias + draw(0, ERRORS.gyro_radps), ERRORS)
        if fix:
            yield lambda e: fusion.by_position(e, self.state[:2] + draw(0, ERRORS.position_m, 2), ERRORS)
            yield lambda e: fusion.by_heading(e, heading + draw(0, ERRORS.heading_rad), ERRORS)
            east, north = 3.0 - x, 4.0 - y
            away = math.hypot(east, north) + draw(0, ERRORS.range_m)
            bearing = math.atan2(north, east) - heading + draw(0, ERRORS.bearing_rad)
            yield lambda e: fusion.by_landmark(e, [3.0, 4.0], away, bearing, ERRORS)


@pytest.mark.long
def test_the_fusion_is_consistent():
    """Innovations of all sensors over seeded runs, and the errors at the end, within chi-square bounds of 99.9 %."""
    chi2 = pytest.importorskip("scipy.stats").chi2
    innovations, freedom, errors, runs = 0.0, 0, 0.0, 20
    for seed in range(runs):
        drive, estimate = Drive(seed), fusion.standing_at([0, 0, 0], [0, 0, 0], ERRORS)
        for step in range(100):
            drive.step(0.1)
            estimate = fusion.moved(estimate, 0.1, ERRORS)
            for measure in drive.corrections(step % 10 == 9):
                correction = measure(estimate)
                estimate = correction.estimate
                innovations, freedom = innovations + correction.nis, freedom + len(correction.innovation)
        off = estimate.mean - drive.state
        off[2] = wrapped(off[2])
        errors += off @ np.linalg.solve(estimate.covariance, off)
    low, high = chi2.ppf([0.0005, 0.9995], freedom)
    assert low < innovations < high
    low, high = chi2.ppf([0.0005, 0.9995], 7 * runs)
    assert low < errors < high


def test_the_bias_of_the_gyro_is_learned():
    random = np.random.default_rng(3)
    estimate = fusion.standing_at([0, 0, 0], [0, 0, 0], GroundErrors(gyro_bias_radps=0.05))
    for _ in range(600):
        estimate = fusion.moved(estimate, 0.1, ERRORS)
        estimate = fusion.by_odometry(estimate, 0.0, random.normal(0, 0.05), ERRORS).estimate
        estimate = fusion.by_gyro(estimate, 0.03 + random.normal(0, 0.01), ERRORS).estimate
    assert estimate.mean[fusion.BIAS] == pytest.approx(0.03, abs=3 * estimate.deviations[fusion.BIAS])
    assert estimate.deviations[fusion.BIAS] < 0.004


def test_wheels_that_slip_are_found_out():
    """A twentieth of what they count is not driven; fixes tell."""
    errors = GroundErrors(odometry_slip=0.05)
    random, x = np.random.default_rng(3), 0.0
    estimate = fusion.standing_at([0, 0, 0], [0, 0, 0], errors)
    for _ in range(300):
        x += 0.026
        counted = 0.026 / 0.95 * (1 + random.normal(0, 0.02))
        estimate = fusion.moved_as_counted(estimate, 0.1, counted, random.normal(0, 0.05), errors)
        fix = [x + random.normal(0, 0.05), random.normal(0, 0.05)]
        estimate = fusion.by_position(estimate, fix, errors).estimate
    assert estimate.mean[fusion.SLIP] == pytest.approx(0.05, abs=3 * estimate.deviations[fusion.SLIP])
    assert estimate.deviations[fusion.SLIP] < 0.01


def test_two_landmarks_tell_the_pose():
    estimate = fusion.standing_at([0.2, -0.3, 0.2], [0.5, 0.5, 0.3], ERRORS)
    for _ in range(5):
        for landmark in ((3.0, 0.0), (0.0, 3.0)):
            bearing = math.atan2(landmark[1], landmark[0])
            estimate = fusion.by_landmark(estimate, landmark, 3.0, bearing, ERRORS).estimate
    np.testing.assert_allclose(estimate.mean[:3], 0, atol=0.02)


@given(states, st.floats(0.05, 1))
def test_what_was_counted_leads_along_the_arc(state, dt):
    """From a known pose, by an exact odometer and an exact heading, to where the arc ends."""
    state[3] = abs(state[3])
    assume(abs(state[4] * dt) <= 3)
    exact = GroundErrors(
        acceleration_mps2=10,
        yaw_acceleration_radps2=10,
        odometry_share=0,
        odometry_mps=1e-6,
        heading_rad=1e-6,
        odometry_slip=0,
    )
    state[6] = 0.0
    truth, _ = fusion.arc(state, dt)
    estimate = fusion.standing_at(state[:3], [1e-9] * 3, exact)
    after = fusion.moved_as_counted(estimate, dt, state[3] * dt, float(truth[2]), exact)
    np.testing.assert_allclose(after.mean[[0, 1, 3, 4]], truth[[0, 1, 3, 4]], atol=1e-4)
    assert abs(wrapped(after.mean[2] - truth[2])) < 1e-4


def test_a_turn_leaves_doubt_about_the_way():
    estimate = fusion.standing_at([0, 0, 0], [0, 0, 0], ERRORS)
    straight, bent = (fusion.moved_as_counted(estimate, 1.0, 0.4, turn, ERRORS) for turn in (0.0, 1.0))
    assert straight.deviations[0] < 0.01
    assert bent.deviations[0] == pytest.approx(0.4 * bent.mean[fusion.YAW_RATE] / 4, rel=0.2)


def test_refusals():
    estimate = fusion.standing_at([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], ERRORS)
    with pytest.raises(ParameterError, match=r"^dt: 0; expected seconds above 0$"):
        fusion.moved(estimate, 0, ERRORS)
    with pytest.raises(ParameterError, match=r"^dt: -1; expected seconds above 0$"):
        fusion.moved_as_counted(estimate, -1, 0.0, 0.0, ERRORS)
    with pytest.raises(ParameterError, match=r"^landmark: \[0.0, 0.0\]; expected one that is not where the robot is$"):
        fusion.by_landmark(estimate, [0.0, 0.0], 1.0, 0.0, ERRORS)
    with pytest.raises(ParameterError, match=r"^measured: shape \(3,\); expected \(2,\)$"):
        fusion.by_position(estimate, [0.0, 0.0, 0.0], ERRORS)
    with pytest.raises(ParameterError, match=r"^range_m: -1; expected a finite number of at least 0$"):
        GroundErrors(range_m=-1)
