"""Points of interest: weighed as least squares has it, with an uncertainty that is true; remarks; raw estimates."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.perception.clusters import LONE
from muster.perception.estimates import NO_TAG, RawEstimates
from muster.perception.interest import points_of_interest, remarks


def ellipses(count, seed, size=2):
    random = np.random.default_rng(seed)
    sides = random.uniform(0.3, 1.0, (count, size, size)) * random.choice([-1, 1], (count, size, size))
    return sides @ np.swapaxes(sides, 1, 2) + 0.05 * np.eye(size)


def raw_of(places, covariances):
    n = len(places)
    return RawEstimates(np.asarray(places, dtype=float), covariances, np.zeros(n, dtype=np.int64), ("r",) * n)


def one(raw):
    (point,) = points_of_interest(raw, np.zeros(len(raw), dtype=np.int64))
    return point


@given(st.integers(2, 12), st.integers(0, 1000), st.sampled_from([2, 3]))
def test_weighing_is_least_squares(count, seed, size):
    places = np.random.default_rng(seed).normal(0, 1, (count, size))
    covariances = ellipses(count, seed, size)
    roots = [np.linalg.cholesky(np.linalg.inv(c)).T for c in covariances]
    best = np.linalg.lstsq(np.vstack(roots), np.concatenate([r @ p for r, p in zip(roots, places, strict=True)]))[0]
    np.testing.assert_allclose(one(raw_of(places, covariances)).position, best, atol=1e-8)


def test_equal_covariances_give_the_plain_mean():
    places = np.random.default_rng(0).normal(0, 1, (9, 2))
    weighed = one(raw_of(places, np.repeat(2 * np.eye(2)[None], 9, axis=0)))
    plain = one(RawEstimates.at(places))
    np.testing.assert_allclose(weighed.position, plain.position)
    np.testing.assert_allclose(plain.covariance, np.cov(places.T) / 9)


def test_the_uncertainty_is_consistent():
    """The normalised squared error of many points: on average as many as there are coordinates, within 4 sigma."""
    random, trials, count = np.random.default_rng(5), 400, 8
    squares = []
    for trial in range(trials):
        covariances = ellipses(count, trial)
        places = np.array([random.multivariate_normal([0, 0], c) for c in covariances])
        point = one(raw_of(places, covariances))
        squares.append(point.position @ np.linalg.solve(point.covariance, point.position))
    # the scatter may make a covariance larger, never smaller: somewhat below 2 is right, above is not
    assert 1.4 < np.mean(squares) < 2 + 4 * math.sqrt(4 / trials)


def test_estimates_that_scatter_too_much_give_a_larger_uncertainty():
    covariances = np.repeat(0.01 * np.eye(2)[None], 40, axis=0)
    calm = np.random.default_rng(1).normal(0, 0.1, (40, 2))
    wild = 10 * calm
    ratio = one(raw_of(wild, covariances)).covariance[0, 0] / one(raw_of(calm, covariances)).covariance[0, 0]
    assert 50 < ratio < 200


def test_views_from_two_sides_beat_the_mean():
    """Two stretched views, across each other: their ellipses cross at the thing."""
    covariances = np.array([np.diag([1.0, 1e-4]), np.diag([1e-4, 1.0])])
    point = one(raw_of([[0.8, 0.0], [0.0, -0.6]], covariances))
    np.testing.assert_allclose(point.position, [0, 0], atol=1e-3)


def test_one_sighting():
    assert np.isnan(one(RawEstimates.at([[1, 2]])).covariance).all()
    covariance = np.array([[[0.2, 0.1], [0.1, 0.3]]])
    point = one(raw_of([[1, 2]], covariance))
    np.testing.assert_allclose(point.covariance, covariance[0])
    np.testing.assert_allclose(point.position, [1, 2])


def test_who_saw_what_how_often():
    raw = RawEstimates.joined(
        [
            RawEstimates.at([[0, 0], [0, 1], [5, 5]], [4, 4, NO_TAG], "b"),
            RawEstimates.at([[0, 0], [9, 9], [5, 5]], [2, 4, NO_TAG], "a"),
        ]
    )
    first, second = points_of_interest(raw, np.array([0, 0, 1, 0, LONE, 1]))
    assert (first.sightings, first.robots, first.tag) == (3, ("a", "b"), 4)
    assert (second.sightings, second.robots, second.tag) == (2, ("a", "b"), None)
    assert (
        points_of_interest(raw, np.array([0, 0, 1, 0, LONE, 1]), least=3)[0].position.tolist()
        == first.position.tolist()
    )
    assert len(points_of_interest(raw, np.array([0, 0, 1, 0, LONE, 1]), least=3)) == 1


def test_remarks():
    raw = RawEstimates.at([[0, 0], [5, 5], [2, 2]], [4, 4, 5])
    assert remarks(points_of_interest(raw, np.array([0, 1, 2]))) == ("tag 4 is at 2 places",)
    assert remarks(points_of_interest(raw, np.array([0, 0, 1]))) == ()
    assert remarks(()) == ("no point of interest: no tag was seen",)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: RawEstimates.at(np.zeros(4)), r"positions: shape \(4,\); expected \(n, 2\) or \(n, 3\)"),
        (lambda: RawEstimates.at([[0, math.nan]]), "positions: a number that is not finite"),
        (lambda: RawEstimates.at([[0, 0]], [1, 2]), r"tags: shape \(2,\); expected \(1,\), as the positions"),
        (lambda: raw_of([[0, 0]], np.zeros((1, 2, 2))), "covariances: one that is not positive definite"),
        (lambda: raw_of([[0, 0]], np.zeros((1, 3, 3))), r"covariances: shape \(1, 3, 3\); expected \(1, 2, 2\)"),
        (
            lambda: RawEstimates.joined([RawEstimates.at([[0, 0]]), RawEstimates.at([[0, 0, 0]])]),
            "parts: some with two and some with three coordinates",
        ),
        (
            lambda: RawEstimates.joined([RawEstimates.at([[0, 0]]), raw_of([[0, 0]], np.eye(2)[None])]),
            "parts: some with and some without covariances",
        ),
    ],
)
def test_raw_estimates_that_do_not_fit_are_refused(make, message):
    with pytest.raises(ParameterError, match=message):
        make()
