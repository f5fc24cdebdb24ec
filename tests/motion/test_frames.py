"""Frames: transforms invert and compose, conventions of axes are there and back."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.motion import frames

angle = st.floats(-math.pi, math.pi)
metres = st.floats(-1e3, 1e3)
poses = st.tuples(metres, metres, metres, angle, st.floats(-1.5, 1.5), angle)
vectors = st.tuples(metres, metres, metres)
quaternions = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 1e-3)


def same(a, b, tolerance=1e-8):
    np.testing.assert_allclose(a, b, atol=tolerance, rtol=0)


def turned(quaternion):
    return frames.quaternion_rotation(quaternion)


def test_the_transform_of_4_1_entry_by_entry():
    roll, pitch, yaw = 0.3, -0.7, 2.1
    c, s = math.cos, math.sin
    expected = [
        [c(pitch) * c(yaw), s(roll) * s(pitch) * c(yaw) - c(roll) * s(yaw), 0, 1],
        [c(pitch) * s(yaw), s(roll) * s(pitch) * s(yaw) + c(roll) * c(yaw), 0, 2],
        [-s(pitch), s(roll) * c(pitch), c(roll) * c(pitch), 3],
        [0, 0, 0, 1],
    ]
    made = frames.pose_transform([1, 2, 3, roll, pitch, yaw])
    same(made[:, [0, 1, 3]], np.array(expected)[:, [0, 1, 3]])
    same(made[:3, 2], np.cross(made[:3, 0], made[:3, 1]))


@given(pose=poses)
def test_a_pose_survives_its_transform(pose):
    same(frames.pose_transform(frames.pose_of(frames.pose_transform(pose))), frames.pose_transform(pose))
    same(np.cos(frames.pose_of(frames.pose_transform(pose)) - pose)[3:], [1, 1, 1])


@given(yaw=angle, up=st.sampled_from([-1, 1]))
def test_a_pose_that_looks_straight_up_survives_too(yaw, up):
    matrix = frames.rotation(0.4, up * math.pi / 2, yaw)
    same(frames.rotation(*frames.angles(matrix)), matrix, 1e-7)


@given(first=poses, second=poses, points=st.lists(vectors, min_size=1, max_size=4))
def test_transforms_invert_and_compose(first, second, points):
    a, b = frames.pose_transform(first), frames.pose_transform(second)
    same(frames.inverse(a) @ a, np.eye(4))
    same(frames.inverse(a @ b), frames.inverse(b) @ frames.inverse(a))
    same(frames.moved(a @ b, points), frames.moved(a, frames.moved(b, points)))
    stacked = frames.inverse(np.stack([a, b]))
    same(stacked[1], frames.inverse(b))


@given(x=metres, y=metres, heading=angle, point=st.tuples(metres, metres))
def test_the_plane_is_the_floor_of_space(x, y, heading, point):
    flat, high = frames.planar_transform(x, y, heading), frames.pose_transform([x, y, 0, 0, 0, heading])
    same(frames.moved(flat, [point])[0], frames.moved(high, [(*point, 0)])[0, :2])
    same(frames.inverse(flat) @ flat, np.eye(3))


@given(quaternion=quaternions)
def test_quaternions_and_rotations_are_one(quaternion):
    matrix = turned(quaternion)
    same(matrix @ matrix.T, np.eye(3))
    assert np.linalg.det(matrix) == pytest.approx(1)
    back = frames.quaternion_of(matrix)
    assert back[3] >= 0
    same(turned(back), matrix)


@given(yaw=angle)
def test_a_quaternion_about_z_is_half_the_yaw(yaw):
    same(turned([0, 0, math.sin(yaw / 2), math.cos(yaw / 2)]), frames.rotation(0, 0, yaw))


@given(vector=vectors, quaternion=quaternions, yaw=angle)
def test_conversions_of_axes_are_their_own_inverses(vector, quaternion, yaw):
    same(frames.enu_to_ned(frames.enu_to_ned(vector)), vector)
    same(frames.enu_to_flu(frames.flu_to_enu(vector, yaw), yaw), vector)
    same(frames.rotation_enu_to_ned(frames.rotation_enu_to_ned(turned(quaternion))), turned(quaternion))
    same(np.cos(frames.yaw_enu_to_ned(frames.yaw_enu_to_ned(yaw)) - yaw), 1)


@given(vector=vectors, quaternion=quaternions)
def test_a_body_points_to_the_same_place_in_both_conventions(vector, quaternion):
    through_enu = frames.enu_to_ned(turned(quaternion) @ vector)
    through_ned = frames.rotation_enu_to_ned(turned(quaternion)) @ frames.FLU_FRD @ vector
    same(through_enu, through_ned)


@given(yaw=angle)
def test_yaw_and_rotation_agree_in_ned(yaw):
    matrix = frames.rotation_enu_to_ned(frames.rotation(0, 0, yaw))
    same(matrix, frames.rotation(0, 0, float(frames.yaw_enu_to_ned(yaw))))


def test_known_directions():
    same(frames.enu_to_ned([1, 2, 3]), [2, 1, -3])
    same(frames.FLU_FRD @ [1, 2, 3], [1, -2, -3])
    same(frames.flu_to_enu([1, 0, 0], math.pi / 2), [0, 1, 0])
    same(frames.yaw_enu_to_ned(0.0), math.pi / 2)  # east


def test_body_in_global_of_4_4():
    start = [3, 2, 0, 0, 0, math.pi / 2]
    same(frames.body_in_global(start, [1, 0, 4, 0, 0, 0.5]), frames.pose_transform([3, 3, 4, 0, 0, math.pi / 2 + 0.5]))


@given(start=st.tuples(metres, metres, metres, angle), ahead=metres, left=metres, up=metres, turn=angle)
def test_an_autopilots_goal_is_where_and_whither_it_should_be(start, ahead, left, up, turn):
    """Forward at power-up is north, left is west, and the heading keeps its angle to the way there: (5.5), (5.6)."""
    x, y, z, yaw = start
    c, s = math.cos(yaw), math.sin(yaw)
    goal = [x + c * ahead - s * left, y + s * ahead + c * left, z + up, yaw + turn]
    found = frames.goal_for_autopilot([x, y, z, 0, 0, yaw], goal)
    same(found[:3], [-left, ahead, up])
    same(math.cos(found[3] - (math.pi / 2 + turn)), 1)


@given(a=quaternions, b=quaternions, share=st.floats(0, 1))
def test_slerp_turns_evenly_the_short_way(a, b, share):
    a, b = (np.array(q) / np.linalg.norm(q) for q in (a, b))
    between = frames.slerp(a, b, share)

    def angle_between(p, q):
        cosine = (np.trace(turned(p).T @ turned(q)) - 1) / 2
        return math.acos(min(1, max(-1, cosine)))

    whole = angle_between(a, b)
    assert angle_between(a, between) == pytest.approx(share * whole, abs=1e-6)
    assert angle_between(between, b) == pytest.approx((1 - share) * whole, abs=1e-6)
