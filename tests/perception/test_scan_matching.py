"""Scans are matched to the pose between them."""

import math

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.perception.laser import Scanner, points_of
from muster.perception.scan_matching import Matching, matched

pytest.importorskip("scipy")
ROOM = np.array([[0, 0, 6, 0], [6, 0, 6, 4], [6, 4, 2, 4], [2, 4, 2, 3], [2, 3, 0, 3], [0, 3, 0, 0.0]])
SCANNER = Scanner(reach_m=8.0, step_rad=math.radians(1), range_m=0.01)


def scan(pose, random, walls=ROOM):
    return points_of(SCANNER.measured(SCANNER.ranges(pose, walls), random), SCANNER.bearings)


@pytest.mark.parametrize("seed", range(10))
def test_a_pose_in_a_room_is_found(seed):
    random = np.random.default_rng(seed)
    x, y, heading = random.uniform([1, 1, -3], [5, 2, 3])
    moved = random.uniform([-0.25, -0.25, -0.2], [0.25, 0.25, 0.2])
    c, s = math.cos(heading), math.sin(heading)
    after = (x + c * moved[0] - s * moved[1], y + s * moved[0] + c * moved[1], heading + moved[2])
    match = matched(scan((x, y, heading), random), scan(after, random))
    np.testing.assert_allclose(match.pose, moved, atol=0.02)
    assert match.rms_m < 0.02
    assert match.share > 0.8


def test_a_corridor_without_ends_fixes_no_pose():
    random, corridor = np.random.default_rng(0), np.array([[-50, 0, 50, 0], [-50, 2, 50, 2.0]])
    before, after = (scan((x, 1.0, 0.0), random, corridor) for x in (0.0, 0.2))
    assert matched(before, after) is None


def test_too_few_points_give_no_match():
    assert matched(np.zeros((3, 2)), np.ones((40, 2))) is None
    assert matched(np.random.default_rng(0).random((40, 2)), np.full((40, 2), 99.0)) is None


def test_points_of_another_shape():
    with pytest.raises(ParameterError, match="after"):
        matched(np.zeros((20, 2)), np.zeros((20, 3)))


@pytest.mark.parametrize("values", [{"rounds": 0}, {"kept_share": 1.5}, {"farthest_m": -1.0}])
def test_parameters_out_of_range(values):
    with pytest.raises(ParameterError, match="expected"):
        Matching(**values)
