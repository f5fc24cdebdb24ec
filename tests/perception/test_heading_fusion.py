"""A heading by gyro and fixes: a whole turn is none, the bias is learned, and the filter knows how much it errs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped
from muster.perception import heading_fusion as fusion
from muster.perception.errors import AirErrors

ERRORS = AirErrors(gyro_radps=0.02, gyro_bias_radps=0.03, heading_rad=0.05)


def test_a_step_by_hand():
    errors = AirErrors(gyro_radps=0.2, gyro_bias_radps=0.3, gyro_walk=0.1)
    after = fusion.turned(fusion.turned_to(1.0, 0.5, errors), 0.1, 2.0, errors)
    np.testing.assert_allclose(after.mean, [1.2, 0.0])
    np.testing.assert_allclose(
        after.covariance, [[0.25 + 0.01 * 0.09 + 0.0004, -0.1 * 0.09], [-0.1 * 0.09, 0.09 + 0.001]]
    )


@given(st.floats(-3.1, 3.1), st.floats(-10, 10))
def test_headings_are_the_same_a_turn_apart(heading, off):
    estimate = fusion.turned_to(heading, 0.1, ERRORS)
    here, around = (fusion.by_heading(estimate, heading + off + turn, ERRORS) for turn in (0.0, 2 * np.pi))
    assert wrapped(here.estimate.mean[0] - around.estimate.mean[0]) == pytest.approx(0, abs=1e-9)
    assert here.innovation == pytest.approx(wrapped(off), abs=1e-9)
    assert -np.pi <= here.estimate.mean[0] < np.pi


@pytest.mark.long
def test_the_fusion_is_consistent_and_learns_the_bias():
    from scipy.stats import chi2

    innovations, errors, runs, steps, dt = 0.0, 0.0, 30, 200, 0.1
    for seed in range(runs):
        random = np.random.default_rng(seed)
        truth, bias = random.normal(0, 0.05), random.normal(0, 0.03)
        estimate = fusion.turned_to(0.0, 0.05, ERRORS)
        for _ in range(steps):
            rate = random.uniform(-2, 2)
            truth, bias = truth + dt * rate, bias + random.normal(0, ERRORS.gyro_walk * np.sqrt(dt))
            estimate = fusion.turned(estimate, dt, rate + bias + random.normal(0, 0.02), ERRORS)
            correction = fusion.by_heading(estimate, truth + random.normal(0, 0.05), ERRORS)
            estimate, innovations = correction.estimate, innovations + correction.nis
        off = np.array([wrapped(estimate.mean[0] - truth), estimate.mean[1] - bias])
        errors += off @ np.linalg.solve(estimate.covariance, off)
    low, high = chi2.ppf([0.0005, 0.9995], runs * steps)
    assert low < innovations < high
    low, high = chi2.ppf([0.0005, 0.9995], 2 * runs)
    assert low < errors < high
    assert estimate.deviations[1] < 0.1 * ERRORS.gyro_bias_radps


def test_refusals():
    with pytest.raises(ParameterError, match=r"^dt: 0; expected seconds above 0$"):
        fusion.turned(fusion.turned_to(0.0, 0.1, ERRORS), 0, 0.0, ERRORS)
