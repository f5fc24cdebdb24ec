"""Points of interest: weighed as least squares has it, with an uncertainty that is true; remarks; raw estimates."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.perception.clusters import LONE
from muster.perception.estimates import NO_TAG, RawEstimates
from muster.perception.points_of_interest import points_of_interest, remarks


def ellipses(count, seed, size=2):
    random = np.random.default_rng(seed)
    sides = random.uniform(0.3, 1.0, (count, size, size)) * random.choice([-1, 1], (count, size, size))
    return sides @ np.swapaxes(sides, 1, 2) + 0.05 * np.eye(size)


def raw_of(places, covariances):
    n = len(places)
    return RawEstimates(
        np.asarray(places, dtype=float), covariances, np.zeros(n, dtype=np.int64), ("r",) * n, np.arange(n) * 0.1
    )


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


def hovering(seed, passes=6, sightings=20):
    """Two robots take themselves to be beside where they are, in each pass of 2 s by the same all the time."""
    random = np.random.default_rng(seed)
    raw = []
    for k, covariance in enumerate(ellipses(passes, seed)):
        place = random.multivariate_normal([0, 0], covariance)
        places = place + random.normal(0, 0.01, (sightings, 2))
        times = 10.0 * k + np.linspace(0, 1.9, sightings)
        covariances, tags = np.repeat(covariance[None], sightings, axis=0), np.zeros(sightings, dtype=np.int64)
        raw.append(RawEstimates(places, covariances, tags, (f"r_{k % 2}",) * sightings, times))
    return RawEstimates.joined(raw)


@pytest.mark.long
def test_sightings_that_share_an_error_count_as_one():
    def mean_square(independent_after_s):
        squares = []
        for seed in range(300):
            raw = hovering(seed)
            labels = np.zeros(len(raw), dtype=np.int64)
            (point,) = points_of_interest(raw, labels, independent_after_s=independent_after_s)
            squares.append(point.position @ np.linalg.solve(point.covariance, point.position))
        return np.mean(squares)

    assert mean_square(0.0) > 15
    assert 1.4 < mean_square(5.0) < 2 + 4 * math.sqrt(4 / 300)


def test_who_hovers_weighs_no_more_than_who_passes_by():
    covariances = np.repeat(np.eye(2)[None], 11, axis=0)
    places = np.array([[0.0, 0.0]] * 10 + [[1.0, 0.0]])
    times = np.array([0.1 * k for k in range(10)] + [7.0])
    raw = RawEstimates(places, covariances, np.zeros(11, dtype=np.int64), ("r_0",) * 11, times)
    (together,) = points_of_interest(raw, raw.tags, independent_after_s=5.0)
    (each,) = points_of_interest(raw, raw.tags)
    np.testing.assert_allclose(together.position, [0.5, 0])
    np.testing.assert_allclose(together.covariance, np.eye(2) / 2)
    np.testing.assert_allclose(each.position, [1 / 11, 0])
    by_two = RawEstimates(places, covariances, raw.tags, ("r_0",) * 9 + ("r_1", "r_1"), np.zeros(11))
    (other,) = points_of_interest(by_two, by_two.tags, independent_after_s=5.0)
    np.testing.assert_allclose(other.position, [0.25, 0])


def test_a_time_below_zero_is_refused():
    with pytest.raises(ParameterError, match="independent_after_s: -1; expected seconds of at least 0"):
        points_of_interest(RawEstimates.joined([]), np.array([], dtype=np.int64), independent_after_s=-1)


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
