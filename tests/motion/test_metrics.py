"""Metrics: the published formulas, and the least distance between robots against a fine sampling."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion import metrics

coordinates = st.floats(-20, 20)


def array_of(*shape):
    size = math.prod(shape)
    return st.lists(coordinates, min_size=size, max_size=size).map(lambda values: np.array(values).reshape(shape))


def test_length_and_time():
    assert metrics.path_length(np.array([[0.0, 0], [3, 4], [3, 5]])) == 6
    assert metrics.travel_time(np.array([2.0, 3.0, 7.5])) == 5.5


def test_trajectory_error_of_7():
    reference = np.array([[0.0, 0], [1, 0], [2, 0]])
    found = metrics.trajectory_error(reference, reference + np.array([[0, 0], [0, 3], [4, 3]]))
    assert (found.total, found.most) == (8, 5)
    assert found.mean == pytest.approx(8 / 3)
    with pytest.raises(ParameterError, match="expected the same"):
        metrics.trajectory_error(reference, reference[1:])


def test_risk_factor_of_8():
    assert metrics.risk_factor(np.array([0.5, 2.0, 4.0])) == pytest.approx(2.75)
    assert metrics.risk_factor(np.array([1.0, 0.0])) == math.inf
    with pytest.raises(ParameterError, match="clearance"):
        metrics.risk_factor(np.array([1.0, -0.1]))


def test_smoothness_of_a_square_and_a_circle():
    square = np.array([[0.0, 0], [1, 0], [1, 0], [1, 1], [0, 1]])
    assert metrics.turning(square) == pytest.approx(math.pi)
    assert metrics.turning(np.array([[0.0, 0], [1, 0], [0, 0]])) == pytest.approx(math.pi)
    along = np.linspace(0, math.pi, 400)
    half = 2 * np.column_stack([np.cos(along), np.sin(along)])
    assert metrics.turning(half) == pytest.approx(math.pi, rel=0.01)
    assert metrics.turning(half[[0, -1]]) == 0


@given(times=st.lists(st.floats(0, 3), min_size=4, max_size=4).map(np.cumsum), positions=array_of(4, 3, 2))
def test_the_least_distance_is_that_of_a_fine_sampling(times, positions):
    assume(np.diff(times).min() >= 1e-3)
    found = metrics.closest(times, positions)
    fine = np.linspace(times[0], times[-1], 2001)
    dense = np.stack([[np.interp(fine, times, positions[:, k, a]) for a in range(2)] for k in range(3)])
    distances = [np.linalg.norm(dense[i] - dense[j], axis=0).min() for i, j in ((0, 1), (0, 2), (1, 2))]
    assert found.distance_m <= min(distances) + 1e-9
    steps = np.linalg.norm(np.diff(dense, axis=2), axis=1).max()
    assert found.distance_m >= min(distances) - 2 * steps
    at = [[np.interp(found.time_s, times, positions[:, k, a]) for a in range(2)] for k in found.pair]
    assert math.dist(*at) == pytest.approx(found.distance_m, abs=1e-6)


def test_robots_that_change_places_between_two_samples_meet():
    positions = np.array([[[0.0, 0], [4, 0], [9, 9]], [[4, 0], [0, 0], [9, 9]]])
    assert metrics.closest(np.array([1.0, 3.0]), positions) == metrics.Closest(0, 2, (0, 1))
    assert metrics.closest(np.array([1.0]), positions[:1]).distance_m == 4
    with pytest.raises(ParameterError, match="n >= 2"):
        metrics.closest(np.array([1.0]), positions[:1, :1])
