"""What it costs to go into a passage for one while others use it: learned from forecasts of traffic."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from muster.motion.grid import Floats
from muster.traffic.journeys.forecast import Forecast
from muster.traffic.journeys.joint_journeys import Journey, TimedMove
from muster.traffic.passages import passages
from muster.traffic.roadmaps.roadmap import Roadmap


class PassageDelays:
    """By passage the mean delay of a robot that goes into it, over all forecasts that were learned from.

    A robot is delayed on the way to a stop by as much as it comes later than if it were alone; the passages that it
    goes into on that way have equal shares.

    Parameters
    ----------
    roadmap
        of the forecasts.
    speed_mps
        of robots on it.
    """

    def __init__(self, roadmap: Roadmap, speed_mps: float) -> None:
        self._roadmap = roadmap
        self._own_s = roadmap.lengths_m / np.minimum(speed_mps, roadmap.speed_mps)  # of each edge
        self._passage = np.full(len(roadmap.points), -1)
        found = passages(roadmap)
        for k, passage in enumerate(found):
            self._passage[passage.points] = k
        self._delay_s, self._forecasts = np.zeros(len(found)), 0

    def __bool__(self) -> bool:
        """Whether anybody was delayed."""
        return bool(self._delay_s.any())

    def learn(self, told: Forecast) -> None:
        """Take a forecast in."""
        delays_s, times = np.zeros_like(self._delay_s), np.zeros_like(self._delay_s)
        for among, alone in zip(told.together, told.alone, strict=True):
            for delay_s, entered in self._legs(among, alone):
                for passage in entered:
                    delays_s[passage] += delay_s / len(entered)
                    times[passage] += 1
        self._forecasts += 1
        self._delay_s += (delays_s / np.maximum(times, 1) - self._delay_s) / self._forecasts

    def between(self, points: Sequence[int], to: Sequence[int]) -> Floats:
        """(len(points), len(to)) seconds that ways between points of the roadmap cost more; 0 where a point is -1."""
        start, end = self._passage[self._roadmap.edges].T
        enters = (end >= 0) & (start != end)
        delayed_s = self._own_s + np.where(enters, self._delay_s[end], 0.0)
        with np.errstate(invalid="ignore"):  # there may be no way
            more_s = self._seconds(delayed_s, points, to) - self._seconds(self._own_s, points, to)
        known = (np.array(points) >= 0)[:, None] & (np.array(to) >= 0)
        return np.where(known & (more_s > 0), more_s, 0.0)

    def _seconds(self, edges_s: Floats, points: Sequence[int], to: Sequence[int]) -> Floats:
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import dijkstra

        n = len(self._roadmap.points)
        starts, number = np.unique(np.maximum(points, 0), return_inverse=True)
        seconds = dijkstra(csr_array((edges_s, self._roadmap.edges.T), shape=(n, n)), indices=starts)
        return np.asarray(seconds[number][:, to])

    def _legs(self, among: Journey, alone: Journey) -> Iterator[tuple[float, list[int]]]:
        """For each leg of a journey by how much others delay it, and the passages that it goes into."""
        before_s = 0.0
        late = {move.stop: move.start_s for move in among.moves}  # when the last move of a leg begins
        for stop, moves in _by_stop(alone).items():
            late_s = late.get(stop, moves[-1].start_s + before_s) - moves[-1].start_s
            inside = self._inside([moves[0].point, *(move.to for move in moves)])
            yield max(0.0, late_s - before_s), [into for out, into in pairwise(inside) if into >= 0 and into != out]
            before_s = late_s

    def _inside(self, points: Sequence[int]) -> list[int]:
        """The passage of each point; -1 where it is in none, as places beside the roadmap are."""
        return [int(self._passage[k]) if k < len(self._passage) else -1 for k in points]


def _by_stop(journey: Journey) -> dict[int, list[TimedMove]]:
    """The moves of each leg, by the number of the stop to which it leads."""
    legs = defaultdict(list)
    for move in journey.moves:
        legs[move.stop].append(move)
    return legs
