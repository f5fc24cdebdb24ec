"""Where robots were: stretches of a run, packed.

A stretch is a zlib stream of a header in JSON, one line of it, and numbers: milliseconds of each step, then of each
step and robot x, y, z (mm), heading (mrad) and velocities (mm/s), each as int32 less that of the step before. A robot
that is not there has the least int32. Where milliseconds do not fit the header has those of the first step (`from_ms`),
and the others are counted from there.
"""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats

Row = Sequence[float]
"""x, y, z in metres, heading in radians, velocities in m/s."""

VALUES = 7
_NOWHERE = np.iinfo(np.int32).min
_LARGEST = 2.0**31 - 1


@dataclass(frozen=True, eq=False)
class Steps:
    """Where robots were in a stretch.

    Parameters
    ----------
    robots
        n ids.
    times_s
        (m,) seconds of the mission's clock, growing.
    states
        (m, n, 7): x, y, z, heading, vx, vy, vz in metres, radians, m/s; NaN of robots that were not there.
    """

    robots: tuple[str, ...]
    times_s: Floats
    states: Floats


def packed(steps: Steps) -> bytes:
    """A stretch as bytes."""
    times_ms = np.rint(steps.times_s * 1000).astype(np.int64)
    said = {"robots": list(steps.robots), "steps": len(steps.times_s)}
    if len(times_ms) and times_ms[-1] > np.iinfo(np.int32).max:  # of a mission that began 24 days ago, or more
        said["from_ms"] = int(times_ms[0])
        times_ms = times_ms - times_ms[0]
    head = json.dumps(said, ensure_ascii=False).encode()
    quantised = np.where(
        np.isfinite(steps.states), np.clip(np.rint(steps.states * 1000), -_LARGEST, _LARGEST), _NOWHERE
    )
    numbers = quantised.astype(np.int64).reshape(len(steps.times_s), -1)
    rows = np.column_stack([times_ms, numbers])
    less = np.diff(rows, axis=0, prepend=0).astype(np.int32)  # wraps around, and back when it is summed up
    return zlib.compress(head + b"\n" + less.T.tobytes(), level=6)


def unpacked(data: bytes) -> Steps:
    """The stretch in bytes that `packed` made.

    Raises
    ------
    ValueError
        if they are none.
    """
    try:
        head, _, body = zlib.decompress(data).partition(b"\n")
        said = json.loads(head)
        robots, count, from_ms = tuple(said["robots"]), int(said["steps"]), int(said.get("from_ms", 0))
        less = np.frombuffer(body, dtype=np.int32).reshape(1 + len(robots) * VALUES, count).T
    except (zlib.error, KeyError, TypeError, ValueError) as error:
        raise ValueError(f"no stretch of tracks: {error}") from None
    rows = np.cumsum(less, axis=0, dtype=np.int32)
    states = rows[:, 1:].reshape(count, len(robots), VALUES)
    there = states != _NOWHERE
    return Steps(robots, (rows[:, 0] + np.int64(from_ms)) / 1000, np.where(there, states / 1000, np.nan))


class Track:
    """Collects steps, and gives them back by stretches of mission time that begin at multiples of `length_s`."""

    def __init__(self, length_s: float) -> None:
        self._length_s = length_s
        self._number = 1
        self._steps: list[tuple[float, dict[str, Row]]] = []

    @property
    def until_s(self) -> float:
        """When the present stretch ends."""
        return self._number * self._length_s

    def add(self, now: float, rows: Mapping[str, Row]) -> Steps | None:
        """Take a step; returns the stretch that has ended before it, if one has and anything was in it."""
        ended = None
        if now > self.until_s + 1e-6:
            ended = self.take()
            self._number = max(1, math.ceil((now - 1e-6) / self._length_s))
        self._steps.append((now, dict(rows)))
        return ended

    def take(self) -> Steps | None:
        """What has been collected, which is given back; None if that is nothing."""
        steps, self._steps = self._steps, []
        if not steps:
            return None
        robots = tuple(dict.fromkeys(name for _, rows in steps for name in rows))
        states = np.full((len(steps), len(robots), VALUES), np.nan)
        for k, (_, rows) in enumerate(steps):
            for i, robot in enumerate(robots):
                if robot in rows:
                    states[k, i] = rows[robot]
        return Steps(robots, np.array([now for now, _ in steps]), states)
