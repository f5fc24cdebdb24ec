"""Curves and smoothing: through the points, free where the path is, arc length and curvature as geometry has them."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion.curve import Curve
from muster.motion.path import Path
from muster.motion.smoothing import clear_by_points, clear_by_segments, smoothed

coordinates = st.integers(-60, 60).map(lambda k: k / 10)
dimensions = st.sampled_from([2, 3])


def paths(least=2, most=7):
    return dimensions.flatmap(
        lambda d: st.lists(st.tuples(*[coordinates] * d), min_size=least, max_size=most).map(
            lambda points: Path(np.array(points, dtype=float))
        )
    )


def everywhere(points):
    return True


def circle(radius=2.0, angle=math.pi / 2):
    """The usual cubic of a circle's arc, right to 3e-4 of the radius."""
    k = 4 / 3 * math.tan(angle / 4) * radius
    end = radius * np.array([math.cos(angle), math.sin(angle)])
    back = k * np.array([math.sin(angle), -math.cos(angle)])
    return Curve(np.array([[[radius, 0], [radius, k], end + back, end]]))


class Disc:
    """All of space but a disc or ball."""

    def __init__(self, centre, radius):
        self.centre, self.radius = np.array(centre), radius

    def distance(self, points):
        return np.linalg.norm(points - self.centre, axis=1)

    def points(self, points):
        return self.distance(points) >= self.radius

    def segments(self, starts, ends):
        way = ends - starts
        square = np.sum(way**2, axis=1)
        share = np.sum((self.centre - starts) * way, axis=1) / np.where(square > 0, square, 1)
        return self.points(starts + np.clip(share, 0, 1)[:, None] * way)


@given(path=paths(1), step=st.sampled_from([0.05, 0.7, 100.0]))
def test_the_curve_passes_through_all_points_of_the_path(path, step):
    curve = smoothed(path, everywhere)
    sample = curve.sample(step)
    for point in path.points:
        assert np.linalg.norm(sample - point, axis=1).min() < 1e-9
    np.testing.assert_allclose(sample[[0, -1]], path.points[[0, -1]], atol=1e-9)
    assert np.linalg.norm(np.diff(sample, axis=0), axis=1).max(initial=0) <= step + 1e-9
    assert curve.length_m >= np.linalg.norm(path.points[-1] - path.points[0]) - 1e-9


@given(path=paths(), centre=st.tuples(coordinates, coordinates, coordinates), exact=st.booleans())
def test_a_smoothed_free_path_is_free(path, centre, exact):
    disc = Disc(centre[: path.points.shape[1]], 2.0)
    straight = clear_by_segments(disc.segments)
    assume(straight(path.points))
    clear = straight if exact else clear_by_points(disc.points, 0.05)
    curve = smoothed(path, clear, tolerance_m=1e-3)
    nearest = disc.distance(curve.sample(0.01)).min()
    assert nearest >= disc.radius - (1e-3 if exact else 1e-3 + 0.025)


@given(path=paths(3))
def test_where_nothing_is_free_the_curve_is_the_path(path):
    curve = smoothed(path, lambda points: False)
    assert curve.straight.all()
    assert curve.length_m == pytest.approx(path.length_m, abs=1e-9)


def test_handles_are_shortened_before_they_are_given_up():
    path = Path(np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]]))
    free = smoothed(path, everywhere)
    assert free.sample(0.01)[:, 1].min() < -0.1  # it swings out under the first piece
    kept = smoothed(path, lambda points: points[:, 1].min() >= -0.1)
    assert -0.1 - 1e-3 <= kept.sample(0.01)[:, 1].min() < 0
    assert not kept.straight[0]


@given(path=paths(3))
def test_the_direction_does_not_jump_at_points_without_reversal(path):
    points = smoothed(path, everywhere)
    last, first = points.control[:-1], points.control[1:]
    arriving, leaving = last[:, 3] - last[:, 2], first[:, 1] - first[:, 0]
    pieces = np.stack([last[:, 3] - last[:, 0], first[:, 3] - first[:, 0]])
    units = pieces / np.maximum(np.linalg.norm(pieces, axis=2, keepdims=True), 1e-300)
    turns = np.linalg.norm(units.sum(axis=0), axis=1) > 1e-3
    cosine = np.sum(arriving * leaving, axis=1)[turns]
    np.testing.assert_allclose(
        cosine, (np.linalg.norm(arriving, axis=1) * np.linalg.norm(leaving, axis=1))[turns], rtol=1e-6
    )


@given(path=paths(), shares=st.lists(st.floats(0, 1), min_size=1, max_size=5))
def test_arc_length_is_the_parameter(path, shares):
    curve = smoothed(path, everywhere)
    assume(curve.length_m > 0)
    way = np.sort(shares) * curve.length_m
    which, parts = curve.parameters(way)
    np.testing.assert_allclose(curve.arc_lengths(which, parts), way, atol=1e-6 * curve.length_m)
    fine = np.linalg.norm(np.diff(curve.sample(0.01), axis=0), axis=1).sum()
    assert curve.length_m == pytest.approx(fine, rel=1e-3)


@given(radius=st.floats(0.1, 50), angle=st.floats(0.1, math.pi / 2))
def test_length_and_curvature_of_a_circle(radius, angle):
    arc = circle(radius, angle)
    assert arc.length_m == pytest.approx(radius * angle, rel=1e-3)
    along = np.linspace(0, arc.length_m, 9)
    np.testing.assert_allclose(arc.curvature(along), 1 / radius, rtol=0.03)
    assert arc.max_curvature == pytest.approx(1 / radius, rel=0.03)
    np.testing.assert_allclose(np.linalg.norm(arc.points(along), axis=1), radius, rtol=1e-3)
    mirrored = Curve(arc.control * [1, -1])
    np.testing.assert_allclose(mirrored.curvature(along), -arc.curvature(along))
    lifted = Curve(np.concatenate([arc.control, np.ones((1, 4, 1))], axis=2))
    np.testing.assert_allclose(lifted.curvature(along), arc.curvature(along))


def test_equation_4_at_its_parameter():
    p = np.array([[0.0, 0.0], [1.0, 2.0], [3.0, 2.0], [4.0, 1.0]])
    t = 0.3
    expected = (-p[0] + 3 * p[1] - 3 * p[2] + p[3]) * t**3 + (3 * p[0] - 6 * p[1] + 3 * p[2]) * t**2
    expected += (-3 * p[0] + 3 * p[1]) * t + p[0]
    np.testing.assert_allclose(Curve(p[None]).points_at(np.array([0]), np.array([t]))[0], expected)


@pytest.mark.parametrize("points", [[[1.0, 2.0]], [[1.0, 2.0], [1.0, 2.0]]])
def test_a_path_of_no_length_is_a_point(points):
    curve = smoothed(Path(np.array(points)), everywhere)
    assert (curve.length_m, curve.max_curvature) == (0, 0)
    np.testing.assert_array_equal(curve.points([0.0, 3.0]), [[1, 2], [1, 2]])


@pytest.mark.parametrize("wrong", [{"handle": 0.0}, {"handle": 1.5}, {"tolerance_m": 0.0}])
def test_parameters_out_of_range(wrong):
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        smoothed(Path(np.zeros((3, 2))), everywhere, **wrong)


def test_a_step_of_nothing():
    with pytest.raises(ParameterError, match="step_m"):
        clear_by_points(lambda points: points[:, 0] > 0, 0.0)
