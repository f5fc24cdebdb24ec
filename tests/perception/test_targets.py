"""Targets seen by several robots: the covariance of a sighting, averages, crossings."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.perception.kalman import Estimate
from muster.perception.targets import TargetSighting, averaged, crossing

angles = st.floats(-math.pi, math.pi)


def sighting(pose, range_m, bearing, deviations=(0.05, 0.05, 0.05)):
    return TargetSighting(Estimate(np.array(pose), np.diag(np.square(deviations))), range_m, bearing, 0.01, 0.006)


def test_a_sighting_by_hand():
    """Straight north at 2 m: errors of heading and bearing go east, of the range north."""
    target = sighting((1.0, 1.0, math.pi / 2), 2.0, 0.0, (0.03, 0.04, 0.05)).target
    np.testing.assert_allclose(target.mean, [1.0, 3.0], atol=1e-12)
    east, north = 0.03**2 + (2 * 0.05) ** 2 + (2 * 0.006) ** 2, 0.04**2 + 0.01**2
    np.testing.assert_allclose(target.covariance, [[east, 0], [0, north]], atol=1e-15)


def test_a_sighting_is_as_far_off_as_it_says():
    """Drawn 20,000 times."""
    random = np.random.default_rng(2)
    seen = sighting((0.3, -0.2, 0.7), 1.5, -0.4, (0.02, 0.03, 0.02))
    poses = seen.pose.mean + random.normal(size=(20_000, 3)) * seen.pose.deviations
    away, direction = 1.5 + random.normal(0, 0.01, 20_000), poses[:, 2] - 0.4 + random.normal(0, 0.006, 20_000)
    drawn = poses[:, :2] + away[:, None] * np.column_stack([np.cos(direction), np.sin(direction)])
    np.testing.assert_allclose(np.cov(drawn.T), seen.target.covariance, rtol=0.1, atol=5e-5)


def test_an_average_by_hand():
    one, two = Estimate([0.0], [[1.0]]), Estimate([3.0], [[2.0]])
    joint = averaged([one, two])
    assert joint.mean[0] == pytest.approx(1.0)
    assert joint.covariance[0, 0] == pytest.approx(2 / 3)


@given(st.integers(1, 5))
def test_equal_estimates_average_to_their_mean_with_less_variance(count):
    random = np.random.default_rng(count)
    places = random.normal(size=(count, 2))
    joint = averaged([Estimate(place, np.diag([0.1, 0.2])) for place in places])
    np.testing.assert_allclose(joint.mean, places.mean(axis=0), atol=1e-12)
    np.testing.assert_allclose(joint.covariance, np.diag([0.1, 0.2]) / count, atol=1e-12)


def test_three_robots_are_nearer_than_one():
    """Over 200 draws; and the joint error is what its covariance says (chi-square, 99.9 %)."""
    chi2 = pytest.importorskip("scipy.stats").chi2
    random, target = np.random.default_rng(4), np.array([0.2, 0.1])
    poses = [(-0.8, -0.8, 0.5), (0.8, -0.7, 2.0), (0.0, 0.9, -1.5)]
    singles, joints, squares = [], [], 0.0
    for _ in range(200):
        seen = []
        for x, y, heading in poses:
            believed = np.array([x, y, heading]) + random.normal(0, 0.02, 3)
            away = math.dist((x, y), target) + random.normal(0, 0.01)
            bearing = math.atan2(target[1] - y, target[0] - x) - heading + random.normal(0, 0.006)
            seen.append(sighting(believed, away, bearing, (0.02, 0.02, 0.02)).target)
        joint = averaged(seen)
        singles.append(np.hypot(*(seen[0].mean - target)))
        off = joint.mean - target
        joints.append(np.hypot(*off))
        squares += off @ np.linalg.solve(joint.covariance, off)
    assert np.mean(joints) < 0.7 * np.mean(singles)
    low, high = chi2.ppf([0.0005, 0.9995], 400)
    assert low < squares < high


@given(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), angles)
def test_exact_bearings_cross_at_the_target(target, turn):
    places = np.array([[math.cos(turn + k), math.sin(turn + k)] for k in (0.0, 1.0, 2.5)]) * 6
    directions = np.arctan2(target[1] - places[:, 1], target[0] - places[:, 0])
    assert math.dist(crossing(places, directions), target) < 1e-9


def test_parallel_bearings_do_not_cross():
    assert crossing(np.array([[0.0, 0.0], [0.0, 1.0]]), np.array([0.3, 0.3])) is None
    assert crossing(np.array([[0.0, 0.0]]), np.array([0.3])) is None


def test_refusals():
    with pytest.raises(ParameterError, match=r"^estimates: none; expected at least one$"):
        averaged([])
    with pytest.raises(ParameterError, match=r"^estimates: one without variance"):
        averaged([Estimate([0.0], [[0.0]])])
    with pytest.raises(ParameterError, match=r"^pose: 2 numbers; expected x, y, heading$"):
        sighting((0.0, 0.0), 1.0, 0.0, (1.0, 1.0))
    with pytest.raises(ParameterError, match=r"^places, directions: shapes \(2, 2\), \(3,\); expected"):
        crossing(np.zeros((2, 2)), np.zeros(3))
