"""Curves and smoothing: through the points, free where the path is, arc length and curvature as geometry has them."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion.curves.curve import Curve
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


def all_kept(path, clear, radius=0.5, **given):
    return smoothed(path, clear, radii_m=(radius,), keep=range(len(path.points)), **given)


def directions(curve, end):
    """Unit vectors at the beginnings (0) or ends (1) of segments."""
    return curve.tangents_at(np.arange(len(curve.control)), np.full(len(curve.control), float(end)))


@given(path=paths(1), step=st.sampled_from([0.05, 0.7, 100.0]))
def test_the_curve_passes_through_the_points_to_keep(path, step):
    curve = all_kept(path, everywhere).curve
    sample = curve.sample(step)
    for point in path.points:
        assert np.linalg.norm(sample - point, axis=1).min() < 1e-9
    np.testing.assert_allclose(sample[[0, -1]], path.points[[0, -1]], atol=1e-9)
    assert np.linalg.norm(np.diff(sample, axis=0), axis=1).max(initial=0) <= step + 1e-9
    assert curve.length_m >= np.linalg.norm(path.points[-1] - path.points[0]) - 1e-9


@given(path=paths(), centre=st.tuples(coordinates, coordinates, coordinates), exact=st.booleans(), kept=st.booleans())
def test_a_smoothed_free_path_is_free(path, centre, exact, kept):
    disc = Disc(centre[: path.points.shape[1]], 2.0)
    straight = clear_by_segments(disc.segments)
    assume(straight(path.points))
    clear = straight if exact else clear_by_points(disc.points, 0.05)
    found = smoothed(path, clear, radii_m=(0.6,), keep=range(len(path.points)) if kept else None, tolerance_m=1e-3)
    nearest = disc.distance(found.curve.sample(0.01)).min()
    assert nearest >= disc.radius - (1e-3 if exact else 1e-3 + 0.025)


@given(path=paths(), radii=st.lists(st.floats(0.05, 3), min_size=1, max_size=3), kept=st.booleans(), free=st.booleans())
def test_no_curve_turns_sharper_than_the_least_radius(path, radii, kept, free):
    clear = everywhere if free else lambda points: bool((points[:, 0] >= points[0, 0] - 0.5).all())
    found = smoothed(path, clear, radii_m=radii, keep=range(len(path.points)) if kept else None)
    assert found.curve.max_curvature <= (1 + 1e-3) / min(radii)


@given(path=paths(3), kept=st.booleans(), radius=st.sampled_from([0.05, 0.5, 2.0]))
def test_the_direction_jumps_at_the_corners_that_are_named_and_nowhere_else(path, kept, radius):
    found = smoothed(path, everywhere, radii_m=(radius,), keep=range(len(path.points)) if kept else None)
    curve = found.curve
    jumps = np.linalg.norm(directions(curve, 0)[1:] - directions(curve, 1)[:-1], axis=1) > 1e-6
    places = curve.control[1:, 0][jumps]
    named = found.corners
    for place in places:
        assert np.linalg.norm(named - place, axis=1).min(initial=np.inf) < 1e-9
    for corner in named:
        assert np.linalg.norm(places - corner, axis=1).min(initial=np.inf) < 1e-9
    gaps = np.linalg.norm(curve.control[1:, 0] - curve.control[:-1, 3], axis=1)
    assert gaps.max(initial=0.0) < 1e-8


@given(path=paths(3))
def test_where_nothing_is_free_the_curve_is_the_path(path):
    found = smoothed(path, lambda points: False, radii_m=(0.3,))
    assert found.curve.straight.all()
    assert found.curve.length_m == pytest.approx(path.length_m, abs=1e-9)


def test_a_corner_of_an_obstacle_is_passed_on_its_outer_side():
    """What the path goes around touches it at the corner, so the curve swings out and comes back."""
    path = Path(np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]]))
    clear = clear_by_points(lambda points: (points[:, 0] >= 4 - 1e-9) | (points[:, 1] <= 1e-9), 0.01)
    found = smoothed(path, clear, radii_m=(0.5,))
    sample = found.curve.sample(0.01)
    assert not len(found.corners)
    assert np.linalg.norm(sample - [4, 0], axis=1).min() < 1e-9
    # The middle arc swings out by R (1 - cos 45 degrees), and by as much again until it meets the outer arc.
    assert -0.2 < sample[:, 1].min() < -0.1


def test_where_there_is_room_inside_the_corner_is_cut():
    path = Path(np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]]))
    curve = smoothed(path, clear_by_segments(Disc((0.0, 4.0), 3.5).segments), radii_m=(0.5,)).curve
    # The arc that touches both pieces replaces two half metres by a quarter of a circle.
    assert curve.length_m == pytest.approx(8 - 1 + 0.5 * math.pi / 2, rel=1e-6)


def test_a_corner_without_room_stays_and_is_named():
    path = Path(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]))
    found = all_kept(path, everywhere, radius=2.0)
    assert found.corners.tolist() == [[1.0, 0.0]]
    assert found.curve.straight.all()
    assert not len(smoothed(path, everywhere, radii_m=(2.0, 0.2), keep=range(3)).corners)


def test_near_corners_are_rounded_as_one():
    """A way around the round end of a wall: its pieces are shorter than any arc of this radius needs."""
    angles = np.linspace(-math.pi / 2, 0.0, 7)
    around = np.column_stack([np.cos(angles), np.sin(angles)]) * 0.2
    path = Path(np.vstack([[-3.0, -0.2], around, [0.2, 3.0]]))

    def free(points):
        x, y = points.T
        return ((x >= 0) | (y <= -0.19)) & ((y <= 0) | (x >= 0.19)) & (np.hypot(x, y) >= 0.19)

    clear = clear_by_points(free, 0.005)
    found = smoothed(path, clear, radii_m=(0.5,))
    assert not len(found.corners)
    assert found.curve.max_curvature == pytest.approx(2.0, rel=1e-3)
    assert free(found.curve.sample(0.005)).all()
    assert len(all_kept(path, clear).corners) > 0


def test_shortcuts_are_taken_where_they_are_free():
    stairs = Path(np.array([[k // 2 + k % 2, k // 2] for k in range(12)], dtype=float))
    assert len(smoothed(stairs, everywhere, radii_m=(0.2,)).curve.control) == 1


@given(path=paths(), shares=st.lists(st.floats(0, 1), min_size=1, max_size=5))
def test_arc_length_is_the_parameter(path, shares):
    curve = all_kept(path, everywhere).curve
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
    curve = all_kept(Path(np.array(points)), everywhere).curve
    assert (curve.length_m, curve.max_curvature) == (0, 0)
    np.testing.assert_array_equal(curve.points([0.0, 3.0]), [[1, 2], [1, 2]])


@pytest.mark.parametrize("wrong", [{"radii_m": ()}, {"radii_m": (0.0,)}, {"tolerance_m": 0.0}])
def test_parameters_out_of_range(wrong):
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        smoothed(Path(np.zeros((3, 2))), everywhere, **{"radii_m": (1.0,)} | wrong)


def test_a_step_of_nothing():
    with pytest.raises(ParameterError, match="step_m"):
        clear_by_points(lambda points: points[:, 0] > 0, 0.0)
