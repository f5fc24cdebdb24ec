"""Polygons as cells: blocked as soon as some of a cell is."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion.free_space import PolygonSpace
from muster.motion.maps import default_resolution, grid_of
from muster.motion.maps.raster import touched


@st.composite
def shapes(draw):
    """Unions of a few triangles and boxes, with holes and in several parts."""
    random = np.random.default_rng(draw(st.integers(0, 10**6)))
    triangles = [shapely.Polygon(random.uniform(-2, 14, (3, 2))).buffer(0) for _ in range(draw(st.integers(1, 3)))]
    solid = shapely.union_all([*triangles, shapely.box(1, 1, *random.uniform(2, 12, 2))])
    return solid.difference(shapely.Point(5, 5).buffer(random.uniform(0.1, 3)))


def overlap(shape, rows, columns):
    return np.array(
        [[shape.intersection(shapely.box(c, r, c + 1, r + 1)).area for c in range(columns)] for r in range(rows)]
    )


@settings(max_examples=40)
@given(shape=shapes())
def test_the_cells_touched_are_those_that_share_some_area(shape):
    areas = overlap(shape, 9, 12)
    marked = touched(shape, (9, 12))
    assert marked[areas > 1e-7].all()
    assert not marked[areas == 0].any()


@pytest.mark.long
@settings(max_examples=40)
@given(shape=shapes(), resolution=st.floats(0.2, 3))
def test_free_cells_lie_wholly_in_the_region(shape, resolution):
    grid = grid_of(PolygonSpace(shape), resolution)
    for row, column in np.argwhere(~grid.blocked):
        corners = np.array([(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)], dtype=float)
        assert shapely.Polygon(grid.to_map(corners)).difference(shape).area < 1e-8
    west, south, east, north = shape.bounds
    assert grid.shape[0] * resolution >= north - south - 1e-6
    assert grid.shape[1] * resolution >= east - west - 1e-6


def test_whole_cells_of_a_box_are_all_free():
    assert not grid_of(PolygonSpace(shapely.box(0.1, 0.1, 0.7, 0.4)), 0.1).blocked.any()
    assert touched(shapely.box(2, 1, 4, 2), (4, 6)).sum() == 2


def test_an_empty_region_is_one_blocked_cell():
    assert grid_of(PolygonSpace(shapely.MultiPolygon()), 0.5).blocked.all()
    assert not touched(shapely.Polygon(), (2, 2)).any()


@pytest.mark.parametrize("resolution", [0, -1, float("nan"), 1e-6])
def test_resolutions_that_cannot_be(resolution):
    with pytest.raises(ParameterError, match="resolution_m"):
        grid_of(PolygonSpace(shapely.box(0, 0, 10, 10)), resolution)


@pytest.mark.parametrize(
    ("radius", "extent", "resolution"), [(0.2, 40, 0.1), (0, 50, 0.1), (0.01, 100, 0.1), (5, 20, 0.2)]
)
def test_default_resolution(radius, extent, resolution):
    assert default_resolution(radius, extent) == pytest.approx(resolution)
