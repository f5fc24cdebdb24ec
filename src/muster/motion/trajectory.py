"""A motion in time: a robot's place, heading, velocity and yaw rate at every moment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Floats


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Moments in order. Between two of them place and heading are the cubics that fit both moments and their rates.

    So velocities are continuous, except where two moments have the same time: there they jump.

    Parameters
    ----------
    times
        (n,) seconds, never falling, n >= 1.
    positions
        (n, d) metres in the map frame, d is 2 or 3.
    headings
        (n,) radians from east, anticlockwise, without jumps of whole turns.
    velocities
        (n, d) m/s in the map frame.
    yaw_rates
        (n,) rad/s.
    """

    times: Floats
    positions: Floats
    headings: Floats
    velocities: Floats
    yaw_rates: Floats

    @property
    def duration_s(self) -> float:
        return float(self.times[-1] - self.times[0])

    def at(self, times: npt.ArrayLike) -> Trajectory:
        """The moments (m,) at other times; before its start and after its end the robot is as it was there."""
        asked = np.atleast_1d(np.asarray(times, dtype=np.float64))
        when = np.clip(asked, self.times[0], self.times[-1])
        before = np.searchsorted(self.times, when, side="right") - 1
        after = np.minimum(before + 1, len(self.times) - 1)
        poses, rates = self._poses, self._rates
        pose, rate = _hermite(
            (when - self.times[before])[:, None],
            (self.times[after] - self.times[before])[:, None],
            (poses[before], rates[before], poses[after], rates[after]),
        )
        return Trajectory(asked, pose[:, :-1], pose[:, -1], rate[:, :-1], rate[:, -1])

    def sample(self, step_s: float) -> Trajectory:
        """Moments every `step_s` from the start, and the end."""
        count = int(np.ceil(self.duration_s / step_s - 1e-9))
        return self.at(np.append(self.times[0] + step_s * np.arange(count), self.times[-1]))

    def later(self, seconds: float) -> Trajectory:
        """The same motion, begun later."""
        return Trajectory(self.times + seconds, self.positions, self.headings, self.velocities, self.yaw_rates)

    def slower(self, factor: float) -> Trajectory:
        """The same motion in `factor` times the time."""
        rates = self.velocities / factor, self.yaw_rates / factor
        return Trajectory(self.times * factor, self.positions, self.headings, *rates)

    @property
    def _poses(self) -> Floats:
        return np.column_stack([self.positions, self.headings])

    @property
    def _rates(self) -> Floats:
        return np.column_stack([self.velocities, self.yaw_rates])


def joined(parts: Sequence[Trajectory]) -> Trajectory:
    """Motions one after the other, each taken to begin when the one before ends."""
    ends = np.cumsum([0.0] + [part.duration_s for part in parts])
    moved = [part.later(end - part.times[0]) for part, end in zip(parts, ends, strict=False)]
    return Trajectory(
        np.concatenate([part.times for part in moved]),
        np.concatenate([part.positions for part in moved]),
        np.concatenate([part.headings for part in moved]),
        np.concatenate([part.velocities for part in moved]),
        np.concatenate([part.yaw_rates for part in moved]),
    )


def _hermite(since: Floats, span: Floats, ends: tuple[Floats, Floats, Floats, Floats]) -> tuple[Floats, Floats]:
    """Values and rates `since` the first end of spans; at the first end where a span is empty."""
    first, first_rate, last, last_rate = ends
    empty = span == 0
    u = since / np.where(empty, 1.0, span)
    mean = (last - first) / np.where(empty, 1.0, span)
    middle = np.where(empty, first_rate, 3 * mean - first_rate - last_rate)
    end = np.where(empty, first_rate, last_rate)
    value = first + since * (first_rate + u * (middle - first_rate) + u * u * (first_rate - 2 * middle + end) / 3)
    rate = (1 - u) ** 2 * first_rate + 2 * u * (1 - u) * middle + u**2 * end
    return value, rate
