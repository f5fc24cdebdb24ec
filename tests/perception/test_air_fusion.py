"""A drone's position: the model entry by entry, and consistency."""

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.perception import air_fusion as fusion
from muster.perception.errors import AirErrors

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


def test_refusals():
    estimate = fusion.hovering_at([0, 0, 0], 1.0, ERRORS)
    with pytest.raises(ParameterError, match=r"^dt: -1; expected seconds above 0$"):
        fusion.moved(estimate, -1, ERRORS)
    with pytest.raises(ParameterError, match=r"^measured: shape \(2,\); expected \(3,\)$"):
        fusion.by_position(estimate, [0.0, 0.0], ERRORS)
