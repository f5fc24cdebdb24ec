"""Frames: transforms between reference frames ([tcf-thesis] (4.1)-(4.4) and (5.1)-(5.6); axes by REP-103).

A transform is a (4, 4) matrix, or a stack (..., 4, 4); the transform *from a to b* is b's pose in a, and takes points
of b to points of a. In the plane it is (3, 3). Transforms are chained by `@`. A quaternion is (x, y, z, w) of length 1,
as in ROS. Angles are radians, anticlockwise; the map frame is ENU, a body's frame FLU (forward, left, up).
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

ENU_NED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
"""East, north, up to north, east, down. Its own inverse."""

FLU_FRD = np.diag([1.0, -1.0, -1.0])
"""Forward, left, up to forward, right, down. Its own inverse."""

FLU_ENU = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""Forward, left, up to the ENU frame of an autopilot that calls forward at power-up north; (5.3): a quarter turn."""


def wrapped(angle: npt.ArrayLike) -> Floats:
    """The same direction as an angle in [-pi, pi)."""
    return (np.asarray(angle, dtype=np.float64) + math.pi) % (2 * math.pi) - math.pi


def rotation(roll: npt.ArrayLike, pitch: npt.ArrayLike, yaw: npt.ArrayLike) -> Floats:
    """R of (4.1): (..., 3, 3), about x, then y, then z, the axes standing still."""
    roll, pitch, yaw = np.broadcast_arrays(*(np.asarray(a, dtype=np.float64) for a in (roll, pitch, yaw)))
    cr, sr, cp, sp, cy, sy = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    rows = [
        [cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy],
        [cp * sy, sr * sp * sy + cr * cy, cr * sp * sy - sr * cy],
        [-sp, sr * cp, cr * cp],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def angles(matrix: Floats) -> Floats:
    """The inverse of `rotation`: (..., 3) of roll, pitch in [-pi/2, pi/2], yaw.

    Where pitch is a right angle roll and yaw turn about one axis: roll is 0 there.
    """
    pitch = np.arctan2(-matrix[..., 2, 0], np.hypot(matrix[..., 0, 0], matrix[..., 1, 0]))
    locked = np.hypot(matrix[..., 0, 0], matrix[..., 1, 0]) < 1e-9
    roll = np.where(locked, 0.0, np.arctan2(matrix[..., 2, 1], matrix[..., 2, 2]))
    yaw_locked = np.arctan2(-matrix[..., 0, 1], matrix[..., 1, 1])
    yaw = np.where(locked, yaw_locked, np.arctan2(matrix[..., 1, 0], matrix[..., 0, 0]))
    return np.stack([roll, pitch, yaw], axis=-1)


def transform(position: npt.ArrayLike, matrix: npt.ArrayLike) -> Floats:
    """The transform (..., n + 1, n + 1) of a position (..., n) and a rotation (..., n, n); n is 2 or 3."""
    at, turn = np.asarray(position, dtype=np.float64), np.asarray(matrix, dtype=np.float64)
    size = at.shape[-1]
    made = np.zeros((*np.broadcast_shapes(at.shape[:-1], turn.shape[:-2]), size + 1, size + 1))
    made[..., :size, :size], made[..., :size, size], made[..., size, size] = turn, at, 1.0
    return made


def pose_transform(pose: npt.ArrayLike) -> Floats:
    """HT(S) of (4.1): (..., 6) of x, y, z in metres and roll, pitch, yaw to (..., 4, 4)."""
    values = np.asarray(pose, dtype=np.float64)
    return transform(values[..., :3], rotation(values[..., 3], values[..., 4], values[..., 5]))


def planar_transform(x: npt.ArrayLike, y: npt.ArrayLike, heading: npt.ArrayLike) -> Floats:
    """The pose (x, y, heading) of a plane as (..., 3, 3)."""
    x, y, turn = np.broadcast_arrays(*(np.asarray(a, dtype=np.float64) for a in (x, y, heading)))
    return transform(np.stack([x, y], axis=-1), rotation(0.0, 0.0, turn)[..., :2, :2])


def pose_of(matrix: Floats) -> Floats:
    """The inverse of `pose_transform`: (..., 6), the angles as `angles` has them."""
    return np.concatenate([matrix[..., :3, 3], angles(matrix[..., :3, :3])], axis=-1)


def inverse(matrix: Floats) -> Floats:
    """The inverse transform, in the plane and in space."""
    size = matrix.shape[-1] - 1
    back = np.swapaxes(matrix[..., :size, :size], -1, -2)
    return transform(-(back @ matrix[..., :size, size, None])[..., 0], back)


def moved(matrix: Floats, points: npt.ArrayLike) -> Floats:
    """Points (n, d) of the child frame as points of the parent frame."""
    size = matrix.shape[-1] - 1
    return np.asarray(np.asarray(points, dtype=np.float64) @ matrix[:size, :size].T + matrix[:size, size])


def body_in_global(start: npt.ArrayLike, estimate: npt.ArrayLike) -> Floats:
    """(4.2)-(4.4): from the global frame to the body.

    Parameters
    ----------
    start
        (6,) the robot's pose in the global frame when it was powered up: its initialisation frame.
    estimate
        (..., 6) its own estimate of its pose since, in its initialisation frame.
    """
    return pose_transform(start) @ pose_transform(estimate)


def goal_for_autopilot(start: npt.ArrayLike, goal: npt.ArrayLike) -> Floats:
    """(5.1)-(5.6): a goal of the global frame as an autopilot takes it: (4,) of x, y, z and yaw.

    The autopilot's local frame is ENU, begins where it was powered up (`start`, (6,)) and calls forward north. `goal`
    is (4,) in the global frame. (5.6) prints yaw - yaw_0 - pi/2; the quarter turn of (5.3), which takes forward to
    north, adds pi/2 to every direction, so that is what stands here. `start` is taken as level, as (5.6) does.
    """
    beginning, aim = np.asarray(start, dtype=np.float64), np.asarray(goal, dtype=np.float64)
    local = FLU_ENU @ moved(inverse(pose_transform(beginning)), aim[None, :3])[0]
    return np.append(local, wrapped(aim[3] - beginning[5] + math.pi / 2))


def enu_to_ned(vectors: npt.ArrayLike) -> Floats:
    """(..., 3) of east, north, up as north, east, down; and back, being its own inverse."""
    return np.asarray(np.asarray(vectors, dtype=np.float64) @ ENU_NED.T)


def flu_to_enu(vectors: npt.ArrayLike, yaw: float) -> Floats:
    """Vectors (..., 3) of a level body that heads to `yaw` (from east) in ENU."""
    return np.asarray(vectors, dtype=np.float64) @ rotation(0.0, 0.0, yaw).T


def enu_to_flu(vectors: npt.ArrayLike, yaw: float) -> Floats:
    """The inverse of `flu_to_enu`."""
    return np.asarray(vectors, dtype=np.float64) @ rotation(0.0, 0.0, yaw)


def yaw_enu_to_ned(yaw: npt.ArrayLike) -> Floats:
    """A heading from east anticlockwise as one from north clockwise; and back. In [-pi, pi)."""
    return wrapped(math.pi / 2 - np.asarray(yaw, dtype=np.float64))


def rotation_enu_to_ned(matrix: Floats) -> Floats:
    """A FLU body's orientation in ENU as a FRD body's orientation in NED; and back. (..., 3, 3)."""
    return ENU_NED @ matrix @ FLU_FRD


def quaternion_rotation(quaternion: npt.ArrayLike) -> Floats:
    """Quaternions (..., 4), of any length but 0, as rotations (..., 3, 3)."""
    q = np.asarray(quaternion, dtype=np.float64)
    x, y, z, w = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def quaternion_of(matrix: Floats) -> Floats:
    """Rotations (..., 3, 3) as quaternions (..., 4) with w >= 0.

    Of the four ways to take a quaternion out of a matrix the one that divides by the largest component.
    """
    m = np.asarray(matrix, dtype=np.float64)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    yz, zx, xy = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    sum_xy, sum_xz, sum_yz = m[..., 0, 1] + m[..., 1, 0], m[..., 0, 2] + m[..., 2, 0], m[..., 1, 2] + m[..., 2, 1]
    ways = np.stack(
        [
            np.stack([1 + xx - yy - zz, sum_xy, sum_xz, yz], axis=-1),
            np.stack([sum_xy, 1 - xx + yy - zz, sum_yz, zx], axis=-1),
            np.stack([sum_xz, sum_yz, 1 - xx - yy + zz, xy], axis=-1),
            np.stack([yz, zx, xy, 1 + xx + yy + zz], axis=-1),
        ],
        axis=-2,
    )
    best = np.argmax(np.stack([ways[..., k, k] for k in range(4)], axis=-1), axis=-1)
    chosen = np.take_along_axis(ways, best[..., None, None], axis=-2)[..., 0, :]
    unit: Floats = chosen / np.linalg.norm(chosen, axis=-1, keepdims=True)
    return np.where(unit[..., 3:] < 0, -unit, unit)


def slerp(first: npt.ArrayLike, second: npt.ArrayLike, share: npt.ArrayLike) -> Floats:
    """The orientation at `share` (0 to 1) of the shortest turn from one to another, at an even rate. (..., 4)."""
    a, b = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
    part = np.asarray(share, dtype=np.float64)[..., None]
    b = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0, -b, b)
    angle = 2 * np.arctan2(np.linalg.norm(a - b, axis=-1, keepdims=True), np.linalg.norm(a + b, axis=-1, keepdims=True))
    small = angle < 1e-9
    safe = np.where(small, 1.0, np.sin(angle))
    of_a = np.where(small, 1 - part, np.sin((1 - part) * angle) / safe)
    of_b = np.where(small, part, np.sin(part * angle) / safe)
    mixed = of_a * a + of_b * b
    return np.asarray(mixed / np.linalg.norm(mixed, axis=-1, keepdims=True))
