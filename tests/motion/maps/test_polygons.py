"""Growing and shrinking, against Shapely's buffers with very many sides."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from muster.motion.maps.polygons import free_region, grown, read_polygon

FINE = 500  # sides a quarter turn


@st.composite
def polygons(draw, corners=9):
    """Star-shaped polygons, with corners that bulge and corners that cave in."""
    count = draw(st.integers(3, corners))
    random = np.random.default_rng(draw(st.integers(0, 10**6)))
    angles = np.sort(random.uniform(0, 2 * math.pi, count))
    reach = random.uniform(1, 10, count)
    centre = random.uniform(-8, 8, 2)
    polygon = shapely.Polygon(centre + np.column_stack([np.cos(angles), np.sin(angles)]) * reach[:, None])
    assume(polygon.is_valid and polygon.area > 0.1)
    return polygon


@given(polygon=polygons(), radius=st.floats(0.01, 3))
def test_a_grown_polygon_is_never_too_small_and_hardly_too_large(polygon, radius):
    mine = grown(polygon, radius)
    true = polygon.buffer(radius, quad_segs=FINE)
    assert true.difference(mine).area < 1e-6  # the true one, inscribed in its arcs, is inside
    assert mine.difference(polygon.buffer(radius / math.cos(math.pi / 60) + 1e-6, quad_segs=FINE)).area < 1e-6
    assert shapely.distance(polygon, shapely.Point(0, 0)) <= shapely.distance(mine, shapely.Point(0, 0)) + radius + 0.01


@given(boundary=polygons(), obstacles=st.lists(polygons(5), max_size=2), radius=st.floats(0.01, 1.5))
def test_free_regions_keep_the_clearance_and_lose_little(boundary, obstacles, radius):
    region = free_region(boundary, obstacles, radius)
    walls = shapely.union_all([boundary.exterior, *obstacles])
    if not region.is_empty:
        assert shapely.distance(region, walls) >= radius - 1e-8
    true = boundary.difference(walls.buffer(radius / math.cos(math.pi / 60) + 1e-6, quad_segs=FINE))
    assert true.difference(region).area < 1e-5


@given(boundary=polygons(), radius=st.floats(0.1, 1.5))
def test_the_way_around_a_corner_is_hardly_too_long(boundary, radius):
    mine, true = grown(boundary, radius), boundary.convex_hull.buffer(radius, quad_segs=FINE)
    assert true.length * (1 - 1e-5) <= mine.convex_hull.length <= true.length * 1.001


def test_a_square_has_16_corners_a_corner():
    square = shapely.box(0, 0, 10, 10)
    assert len(grown(square, 1.0).exterior.coords) - 1 == 4 * 15
    assert free_region(square, [], 1.0).equals(shapely.box(1, 1, 9, 9))
    assert len(shapely.get_coordinates(free_region(square, [], 1.0))) == 5


def test_radius_0_changes_nothing():
    square, hole = shapely.box(0, 0, 10, 10), shapely.box(4, 4, 6, 6)
    assert grown(square, 0.0).equals(square)
    assert free_region(square, [hole], 0.0).equals(square.difference(hole))


def test_a_body_too_large_is_nowhere():
    assert free_region(shapely.box(0, 0, 2, 2), [], 1.5).is_empty


def test_a_wall_across_the_arena_parts_it():
    region = free_region(shapely.box(0, 0, 10, 10), [shapely.box(4, -1, 6, 11)], 0.5)
    assert isinstance(region, shapely.MultiPolygon)
    assert region.equals(shapely.box(0.5, 0.5, 3.5, 9.5).union(shapely.box(6.5, 0.5, 9.5, 9.5)))


@pytest.mark.parametrize(
    ("corners", "value"),
    [
        (((0, 0), (4, 4), (4, 0), (0, 4)), "crosses itself at (2, 2)"),
        (((0, 0), (4, 0), (4, 4), (2, 0), (0, 4)), "touches itself at (2, 0)"),
        (((0, 0), (1, 1), (2, 2)), "corners on one line"),
        (((0, 0), (1e12, 0), (0, 1)), "a polygon that reaches 1e+12 m"),
    ],
)
def test_what_is_no_polygon(corners, value):
    faults = []
    assert read_polygon(corners, ("map", "boundary"), faults) is None
    assert [fault.value for fault in faults] == [value]


def test_either_direction_and_a_closed_ring_are_right():
    faults = []
    corners = ((0, 0), (4, 0), (4, 4), (0, 0))
    assert read_polygon(corners, (), faults).equals(read_polygon(corners[::-1], (), faults))
    assert not faults


@pytest.mark.parametrize(
    "obstacles",
    [
        [shapely.box(-1, -1, 5, 5), shapely.box(5, 5, 11, 11)],  # at a corner
        [shapely.box(-1, 4, 5, 6), shapely.Polygon([(5, 5), (11, 3), (11, 7)])],  # a corner at a side
        [shapely.Polygon([(0, 4), (10, 5), (0, 6)])],  # a corner at the boundary
        [shapely.box(-1, 4, 5, 6), shapely.box(5 + 1e-9, 4, 11, 6)],  # a slit
    ],
)
def test_nothing_passes_where_obstacles_touch(obstacles):
    region = free_region(shapely.box(0, 0, 10, 10), obstacles, 0.0)
    parts = shapely.get_parts(region)
    assert len(parts) == 2
    assert shapely.distance(*parts) > 1e-7
    assert shapely.box(0, 0, 10, 10).difference(shapely.union_all([region, *obstacles])).area < 1e-8  # of the slit


def test_what_has_no_room_is_no_part():
    region = free_region(shapely.box(0, 0, 10, 10), [shapely.box(1e-8, 2, 10, 3)], 0.0)
    assert len(shapely.get_parts(region)) == 2
    assert free_region(shapely.box(0, 0, 10, 10), [shapely.box(1e-8, -1, 11, 11)], 0.0).is_empty
