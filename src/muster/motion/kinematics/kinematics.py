"""The interface of robots' kinematics, and their common parts ([tcf-thesis], section 4.1).

A state is (n, 4): x, y, z in metres of the map frame and yaw in radians from east, one row a robot. What the inputs
are, each kind says. All functions work on many robots of one kind at once.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.motion.frames import wrapped
from muster.motion.limits import Limits


class Kinematics(Protocol):
    """One kind of robot."""

    @property
    def name(self) -> str:
        """As missions name it."""

    @property
    def faces_its_way(self) -> bool:
        """Whether it drives only where it looks."""

    @property
    def input_names(self) -> tuple[str, ...]:
        """The inputs in order, with their units."""

    def velocities(self, states: Floats, inputs: Floats) -> Floats:
        """The rates (n, 4) of the states under inputs (n, k): m/s in the map frame, and rad/s."""

    def step(self, states: Floats, inputs: Floats, dt: float) -> Floats:
        """The states after `dt` seconds under constant inputs, exactly. Yaw goes on beyond pi."""

    def limited(self, inputs: Floats, limits: Limits, before: Floats | None = None, dt: float = 0.0) -> Floats:
        """The inputs cut to the limits; with those `before`, also to what can be reached from them in `dt` seconds."""

    def inputs(self, states: Floats, wanted: Floats, headings: Floats | None, limits: Limits) -> Floats:
        """The control law: from wanted velocities (n, 3), m/s in the map frame, to inputs that are within the limits.

        `headings` (n,) are those wanted by robots that need not face their way; None to keep what they have.
        """


def approach(offsets: Floats, speed: float, interval_s: float) -> Floats:
    """Velocities along offsets (n, d) to a goal: at full speed, and within speed * interval of it at offset / interval.

    With d = 1 this is (4.12), the climb of the quadcopter, where `offsets` is z_d - z_c ((4.9) prints z_d - z_d).
    """
    far = np.linalg.norm(offsets, axis=-1, keepdims=True)
    return np.asarray(offsets / np.maximum(far / speed, interval_s))


def shortened(vectors: Floats, most: float) -> Floats:
    """Vectors (n, d) of no greater length, in their own directions."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors * np.minimum(1.0, most / np.where(length > 0, length, 1.0)))


def reached(wanted: Floats, before: Floats | None, most: float, dt: float) -> Floats:
    """What can be had of wanted values (n, d) from those before if they change by at most `most` a second."""
    if before is None or math.isinf(most):
        return wanted
    return np.asarray(before + shortened(wanted - before, most * dt))


def turn_towards(yaws: Floats, headings: Floats | None, most: float) -> Floats:
    """Yaw rates (n,) by (4.10) and (4.13): most * sin(heading - yaw).

    Beyond a right angle at the full rate: as printed a robot that looks the wrong way would hardly turn.
    """
    if not math.isfinite(most):
        raise ParameterError(f"yaw_rate_radps: {most}; expected a finite number to steer by")
    if headings is None:
        return np.zeros_like(yaws)
    off = wrapped(headings - yaws)
    return np.asarray(most * np.where(np.abs(off) < math.pi / 2, np.sin(off), np.sign(off)))


def moved_along_arc(states: Floats, ahead: Floats, left: Floats, yaw_rates: Floats, dt: float) -> Floats:
    """States after `dt` at constant speeds ahead and left and a constant yaw rate: the integral of (4.8), an arc.

    The mean of a velocity that turns by an angle is the velocity at half the angle, times sin(half) / half.
    """
    half = yaw_rates * dt / 2
    chord = dt * np.sinc(half / math.pi)
    c, s = np.cos(states[:, 3] + half), np.sin(states[:, 3] + half)
    after = states.copy()
    after[:, 0] += chord * (ahead * c - left * s)
    after[:, 1] += chord * (ahead * s + left * c)
    after[:, 3] += yaw_rates * dt
    return after
