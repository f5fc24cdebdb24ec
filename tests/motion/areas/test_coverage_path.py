"""Ways over areas: every place is seen, no way leaves the area or crosses a hole; checked by Shapely."""

import math
import os
from itertools import pairwise

import numpy as np
import pytest
import shapely

from muster.motion.areas.coverage_path import MOST_LANES, TooManyLanesError, coverage_path
from muster_studies.instances.random_areas import random_area, surface

SEEDS = int(os.environ.get("MUSTER_AREAS", "16"))
"""`make campaign-coverage` has 200."""
SEEN = 1e-9
"""Of an area: what may be left, by rounding."""


def seen_from(path, width):
    """What is seen from lanes: so far to both sides, from end to end; built apart from the code that is tested."""
    lanes = [lane for lane in path.lanes if not (lane[0] == lane[1]).all()]
    return shapely.union_all([shapely.LineString(lane).buffer(width / 2, cap_style="flat") for lane in lanes])


def whole_way(path):
    """All that is passed, as one line."""
    points = [path.lanes[0, 0]]
    for k, (begin, end) in enumerate(path.lanes):
        points += [*path.bends(path.lanes[k - 1, 1], begin), begin, end] if k else [end]
    return shapely.LineString(points)


def check(area, holes, width, cross_holes=False, heading=None):
    path = coverage_path(area, holes, width, heading, cross_holes=cross_holes)
    left = surface(area, holes).difference(seen_from(path, width))
    assert left.area <= SEEN * surface(area, holes).area
    rounding = 1e-6 * math.sqrt(shapely.Polygon(area).area)
    grown = shapely.Polygon(area).buffer(max(rounding, 1.001e-3 * width), join_style="mitre")
    assert grown.covers(whole_way(path))
    if not cross_holes:
        inside = shapely.union_all([shapely.Polygon(hole) for hole in holes]).buffer(-rounding)
        assert whole_way(path).intersection(inside).length == 0
    assert whole_way(path).length == pytest.approx(path.length_m)
    assert path.length_m >= surface(area, holes).area / width - width
    return path


def square(x, y, wide, high=None):
    return ((x, y), (x + wide, y), (x + wide, y + (high or wide)), (x, y + (high or wide)))


def star(points, inner, size=100.0):
    away = [size * (inner if k % 2 else 1.0) for k in range(2 * points)]
    angles = [k * math.pi / points for k in range(2 * points)]
    return tuple((r * math.cos(a), r * math.sin(a)) for r, a in zip(away, angles, strict=True))


L_SHAPE = ((0, 0), (100, 0), (100, 20), (20, 20), (20, 100), (0, 100))
THIN_L = ((0, 0), (100, 0), (100, 2), (2, 2), (2, 100), (0, 100))


@pytest.mark.long(keep=6)
@pytest.mark.parametrize("seed", sorted({*range(SEEDS), 96}))  # slivers at a hole that is not crossed
def test_every_place_of_random_areas_is_seen(seed):
    check(*random_area(seed), cross_holes=seed % 3 == 2)


@pytest.mark.parametrize(
    ("area", "holes", "width"),
    [
        pytest.param(square(0, 0, 1000, 0.5), (), 2.0, marks=pytest.mark.long),
        (((0, 0), (1000, 1000), (1000, 1000.5), (0, 0.5)), (), 2.0),
        (L_SHAPE, (), 5.0),
        (THIN_L, (), 5.0),
        (star(5, 0.4), (), 5.0),
        pytest.param(star(5, 0.05), (), 5.0, marks=pytest.mark.long),
        pytest.param(star(7, 0.3), (square(-5, -5, 10),), 4.0, marks=pytest.mark.long),
        (square(0, 0, 100), (square(0.01, 40, 20),), 5.0),
        (square(0, 0, 100), tuple(square(5 + 16 * k, 45, 10) for k in range(6)), 5.0),
        (square(0, 0, math.sqrt(0.1)), (), 20.0),
        (square(0, 0, math.sqrt(0.1)), (), 0.01),
        (square(0, 0, 10), (square(4, 4, 2),), 100.0),
        (square(500_000, 4_000_000, 100), (square(500_040, 4_000_040, 20),), 7.0),
    ],
    ids=[
        *("thin", "thin-diagonal", "L", "thin-L", "star", "thin-star", "star-with-hole", "hole-near-border"),
        *("row-of-holes", "0.1-m2", "0.1-m2-fine", "footprint-larger-than-area", "far-from-origin"),
    ],
)
def test_awkward_areas(area, holes, width):
    check(area, holes, width)
    check(area, holes, width, heading=math.radians(37))
    if holes:
        check(area, holes, width, cross_holes=True)


def test_an_area_of_10_square_kilometres_has_as_many_lanes_as_strips():
    path = check(square(0, 0, 3162.0), (), 20.0)
    assert len(path.lanes) == 159
    assert path.length_m == pytest.approx(159 * 3162 + 158 * 3162 / 159)


def test_a_rectangle_is_covered_along_its_longer_side():
    path = check(square(0, 0, 40, 10), (), 2.0)
    assert len(path.lanes) == 5
    assert path.heading % math.pi == pytest.approx(0, abs=1e-9)
    assert path.length_m == pytest.approx(5 * 40 + 4 * 2)


def test_a_rectangle_that_rounding_made_slanted_has_no_lanes_more():
    path = check(((0, 0), (563.41, 0.02), (563.35, 769.26), (0, 769.24)), (), 40.0)
    assert len(path.lanes) == 20


def test_a_given_heading_is_kept():
    path = coverage_path(square(0, 0, 40, 10), (), 2.0, math.pi / 2, cross_holes=False)
    ways = path.lanes[:, 1] - path.lanes[:, 0]
    assert np.abs(ways[:, 0]).max() < 1e-6
    assert len(path.lanes) == 20


def test_transit_goes_around_a_hole_or_across_it():
    area, holes = square(0, 0, 30), (square(5, 10, 20, 10),)
    around, across = (coverage_path(area, holes, 3.0, 0.0, cross_holes=cross) for cross in (False, True))
    begin, end = np.array([15.0, 10.0]), np.array([15.0, 20.0])
    assert around.link_m(begin, end) == pytest.approx(30)
    assert across.link_m(begin, end) == pytest.approx(10)
    assert [tuple(bend) for bend in around.bends(begin, end)] in ([(5, 10), (5, 20)], [(25, 10), (25, 20)])
    assert around.length_m >= across.length_m


def test_lanes_are_driven_there_and_back():
    path = coverage_path(square(0, 0, 40, 10), (), 2.0, 0.0, cross_holes=False)
    for before, after in pairwise(path.lanes):
        assert before[1, 0] == pytest.approx(after[0, 0])


def test_more_lanes_than_anybody_flies_are_refused():
    with pytest.raises(TooManyLanesError) as caught:
        coverage_path(square(0, 0, 1e5), (), 0.01, 0.0, cross_holes=False)
    assert caught.value.count > MOST_LANES
