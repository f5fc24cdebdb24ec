"""Kalman filters: the published equations, entry by entry; equal to each other, to Joseph's form, and consistent."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.perception.kalman import (
    GATES,
    Estimate,
    corrected,
    extended_correction,
    extended_prediction,
    gated,
    predicted,
)

seeds = st.integers(0, 2**32 - 1)


def covariance(random, n, least=0.1):
    root = random.normal(size=(n, n))
    return root @ root.T + least * np.eye(n)


def drawn(seed, n=4, m=2):
    random = np.random.default_rng(seed)
    estimate = Estimate(random.normal(size=n), covariance(random, n))
    return random, estimate, random.normal(size=(m, n)), random.normal(size=m), covariance(random, m)


def same(a, b, tolerance=1e-9):
    np.testing.assert_allclose(a, b, rtol=0, atol=tolerance)


def test_predict_by_2_1_and_2_2():
    estimate = Estimate([1.0, 2.0], [[4.0, 1.0], [1.0, 9.0]])
    after = predicted(estimate, [[1.0, 0.5], [0.0, 1.0]], [[0.1, 0.0], [0.0, 0.2]], [[0.125], [0.5]], [2.0])
    same(after.mean, [1 + 0.5 * 2 + 0.125 * 2, 2 + 0.5 * 2])
    same(after.covariance, [[4 + 2 * 0.5 + 0.25 * 9 + 0.1, 1 + 0.5 * 9], [1 + 0.5 * 9, 9.2]])


def test_update_by_2_3_to_2_5():
    estimate = Estimate([1.0, 2.0], [[4.0, 1.0], [1.0, 9.0]])
    correction = corrected(estimate, [[1.0, 0.0]], [3.0], [[1.0]])
    same(correction.innovation, [2.0])  # (2.5)
    same(correction.innovation_covariance, [[5.0]])
    same(correction.gain, [[0.8], [0.2]])
    same(correction.estimate.mean, [1 + 0.8 * 2, 2 + 0.2 * 2])  # (2.3)
    same(correction.estimate.covariance, [[0.8, 0.2], [0.2, 9 - 0.2]])  # (2.4)
    assert correction.nis == pytest.approx(4 / 5)


@given(seeds)
def test_josephs_form_is_2_4(seed):
    _, estimate, sensor, measured, uncertainty = drawn(seed)
    correction = corrected(estimate, sensor, measured, uncertainty)
    printed = estimate.covariance - correction.gain @ sensor @ estimate.covariance
    same(correction.estimate.covariance, printed, 1e-8)


@given(seeds)
def test_a_measurement_never_makes_less_sure(seed):
    _, estimate, sensor, measured, uncertainty = drawn(seed)
    after = corrected(estimate, sensor, measured, uncertainty).estimate
    assert np.linalg.eigvalsh(estimate.covariance - after.covariance)[0] >= -1e-9


@given(seeds)
def test_the_order_of_measurements_does_not_matter(seed):
    random, estimate, sensor, measured, uncertainty = drawn(seed)
    other, said, doubt = random.normal(size=(1, 4)), random.normal(size=1), covariance(random, 1)
    one = corrected(corrected(estimate, sensor, measured, uncertainty).estimate, other, said, doubt).estimate
    two = corrected(corrected(estimate, other, said, doubt).estimate, sensor, measured, uncertainty).estimate
    same(one.mean, two.mean, 1e-6)
    same(one.covariance, two.covariance, 1e-6)


@given(seeds)
def test_the_extended_filter_of_linear_functions_is_the_linear_one(seed):
    random, estimate, sensor, measured, uncertainty = drawn(seed)
    transition, process = random.normal(size=(4, 4)), covariance(random, 4)
    linear = predicted(estimate, transition, process)
    extended = extended_prediction(estimate, lambda x: (transition @ x, transition), process)
    same(linear.mean, extended.mean)
    same(linear.covariance, extended.covariance)
    linear = corrected(estimate, sensor, measured, uncertainty)
    extended = extended_correction(estimate, lambda x: (sensor @ x, sensor), measured, uncertainty)
    same(linear.estimate.mean, extended.estimate.mean)
    same(linear.estimate.covariance, extended.estimate.covariance)
    assert linear.nis == extended.nis


def test_a_filter_that_knows_its_errors_is_consistent():
    """The sum of innovations squared is chi-square, and so is the error at the end."""
    chi2 = pytest.importorskip("scipy.stats").chi2
    random, dt, runs, steps = np.random.default_rng(1), 0.1, 40, 100
    transition, effect = np.array([[1, dt], [0, 1]]), np.array([[dt * dt / 2], [dt]])
    process, uncertainty = 0.5**2 * effect @ effect.T, np.array([[0.2**2]])
    innovations = errors = 0.0
    for _ in range(runs):
        estimate = Estimate([0.0, 0.0], np.diag([1.0, 1.0]))
        truth = random.normal(size=2)
        for _ in range(steps):
            truth = transition @ truth + effect[:, 0] * random.normal(0, 0.5)
            estimate = predicted(estimate, transition, process)
            correction = corrected(estimate, [[1.0, 0.0]], truth[:1] + random.normal(0, 0.2), uncertainty)
            estimate = correction.estimate
            innovations += correction.nis
        off = estimate.mean - truth
        errors += off @ np.linalg.solve(estimate.covariance, off)
    low, high = chi2.ppf([0.0005, 0.9995], runs * steps)
    assert low < innovations < high
    low, high = chi2.ppf([0.0005, 0.9995], runs * 2)
    assert low < errors < high


@pytest.mark.parametrize("freedom", GATES)
def test_gates_are_quantiles(freedom):
    chi2 = pytest.importorskip("scipy.stats").chi2
    assert GATES[freedom] == pytest.approx(chi2.ppf(0.999, freedom), abs=5e-4)


def test_what_chance_does_not_explain_is_left_out():
    estimate = Estimate([0.0], [[1.0]])
    likely, absurd = (corrected(estimate, [[1.0]], [y], [[1.0]]) for y in (4.0, 5.0))
    assert (likely.nis, absurd.nis) == pytest.approx((8.0, 12.5))
    assert gated(estimate, likely) is likely.estimate
    assert gated(estimate, absurd) is estimate


def test_estimates_cannot_be_written():
    mean = np.zeros(2)
    estimate = Estimate(mean, np.eye(2))
    mean[0] = 1
    assert estimate.mean[0] == 0
    with pytest.raises(ValueError, match="read-only"):
        estimate.mean[0] = 1
    same(estimate.deviations, [1, 1])


ESTIMATE = Estimate([0.0, 0.0], np.eye(2))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Estimate([[0.0]], [[1.0]]), "mean: shape (1, 1); expected (any,)"),
        (lambda: Estimate([0.0, 0.0], [[1.0]]), "covariance: shape (1, 1); expected (2, 2)"),
        (lambda: Estimate([math.nan], [[1.0]]), "mean: [nan]; expected finite numbers"),
        (lambda: Estimate(["a"], [[1.0]]), "mean: ['a']; expected an array of numbers"),
        (lambda: Estimate([0.0], [[-1.0]]), "covariance: eigenvalue -1; expected none below 0"),
        (
            lambda: Estimate([0, 0], [[1.0, 0.5], [0.0, 1.0]]),
            "covariance: [[1.0, 0.5], [0.0, 1.0]]; expected a symmetric matrix",
        ),
        (lambda: predicted(ESTIMATE, np.eye(3), np.eye(2)), "transition: shape (3, 3); expected (2, 2)"),
        (lambda: predicted(ESTIMATE, np.eye(2), np.eye(3)), "process: shape (3, 3); expected (2, 2)"),
        (
            lambda: predicted(ESTIMATE, np.eye(2), np.eye(2), np.eye(2)),
            "effect, control: one without the other; expected both or none",
        ),
        (
            lambda: predicted(ESTIMATE, np.eye(2), np.eye(2), np.eye(2), [1.0]),
            "effect: shape (2, 2); expected (2, 1)",
        ),
        (lambda: corrected(ESTIMATE, [[1.0]], [1.0], [[1.0]]), "sensor: shape (1, 1); expected (any, 2)"),
        (lambda: corrected(ESTIMATE, np.eye(2), [1.0], np.eye(2)), "measured: shape (1,); expected (2,)"),
        (lambda: corrected(ESTIMATE, np.eye(2), [1.0, 1.0], [[1.0]]), "uncertainty: shape (1, 1); expected (2, 2)"),
        (
            lambda: corrected(Estimate([0.0], [[0.0]]), [[1.0]], [1.0], [[0.0]]),
            "uncertainty: [[0.0]]; expected variance where the state itself leaves none to the measurement",
        ),
        (
            lambda: extended_prediction(ESTIMATE, lambda x: (x[:1], np.eye(2)), np.eye(2)),
            "motion: shape (1,); expected (2,)",
        ),
        (
            lambda: extended_correction(ESTIMATE, lambda x: (x, np.eye(3)), [1.0, 1.0], np.eye(2)),
            "sensor's derivative: shape (3, 3); expected (any, 2)",
        ),
    ],
)
def test_what_does_not_fit_is_refused(call, message):
    with pytest.raises(ParameterError) as refusal:
        call()
    assert str(refusal.value) == message


@given(seeds)
def test_around_another_mean_is_the_same_doubt(seed):
    random, estimate, *_ = drawn(seed)
    mean = random.normal(size=4)
    moved = estimate.around(mean)
    same(moved.mean, mean)
    assert (moved.covariance == estimate.covariance).all()
    assert not moved.mean.flags.writeable
    with pytest.raises(ParameterError, match=r"^mean: shape \(3,\); expected \(4,\)$"):
        estimate.around(mean[:3])


@given(seeds)
def test_what_filters_make_is_an_estimate(seed):
    """They do not look at eigenvalues again; the covariances are such all the same, and nobody can write them."""
    random, estimate, sensor, measured, uncertainty = drawn(seed)
    for _ in range(20):
        estimate = predicted(estimate, random.normal(size=(4, 4)), covariance(random, 4))
        estimate = corrected(estimate, sensor, measured, uncertainty).estimate
        Estimate(estimate.mean, estimate.covariance)
        with pytest.raises(ValueError, match="read-only"):
            estimate.covariance[0, 0] = 1.0


def test_numbers_that_run_away_are_told():
    with np.errstate(all="ignore"), pytest.raises(ParameterError, match=r"expected a finite estimate$"):
        predicted(Estimate([1e300], [[1.0]]), [[1e300]], [[1.0]])
