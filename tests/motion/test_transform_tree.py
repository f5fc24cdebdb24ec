"""The tree of frames: lookups compose, invert and interpolate; what cannot be answered says why."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import (
    DisconnectedFramesError,
    ExtrapolationError,
    FrameTreeError,
    ParameterError,
    TransformError,
    UnknownFrameError,
)
from muster.motion import frames
from muster.motion.transform_tree import TransformTree

angle = st.floats(-math.pi, math.pi)
metres = st.floats(-100, 100)
transforms = st.tuples(metres, metres, metres, angle, st.floats(-1.5, 1.5), angle).map(frames.pose_transform)


def at(x, y=0.0, yaw=0.0):
    return frames.pose_transform([x, y, 0, 0, 0, yaw])


def same(a, b):
    np.testing.assert_allclose(a, b, atol=1e-8, rtol=0)


@given(chain=st.lists(transforms, min_size=3, max_size=3), branch=transforms)
def test_lookups_compose_along_the_tree_and_invert(chain, branch):
    tree = TransformTree()
    for parent, child, matrix in zip("abc", "bcd", chain, strict=True):
        tree.set_transform(parent, child, 1.0, matrix, static=child == "c")
    tree.set_transform("b", "x", 1.0, branch)
    same(tree.lookup("a", "d", 1.0), chain[0] @ chain[1] @ chain[2])
    same(tree.lookup("x", "d", 1.0), frames.inverse(branch) @ chain[1] @ chain[2])
    same(tree.lookup("d", "x", 1.0), frames.inverse(tree.lookup("x", "d", 1.0)))
    same(tree.lookup("x", "x", 1.0), np.eye(4))


@given(first=transforms, second=transforms, share=st.floats(0, 1))
def test_between_stamps_the_place_is_linear_and_the_turn_is_even(first, second, share):
    tree = TransformTree()
    tree.set_transform("map", "r", 4.0, second)
    tree.set_transform("map", "r", 2.0, first)  # later said, earlier in time
    found = tree.lookup("map", "r", 2.0 + 2 * share)
    same(found[:3, 3], (1 - share) * first[:3, 3] + share * second[:3, 3])
    whole = frames.slerp(frames.quaternion_of(first[:3, :3]), frames.quaternion_of(second[:3, :3]), share)
    same(found[:3, :3], frames.quaternion_rotation(whole))
    same(tree.lookup("map", "r", 2.0), first)
    same(tree.lookup("map", "r", 4.0), second)


def test_turning_the_short_way_over_the_back():
    tree = TransformTree()
    tree.set_transform("map", "r", 0.0, at(0, yaw=math.radians(170)))
    tree.set_transform("map", "r", 1.0, at(0, yaw=math.radians(-170)))
    same(tree.lookup("map", "r", 0.5), at(0, yaw=math.pi))


def test_the_latest_common_time():
    tree = TransformTree()
    for stamp in (0.0, 1.0, 2.0):
        tree.set_transform("map", "r", stamp, at(stamp))
    tree.set_transform("map", "s", 0.0, at(0, 5))
    tree.set_transform("map", "s", 1.5, at(0, 6.5))
    tree.set_transform("r", "camera", 0.0, at(0.5), static=True)
    same(tree.lookup("map", "camera"), at(2.5))
    same(tree.lookup("s", "camera"), at(2.0, -6.5))


def test_the_buffer_forgets():
    tree = TransformTree(buffer_s=2.0)
    for stamp in range(6):
        tree.set_transform("map", "r", stamp, at(stamp))
    same(tree.lookup("map", "r", 3.0), at(3))
    with pytest.raises(ExtrapolationError, match=r"r in map at 2\.9.* before the first .* expected 3\.0+ to 5\.0+ s"):
        tree.lookup("map", "r", 2.9)
    tree.set_transform("map", "r", 1.0, at(99))  # older than the buffer
    with pytest.raises(ExtrapolationError):
        tree.lookup("map", "r", 1.0)


def test_the_same_stamp_again_replaces():
    tree = TransformTree()
    tree.set_transform("map", "r", 1.0, at(1))
    tree.set_transform("map", "r", 1.0, at(2))
    same(tree.lookup("map", "r", 1.0), at(2))


def test_no_extrapolation_into_the_future():
    tree = TransformTree()
    tree.set_transform("map", "r", 1.0, at(1))
    with pytest.raises(ExtrapolationError, match=r"after the last .* expected 1\.0+ to 1\.0+ s"):
        tree.lookup("map", "r", 1.5)


def test_a_static_transform_holds_at_all_times():
    tree = TransformTree()
    tree.set_transform("r", "camera", 7.0, at(1), static=True)
    same(tree.lookup("r", "camera", -1e9), at(1))


def test_what_is_not_known_says_so():
    tree = TransformTree()
    tree.set_transform("map", "r", 0.0, at(1))
    tree.set_transform("other", "s", 0.0, at(1))
    with pytest.raises(UnknownFrameError, match="frame q: unknown; expected one of map, other, r, s"):
        tree.lookup("map", "q", 0.0)
    with pytest.raises(DisconnectedFramesError, match="s seen from r: two trees, with the roots other and map"):
        tree.lookup("r", "s", 0.0)


def test_what_would_be_no_tree_is_refused_and_changes_nothing():
    tree = TransformTree()
    tree.set_transform("map", "odom", 0.0, at(1))
    tree.set_transform("odom", "r", 0.0, at(1))
    with pytest.raises(FrameTreeError, match="map: in r, which is in map already"):
        tree.set_transform("r", "map", 0.0, at(1))
    with pytest.raises(FrameTreeError, match="cycle"):
        tree.set_transform("new", "new", 0.0, at(1))
    with pytest.raises(FrameTreeError, match="r: a second parent, map; expected odom"):
        tree.set_transform("map", "r", 0.0, at(1))
    with pytest.raises(FrameTreeError, match="r: a static transform; expected a moving one"):
        tree.set_transform("odom", "r", 0.0, at(1), static=True)
    for wrong in (np.eye(3), 2 * np.eye(4), np.full((4, 4), np.nan), np.diag([1.0, 1.0, -1.0, 1.0])):
        with pytest.raises(ParameterError, match="expected"):
            tree.set_transform("map", "new", 0.0, wrong)
    with pytest.raises(ParameterError, match="stamp"):
        tree.set_transform("map", "new", math.nan, at(1))
    assert tree.frames == ("map", "odom", "r")
    same(tree.lookup("map", "r", 0.0), at(2))
    assert issubclass(FrameTreeError, TransformError)


def test_a_buffer_of_no_length_is_refused():
    with pytest.raises(ParameterError, match="buffer_s"):
        TransformTree(buffer_s=0)
