"""Tags that are seen without a picture: as the detector sees them in a drawn one."""

import math

import numpy as np
import pytest

from muster.perception.camera import Intrinsics, View, mount_of
from muster.perception.geometric_detection import GroundTag, sightings_of
from muster.perception.localisation import on_ground
from muster.perception.tags import tag_pose

VGA = Intrinsics.of_view(640, 480, math.radians(60))
DOWN = mount_of([0, 0, 0, 0, math.pi / 4, 0])


def above(x, y, z, yaw=0.0):
    return View.from_body(VGA, [x, y, z, 0, 0, yaw], DOWN)


def tag(x, y, heading=0.0, *, number=7, size_m=0.4):
    return GroundTag(number, tag_pose((x, y), heading), size_m)


def seen(tags, view, corner_px=0.0):
    return sightings_of(tags, view, np.random.default_rng(1), corner_px)


def test_a_tag_ahead_is_seen_where_it_is():
    view = above(0, 0, 3)
    (sighting,) = seen([tag(3, 0.5)], view).all
    assert on_ground(view, sighting.centre[None])[0, :2] == pytest.approx((3, 0.5))
    assert sighting.tag == 7


@pytest.mark.parametrize(
    ("other", "view"),
    [
        (tag(-3, 0), above(0, 0, 3)),  # behind
        (tag(3, 9), above(0, 0, 3)),  # beside the picture
        (tag(7.5, 0), above(0, 0, 3, math.pi)),  # looks away
        (tag(60, 0), above(0, 0, 60)),  # too small
        (tag(3, 0, size_m=0.05), above(0, 0, 3)),  # too small from near
        (tag(0.85, 0, size_m=1.0), above(0, 0, 3)),  # not whole in the picture
    ],
)
def test_others_are_not_seen(other, view):
    assert seen([other], view).all == ()


def test_from_below_nothing_is_to_be_seen():
    upward = View.from_body(VGA, [0, 0, -3, 0, 0, 0], mount_of([0, 0, 0, 0, -math.pi / 4, 0]))
    assert upward.sees([[3, 0, 0]]).all()
    assert seen([tag(3, 0)], upward).all == ()


def test_the_upper_edge_lies_where_the_heading_says():
    view = above(0, 0, 3)
    (sighting,) = seen([tag(3, 0, heading=0.0)], view).all  # upper edge to the east, away from the camera
    assert sighting.corners[:2, 1].max() < sighting.corners[2:, 1].min()
    assert sighting.corners[0, 0] < sighting.corners[1, 0]


def test_one_id_twice_is_told():
    sightings = seen([tag(3, -0.5), tag(3, 0.5), tag(2.4, 0, number=3)], above(0, 0, 3))
    assert [sighting.tag for sighting in sightings.all] == [3, 7, 7]
    assert sightings.repeated == (7,)


def test_corners_are_off_as_asked():
    view, exact = above(0, 0, 3), seen([tag(3, 0)], above(0, 0, 3)).all[0].corners
    random = np.random.default_rng(3)
    off = [sightings_of([tag(3, 0)], view, random, 0.5).all[0].corners - exact for _ in range(300)]
    assert np.std(off) == pytest.approx(0.5, rel=0.1)
    assert abs(np.mean(off)) < 0.05
