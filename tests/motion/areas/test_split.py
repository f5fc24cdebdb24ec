"""Areas split among robots: all lanes, in order, in parts of equal length."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from tests.motion.areas.test_coverage_path import L_SHAPE, SEEN, square

from muster.motion.areas.coverage_path import coverage_path
from muster.motion.areas.lanes import swaths
from muster.motion.areas.split import parts_of, way_m
from muster_studies.instances.random_areas import random_area, surface


def length(path, part):
    links = sum(path.link_m(a[1], b[0]) for a, b in pairwise(part))
    own = float(np.linalg.norm(part[:, 1] - part[:, 0], axis=1).sum()) + links
    assert way_m(path, part) == pytest.approx(own)
    return own


@pytest.mark.parametrize("count", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("seed", range(4))
def test_parts_see_what_the_whole_sees(seed, count):
    area, holes, width = random_area(seed)
    path = coverage_path(area, holes, width, None, cross_holes=False)
    parts = parts_of(path, count)
    assert len(parts) == count
    left = surface(area, holes).difference(shapely.union_all(swaths(np.concatenate(parts), width)))
    assert left.area <= SEEN * surface(area, holes).area
    assert sum(length(path, part) for part in parts) <= path.length_m * (1 + 1e-9)


@pytest.mark.parametrize("count", [2, 3, 5])
@pytest.mark.parametrize(("area", "width"), [(square(0, 0, 100), 5.0), (L_SHAPE, 4.0), (square(0, 0, 100, 3), 5.0)])
def test_parts_are_of_equal_length(area, width, count):
    path = coverage_path(area, (), width, None, cross_holes=False)
    lengths = [length(path, part) for part in parts_of(path, count)]
    assert max(lengths) <= 1.06 * sum(lengths) / count


def test_parts_end_at_lanes_where_that_costs_little():
    path = coverage_path(square(0, 0, 100), (), 1.0, 0.0, cross_holes=False)
    parts = parts_of(path, 4)
    assert [len(part) for part in parts] == [25] * 4
    assert np.array_equal(np.concatenate(parts), path.lanes)


def test_one_lane_is_cut():
    path = coverage_path(square(0, 0, 90, 3), (), 5.0, None, cross_holes=False)
    parts = parts_of(path, 3)
    assert [length(path, part) for part in parts] == pytest.approx([30, 30, 30])
    assert parts[0][-1, 1] == pytest.approx(parts[1][0, 0])
