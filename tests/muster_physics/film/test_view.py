"""The camera of a film: everything is in the picture, and the picture is no larger than it must be."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from muster_physics.film.view import Frame, view_of

FRAME = Frame(960, 540, 28, 20, 74, 30)
PLACES = hnp.arrays(np.float64, (6, 3), elements=st.floats(-50, 50, width=32))
SQUARE = np.array([(0.0, 0.0, 0.0), (1.0, 1.0, 0.0)])


@given(PLACES)
def test_all_places_are_within_what_is_not_kept_free_and_two_sides_are_touched(places):
    view = view_of(np.concatenate([places, SQUARE]), FRAME)
    x, y = view.pixels(np.concatenate([places, SQUARE])).T
    gaps = np.array([x.min() - 28, 940 - x.max(), y.min() - 74, 510 - y.max()])
    assert (gaps > -0.01).all()
    assert (np.abs(gaps[:2]) < 0.01).all() or (np.abs(gaps[2:]) < 0.01).all()


@given(PLACES)
def test_the_camera_is_upright_and_above(places):
    view = view_of(np.concatenate([places, SQUARE]), FRAME)
    np.testing.assert_allclose(view.axes.T @ view.axes, np.eye(3), atol=1e-12)
    assert np.linalg.det(view.axes) > 0.99
    assert abs(view.axes[2, 0]) < 1e-12
    assert view.position[2] > places[:, 2].max()


def test_north_is_up_where_the_mission_is_wide_and_west_where_it_is_long():
    wide = np.array([(0.0, 0.0, 0.0), (8.0, 2.0, 0.0)])
    (south, north) = view_of(wide, FRAME).pixels(np.array([(4.0, 0.5, 0.0), (4.0, 1.5, 0.0)]))
    assert north[1] < south[1]
    long = wide[:, [1, 0, 2]]
    (east, west) = view_of(long, FRAME).pixels(np.array([(1.5, 4.0, 0.0), (0.5, 4.0, 0.0)]))
    assert west[1] < east[1]
