"""The quickest ways of one robot along given lanes, with stubs from places to lanes and back."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.lanes import Lanes
from muster.mission.values.arrays import Bools, Floats
from muster.motion.leg_times import LegTimes
from muster.motion.path import NoPath, Path
from muster.motion.paths.lane_joints import JoinedLanes, Joints, Sees, closed_lanes, ends_of, joined

NO_LANE = "no lane"
"""The reason of ways that do not exist as no straight way leads from an end to a lane that the robot can drive."""


@dataclass(frozen=True, eq=False)
class LanePaths:
    """Ways of one robot along lanes.

    Places are joined with all doors open, and ways lead through none that is closed.

    Parameters
    ----------
    lanes
        of the mission.
    radius_m, times
        of the robot.
    sees
        whether the robot can move straight between two points while all doors are open; None where there is no map.
    sees_now
        the same with the doors as they are; None where no door stands in the way.
    closed
        the ids of lanes that are closed.
    """

    lanes: Lanes
    radius_m: float
    times: LegTimes
    sees: Sees | None
    sees_now: Sees | None = None
    closed: Collection[str] = ()

    def path(self, start: npt.ArrayLike, goal: npt.ArrayLike) -> Path | NoPath:
        """Return the quickest way between two points of the map frame, in the plane, or why there is none."""
        found = self.driven(start, goal)
        return found if isinstance(found, NoPath) else found[0]

    def driven(self, start: npt.ArrayLike, goal: npt.ArrayLike) -> tuple[Path, list[float]] | NoPath:
        """Return the same with the greatest speed on each of its pieces, metres per second; inf on stubs."""
        ends = np.array([start, goal], dtype=np.float64)[:, :2]
        if (ends[0] == ends[1]).all():
            if not self.clear(ends):
                return NoPath("start blocked", _shown(ends[0]))
            return Path(ends[:1]), []
        on = self._open(joined(self._joints, ends))
        for place, number in zip(ends, on.places.tolist(), strict=True):
            if number < 0:
                return NoPath(NO_LANE, f"no straight way leads from {_shown(place)} to a lane that it can drive")
        way = self._ways(on).way(*on.places.tolist())
        if not way:
            return NoPath("disconnected", f"no lanes lead from {_shown(ends[0])} to {_shown(ends[1])}")
        points = on.points[way]
        points[0], points[-1] = ends
        name = on.arcs @ (len(on.points), 1)
        driven = np.isin(name, np.array(way[:-1]) * len(on.points) + way[1:])
        speed = dict(zip(map(tuple, on.arcs[driven].tolist()), self._speeds(on)[driven].tolist(), strict=True))
        return Path(points), [speed[piece] for piece in pairwise(way)]

    def clear(self, points: Floats) -> bool:
        """Return whether the robot can move straight from each point (k, d) to the next, be it beside the lanes."""
        sees = self.sees if self.sees_now is None else self.sees_now
        return sees is None or sees(points[:, :2])

    def lengths(self, exits: Floats, entries: Floats, *, threads: int = 1) -> tuple[Floats, Floats]:
        """Return the lengths (n, m) of ways from exits (n, 2) to entries (m, 2), metres, and the seconds they take.

        The seconds are those from rest to rest; both are inf where there is no way.
        """
        leave, enter = exits[:, :2], entries[:, :2]
        places, number = np.unique(np.concatenate([leave, enter]), axis=0, return_inverse=True)
        on = self._open(joined(self._joints, places))
        number = number.reshape(-1)
        (rows, row), (columns, column) = (
            np.unique(some, return_inverse=True) for some in np.split(number, [len(leave)])
        )
        metres, seconds = self._ways(on).lengths(on.places[rows].tolist(), on.places[columns].tolist(), threads)
        same = rows[:, np.newaxis] == columns
        metres[same], seconds[same] = 0.0, 0.0
        return metres[row][:, column], self.times.lane_seconds(metres, seconds)[row][:, column]

    def joins(self, place: Sequence[float]) -> bool:
        """Return whether a place is joined to a lane."""
        return self._joints.joint(np.array(place[:2], dtype=np.float64)) is not None

    @cached_property
    def _joints(self) -> Joints:
        closed = {lane.number for lane in closed_lanes(self.lanes, self.radius_m, self.sees)}
        return Joints.of(self.lanes, (k for k in range(len(self.lanes.edges)) if k not in closed), self.sees)

    @cached_property
    def _limits(self) -> Floats:
        """The greatest speed on each lane, and last that on stubs."""
        return np.array([*(lane.speed_mps or math.inf for lane in self.lanes.edges), math.inf])

    @cached_property
    def _blocked(self) -> Bools:
        """Of each lane, and last of stubs, whether some piece may be closed now."""
        now = self.sees_now
        shut = [lane.id is not None and lane.id in self.closed for lane in self.lanes.edges]
        if now is None:
            return np.array([*shut, False])
        return np.array(
            [k or not now(ends_of(self.lanes, e)) for k, e in zip(shut, self.lanes.edges, strict=True)] + [True]
        )

    def _open(self, on: JoinedLanes) -> JoinedLanes:
        """The lanes without the pieces that are closed now."""
        looked_at = np.flatnonzero(self._blocked[on.lanes])
        shut = [k for k in looked_at.tolist() if not self._is_open(on, k)]
        return on._replace(arcs=np.delete(on.arcs, shut, axis=0), lanes=np.delete(on.lanes, shut)) if shut else on

    def _is_open(self, on: JoinedLanes, arc: int) -> bool:
        lane, begins_within = int(on.lanes[arc]), on.arcs[arc, 0] >= len(self.lanes.nodes)
        if lane >= 0 and self.lanes.edges[lane].id in self.closed and not begins_within:
            return False  # who is on it gets out again
        return self.sees_now is None or self.sees_now(on.points[on.arcs[arc]])

    def _speeds(self, on: JoinedLanes) -> Floats:
        return self._limits[on.lanes]

    def _ways(self, on: JoinedLanes) -> core.LaneWays:
        metres = np.linalg.norm(on.points[on.arcs[:, 1]] - on.points[on.arcs[:, 0]], axis=1)
        seconds = metres / np.minimum(self.times.speed_mps, self._speeds(on))
        return core.LaneWays(on.points, on.arcs, seconds, turn=self.times.turn_s, stop=self.times.stop_s)


def _shown(point: Floats) -> str:
    return f"({', '.join(f'{c:g}' for c in point.tolist())})"
