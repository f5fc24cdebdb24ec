"""A drone's position: the model entry by entry, and consistency."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.perception import air_fusion as fusion
from muster.perception.errors import AirErrors
from muster.perception.kalman import Estimate

ERRORS = AirErrors()


def test_a_step_by_hand():
    errors = AirErrors(acceleration_mps2=2.0)
    after = fusion.moved(fusion.hovering_at([1.0, 2.0, 3.0], 0.5, errors), 0.5, errors, [1.0, 0.0, -1.0])
    np.testing.assert_allclose(after.mean, [1.125, 2.0, 2.875, 0.5, 0.0, -0.5, 0.0])
    position, velocity, both = 0.25 + 4 * 0.125**2, 4 * 0.5**2, 4 * 0.125 * 0.5
    eye = np.eye(3)
    moving = np.block([[position * eye, both * eye], [both * eye, velocity * eye]])
    np.testing.assert_allclose(after.covariance[:6, :6], moving)
    assert not after.covariance[6].any()  # no slip is looked for


def test_the_fusion_is_consistent():
    chi2 = pytest.importorskip("scipy.stats").chi2
    innovations, freedom, errors, runs, dt = 0.0, 0, 0.0, 20, 0.1
    for seed in range(runs):
        random = np.random.default_rng(seed)
        truth, estimate = np.zeros(6), fusion.hovering_at([0, 0, 0], 0.0, ERRORS)
        for step in range(100):
            acceleration = random.normal(0, 1, 3)
            truth[:3] += dt * truth[3:] + dt * dt / 2 * acceleration
            truth[3:] += dt * acceleration
            felt = acceleration + random.normal(0, ERRORS.acceleration_mps2, 3)
            estimate = fusion.moved(estimate, dt, ERRORS, felt)
            corrections = [fusion.by_odometry(estimate, truth[3:] + random.normal(0, 0.05, 3), ERRORS)]
            if step % 10 == 9:
                fix = truth[:3] + random.normal(0, 0.05, 3)
                corrections.append(fusion.by_position(corrections[0].estimate, fix, ERRORS))
            estimate = corrections[-1].estimate
            innovations += sum(correction.nis for correction in corrections)
            freedom += 3 * len(corrections)
        off = estimate.mean[:6] - truth
        errors += off @ np.linalg.solve(estimate.covariance[:6, :6], off)
    low, high = chi2.ppf([0.0005, 0.9995], freedom)
    assert low < innovations < high
    low, high = chi2.ppf([0.0005, 0.9995], 6 * runs)
    assert low < errors < high


def test_what_was_counted_leads_along_it_but_for_what_slips():
    estimate = fusion.hovering_at([1.0, 2.0, 3.0], 0.0, ERRORS)
    slips = Estimate([*estimate.mean[:6], 0.1], estimate.covariance)
    sure = AirErrors(acceleration_mps2=10.0, velocity_mps=1e-6)
    for start, kept in ((estimate, 1.0), (slips, 0.9)):
        after = fusion.moved_as_counted(start, 0.5, [1.0, -2.0, 0.4], sure)
        np.testing.assert_allclose(after.mean[:3], [1 + 0.5 * kept, 2 - kept, 3 + 0.2 * kept], atol=1e-9)
        np.testing.assert_allclose(after.mean[3:6], [1.0, -2.0, 0.4], atol=1e-9)


def test_what_is_felt_counts_where_odometry_is_worth_less():
    unsure = AirErrors(acceleration_mps2=1e-6, velocity_mps=10.0)
    after = fusion.moved_as_counted(fusion.hovering_at([0, 0, 0], 0.0, unsure), 0.5, [9, 9, 9], unsure, [1, 0, -2])
    np.testing.assert_allclose(after.mean[:6], [0.25, 0, -0.5, 0.5, 0, -1], atol=1e-9)


@given(st.lists(st.floats(-2, 2), min_size=7, max_size=7), st.floats(0.01, 2))
def test_the_derivative_of_the_motion(state, dt):
    state = np.array(state)
    _, derivative = fusion._flown(state, dt)
    for k, push in enumerate(1e-6 * np.eye(7)):
        numeric = (fusion._flown(state + push, dt)[0] - fusion._flown(state - push, dt)[0]) / 2e-6
        np.testing.assert_allclose(derivative[:, k], numeric, atol=1e-6)


def test_odometry_that_counts_too_much_is_found_out():
    errors, random = AirErrors(odometry_slip=0.1, position_m=0.05, velocity_mps=0.01), np.random.default_rng(1)
    estimate, truth = fusion.hovering_at([0, 0, 0], 0.0, errors), np.zeros(3)
    for step in range(600):
        velocity = np.array([np.cos(step / 100), np.sin(step / 100), 0.1])
        truth = truth + 0.1 * velocity
        estimate = fusion.moved_as_counted(estimate, 0.1, velocity / 0.93 + random.normal(0, 0.01, 3), errors)
        estimate = fusion.by_position(estimate, truth + random.normal(0, 0.05, 3), errors).estimate
    assert estimate.mean[fusion.SLIP] == pytest.approx(0.07, abs=0.01)
    np.testing.assert_allclose(estimate.mean[:3], truth, atol=0.05)


def test_refusals():
    estimate = fusion.hovering_at([0, 0, 0], 1.0, ERRORS)
    with pytest.raises(ParameterError, match=r"^dt: -1; expected seconds above 0$"):
        fusion.moved(estimate, -1, ERRORS)
    with pytest.raises(ParameterError, match=r"^measured: shape \(2,\); expected \(3,\)$"):
        fusion.by_position(estimate, [0.0, 0.0], ERRORS)
