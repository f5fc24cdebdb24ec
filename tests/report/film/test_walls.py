"""Lids: what they cover is just what is blocked."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

pytest.importorskip("mujoco")
shapely = pytest.importorskip("shapely")


@given(hnp.arrays(np.bool_, st.tuples(st.integers(1, 8), st.integers(1, 8))))
def test_rectangles_cover_each_blocked_cell_once(blocked):
    from muster.report.film.walls import rectangles

    covered = np.zeros(blocked.shape, dtype=int)
    for left, right, low, high in rectangles(blocked):
        covered[low:high, left:right] += 1
    np.testing.assert_array_equal(covered, blocked.astype(int))


@given(st.lists(st.floats(0.2, 3.0), min_size=3, max_size=9))
def test_triangles_fill_a_polygon(radii):
    from muster.report.film.walls import triangles

    angles = np.linspace(0, 2 * np.pi, len(radii), endpoint=False)
    star = np.array(radii)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    parts = [shapely.Polygon(corners) for corners in triangles(star)]
    assert sum(part.area for part in parts) == pytest.approx(shapely.Polygon(star).area)
    assert shapely.union_all(parts).area == pytest.approx(shapely.Polygon(star).area)
    for corners in triangles(star[::-1]):
        (a, b), (c, d) = corners[1] - corners[0], corners[2] - corners[0]
        assert a * d - b * c > 0
