"""A tree of frames whose transforms change in time, as tf2's: the frame of each robot beside the map's.

Each frame but the root has one parent. A transform is kept with its stamp for as long as the buffer is; between two
stamps the place is interpolated linearly and the orientation by slerp. A static transform holds at all times. Nothing
here reads a clock: a stamp is what the caller says, in seconds.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field

import numpy as np

from muster.mission.errors import (
    DisconnectedFramesError,
    ExtrapolationError,
    FrameTreeError,
    ParameterError,
    UnknownFrameError,
)
from muster.motion.frames import Floats, inverse, quaternion_of, quaternion_rotation, slerp, transform


@dataclass
class _Edge:
    """A frame's transform from its parent over time; `stamps` is sorted, and empty where it is static."""

    parent: str
    static: bool
    stamps: list[float] = field(default_factory=list)
    transforms: list[Floats] = field(default_factory=list)

    def keep(self, stamp: float, matrix: Floats, buffer_s: float) -> None:
        if self.static:
            self.transforms = [matrix]
            return
        at = bisect_left(self.stamps, stamp)
        if at < len(self.stamps) and self.stamps[at] == stamp:
            self.transforms[at] = matrix
        else:
            self.stamps.insert(at, stamp)
            self.transforms.insert(at, matrix)
        stale = bisect_left(self.stamps, self.stamps[-1] - buffer_s)
        del self.stamps[:stale], self.transforms[:stale]

    def at(self, stamp: float, frame: str) -> Floats:
        if self.static:
            return self.transforms[0]
        first, last = self.stamps[0], self.stamps[-1]
        if not first <= stamp <= last:
            side = "before the first" if stamp < first else "after the last"
            raise ExtrapolationError(
                f"{frame} in {self.parent} at {stamp:.6f} s: {side} transform; expected {first:.6f} to {last:.6f} s"
            )
        k = bisect_right(self.stamps, stamp) - 1
        if self.stamps[k] == stamp:
            return self.transforms[k]
        share = (stamp - self.stamps[k]) / (self.stamps[k + 1] - self.stamps[k])
        return _between(self.transforms[k], self.transforms[k + 1], share)


class TransformTree:
    """Frames by name, each with its transform from its parent over time.

    Parameters
    ----------
    buffer_s
        how long a transform is kept, back from the newest of its frame.
    """

    def __init__(self, buffer_s: float = 10.0) -> None:
        if not buffer_s > 0:
            raise ParameterError(f"buffer_s: {buffer_s}; expected seconds above 0")
        self._buffer_s = buffer_s
        self._edges: dict[str, _Edge] = {}  # by the child's name
        self._frames: set[str] = set()

    @property
    def frames(self) -> tuple[str, ...]:
        """All names, in code-point order."""
        return tuple(sorted(self._frames))

    def set_transform(self, parent: str, child: str, stamp: float, matrix: Floats, *, static: bool = False) -> None:
        """Say where `child` is in `parent` at a time.

        Parameters
        ----------
        stamp
            seconds; of no meaning for a static transform. One that is older than the buffer is dropped.
        matrix
            (4, 4), the child's pose in the parent.

        Raises
        ------
        FrameTreeError
            if it would make a cycle, a second parent, or a static frame of a moving one or the other way round.
        ParameterError
            if the matrix is no transform or the stamp not finite.
        """
        self._require_place(parent, child, static)
        kept = _checked(matrix)
        if not np.isfinite(stamp):
            raise ParameterError(f"stamp of {child}: {stamp}; expected finite seconds")
        edge = self._edges.setdefault(child, _Edge(parent, static))
        edge.keep(float(stamp), kept, self._buffer_s)
        self._frames |= {parent, child}

    def lookup(self, target: str, source: str, stamp: float | None = None) -> Floats:
        """The transform (4, 4) that takes points of `source` to points of `target`: the pose of source in target.

        Parameters
        ----------
        stamp
            seconds; None for the latest time that all transforms on the way have.

        Raises
        ------
        UnknownFrameError, DisconnectedFramesError
            if a name is not known; if no chain of parents joins the two.
        ExtrapolationError
            if a transform on the way is not known at that time; it names the interval that is.
        """
        up, down = self._ways(target, source)
        when = self._latest(up + down) if stamp is None else stamp
        return inverse(self._along(up, when)) @ self._along(down, when)

    def _require_place(self, parent: str, child: str, static: bool) -> None:
        edge = self._edges.get(child)
        if edge is not None and edge.parent != parent:
            raise FrameTreeError(f"{child}: a second parent, {parent}; expected {edge.parent}, which it has")
        if edge is not None and edge.static != static:
            kinds = ("static", "moving") if static else ("moving", "static")
            raise FrameTreeError(f"{child}: a {kinds[0]} transform; expected a {kinds[1]} one as before")
        if child in self._chain(parent):
            raise FrameTreeError(f"{child}: in {parent}, which is in {child} already; expected no cycle")

    def _chain(self, frame: str) -> list[str]:
        """A frame and its parents up to the root."""
        chain = [frame]
        while chain[-1] in self._edges:
            chain.append(self._edges[chain[-1]].parent)
        return chain

    def _ways(self, target: str, source: str) -> tuple[list[str], list[str]]:
        """The frames from each of the two up to, and without, their first common ancestor."""
        for name in (target, source):
            if name not in self._frames:
                raise UnknownFrameError(f"frame {name}: unknown; expected one of {', '.join(self.frames) or 'none'}")
        ours, theirs = self._chain(target), self._chain(source)
        if ours[-1] != theirs[-1]:
            raise DisconnectedFramesError(
                f"{source} seen from {target}: two trees, with the roots {theirs[-1]} and {ours[-1]}; expected one"
            )
        shared = set(theirs)
        meet = next(name for name in ours if name in shared)
        return ours[: ours.index(meet)], theirs[: theirs.index(meet)]

    def _latest(self, frames: list[str]) -> float:
        moving = [self._edges[name].stamps[-1] for name in frames if not self._edges[name].static]
        return min(moving, default=0.0)

    def _along(self, frames: list[str], stamp: float) -> Floats:
        """From the parent of the last of a chain to its first."""
        whole = np.eye(4)
        for name in frames:
            whole = self._edges[name].at(stamp, name) @ whole
        return whole


def _between(first: Floats, second: Floats, share: float) -> Floats:
    turn = slerp(quaternion_of(first[:3, :3]), quaternion_of(second[:3, :3]), share)
    return transform((1 - share) * first[:3, 3] + share * second[:3, 3], quaternion_rotation(turn))


def _checked(matrix: Floats) -> Floats:
    """An own copy of a (4, 4) transform."""
    own = np.array(matrix, dtype=np.float64)
    rigid = own.shape == (4, 4) and np.isfinite(own).all() and np.array_equal(own[3], [0, 0, 0, 1])
    if not rigid or np.abs(own[:3, :3] @ own[:3, :3].T - np.eye(3)).max() > 1e-6 or np.linalg.det(own[:3, :3]) < 0:
        raise ParameterError(f"a transform of shape {own.shape}; expected (4, 4): a rotation and a place")
    own.setflags(write=False)
    return own
