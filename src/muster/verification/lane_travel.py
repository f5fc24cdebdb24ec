"""The judge's own travel along lanes (docs/design.md, Meaning: travel `lanes`).

A leg goes by a straight stub from its beginning to the nearest point of a lane that the robot can drive, along lanes in
their directions, and by a stub to its end. Of all such ways the quickest is taken, bends included; of ways as quick the
shortest: a metre counts as a microsecond. Found by A* over directed lanes [hart1968].
"""

from __future__ import annotations

import heapq
import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from muster.mission.lanes import Lanes
from muster.mission.model import Point, Robot
from muster.motion.grid import Floats
from muster.motion.leg_times import LegTimes
from muster.verification.map_paths import MapPaths

TOLERANCE = 1e-9
"""Relative. Planner and judge add the same lengths in different orders."""
_ON_LANE_M, _SAME_M, _PARALLEL = 1e-3, 1e-6, 1e-6
_LANES, _STEPS = 100, 20
_S_PER_M = 1e-6

Flat = tuple[float, float]


class Length(NamedTuple):
    """What a way comes to: metres, and seconds at the speeds of robot and lanes, bends included."""

    metres: float
    seconds: float

    @property
    def key(self) -> float:
        return self.seconds + _S_PER_M * self.metres

    def then(self, metres: float, seconds: float) -> Length:
        return Length(self.metres + metres, self.seconds + seconds)


class _Arc(NamedTuple):
    """One direction of a lane."""

    tail: str
    head: str
    start: Flat
    end: Flat
    metres: float
    pace: float  # seconds a metre
    course: float  # radians
    is_open: bool


class _Access(NamedTuple):
    """Where a place meets an arc: metres from where that begins; of a node it is all of those there."""

    arc: int
    at_m: float


@dataclass(frozen=True)
class _Joined:
    """A place as it is joined: its stub, from the place, and the arcs that pass where it ends."""

    place: Flat
    foot: Flat
    stub_m: float
    accesses: tuple[_Access, ...]
    is_open: bool

    def meets(self, other: _Joined) -> bool:
        """Whether both are joined at one point of a lane."""
        same = {access.arc for access in self.accesses} & {access.arc for access in other.accesses}
        return bool(same) and math.dist(self.foot, other.foot) <= _SAME_M

    @property
    def course(self) -> float:
        """Of the stub, from the place to the lane."""
        return math.atan2(self.foot[1] - self.place[1], self.foot[0] - self.place[0])


class LaneTravel:
    """Legs of robots on the ground along the lanes of a mission.

    Parameters
    ----------
    lanes
        of the mission.
    paths
        over its map; None where it has none.
    """

    def __init__(self, lanes: Lanes, paths: MapPaths | None) -> None:
        self._lanes, self._paths = lanes, paths
        self._made: dict[tuple[float, LegTimes], _RobotLanes] = {}

    def length(self, robot: Robot, times: LegTimes, start: Point, end: Point) -> Length | None:
        """Return what the leg of a robot comes to in the plane, without its beginning and end; None: there is none."""
        key = (robot.radius_m, times)
        if key not in self._made:
            self._made[key] = _RobotLanes(self._lanes, self._paths, robot, times)
        return self._made[key].length((start[0], start[1]), (end[0], end[1]))


class _Search:
    """The state of A* towards a place."""

    def __init__(self, end: _Joined, speed_mps: float) -> None:
        self.end = end
        self.best: Length | None = None
        self.into = {access.arc: access.at_m for access in end.accesses}
        self._speed_mps, self._least = speed_mps, dict[int, float]()
        self._queue: list[tuple[float, int, int, Length]] = []

    def reach(self, arc: int, at: Flat, length: Length) -> None:
        """Come to the end of an arc, which is at a place."""
        if length.key < self._least.get(arc, math.inf):
            self._least[arc] = length.key
            left_s = math.dist(at, self.end.foot) / self._speed_mps
            heapq.heappush(self._queue, (length.key + left_s, len(self._least), arc, length))

    def offer(self, length: Length) -> None:
        """Come to the goal."""
        if self.best is None or length.key < self.best.key:
            self.best = length

    def next_arc(self) -> tuple[int, Length] | None:
        """Return the arc that is to be gone on from, and the way to its end; None: no better way is left."""
        while self._queue and (self.best is None or self._queue[0][0] < self.best.key):
            _, _, arc, length = heapq.heappop(self._queue)
            if length.key <= self._least[arc]:
                return arc, length
        return None


class _RobotLanes:
    """The lanes that one robot can drive."""

    def __init__(self, lanes: Lanes, paths: MapPaths | None, robot: Robot, times: LegTimes) -> None:
        self._paths, self._robot, self._times = paths, robot, times
        self._places = {name: (place[0], place[1]) for name, place in lanes.nodes.items()}
        self._arcs: list[_Arc] = []
        self._of_lane: list[int] = []  # by arc the number of its lane
        self._leaving: dict[str, list[int]] = defaultdict(list)
        self._entering: dict[str, list[int]] = defaultdict(list)
        for number, lane in enumerate(lanes.edges):
            ends = self._places[lane.start], self._places[lane.end]
            is_wide = lane.width_m is None or lane.width_m >= 2 * robot.radius_m
            if not is_wide or not self._sees(*ends, doors_open=True):
                continue
            pace = 1 / min(times.speed_mps, lane.speed_mps or math.inf)
            is_open = self._sees_now(*ends)
            for tail, head in lane.directions():
                self._add(number, tail, head, pace, is_open=is_open)
        self._joined: dict[Flat, _Joined | None] = {}
        self._known: dict[tuple[Flat, Flat], Length | None] = {}

    def _add(self, lane: int, tail: str, head: str, pace: float, *, is_open: bool) -> None:
        start, end = self._places[tail], self._places[head]
        course = math.atan2(end[1] - start[1], end[0] - start[0])
        self._leaving[tail].append(len(self._arcs))
        self._entering[head].append(len(self._arcs))
        self._arcs.append(_Arc(tail, head, start, end, math.dist(start, end), pace, course, is_open))
        self._of_lane.append(lane)

    def length(self, start: Flat, end: Flat) -> Length | None:
        """Return what the leg comes to; None where there is none."""
        if start == end:
            return Length(0.0, 0.0)
        if (start, end) not in self._known:
            a, b = self._join(start), self._join(end)
            self._known[start, end] = self._quickest(a, b) if a and b and a.is_open and b.is_open else None
        return self._known[start, end]

    # --- where places are joined ---

    def _join(self, place: Flat) -> _Joined | None:
        if place not in self._joined:
            self._joined[place] = self._joint(place)
        return self._joined[place]

    def _joint(self, place: Flat) -> _Joined | None:
        if not self._arcs or not self._sees(place, place, doors_open=True):
            return None
        for lane, at_m in self._feet(place):
            foot = self._point(lane, at_m)
            if self._sees(place, foot, doors_open=True):
                return self._joined_at(place, lane, at_m)
        return None

    def _point(self, lane: int, at_m: float) -> Flat:
        begin, along, _ = self._lines
        x, y = (begin[lane] + at_m * along[lane]).tolist()
        return x, y

    @cached_property
    def _arcs_of(self) -> list[list[int]]:
        """The arcs of each lane that can be driven, its own direction first."""
        found: dict[int, list[int]] = {}
        for arc, lane in enumerate(self._of_lane):
            found.setdefault(lane, []).append(arc)
        return list(found.values())

    @cached_property
    def _lines(self) -> tuple[Floats, Floats, Floats]:
        """Where lanes begin and their directions, (n, 2); and their lengths (n,)."""
        first = [self._arcs[arcs[0]] for arcs in self._arcs_of]
        begin = np.array([arc.start for arc in first], dtype=np.float64).reshape(-1, 2)
        ends = np.array([arc.end for arc in first], dtype=np.float64).reshape(-1, 2)
        metres = np.hypot(*(ends - begin).T)
        return begin, (ends - begin) / metres[:, None], metres

    def _feet(self, place: Flat) -> Iterator[tuple[int, float]]:
        """Points of lanes to which a place may be joined, by metres along them: the nearest first.

        They are the nearest point of each of the nearest lanes, those whole metres from it, and the lane's ends. Lanes
        are as near in steps of a micrometre.
        """
        begin, along, metres = self._lines
        nearest = np.clip(((np.array(place) - begin) * along).sum(axis=1), 0.0, metres)
        away = np.rint(np.hypot(*(np.array(place) - begin - nearest[:, None] * along).T) / _SAME_M)
        first = int(np.argmin(away))
        yield first, float(nearest[first])
        found: list[tuple[int, int, float]] = []
        for lane in np.argsort(away, kind="stable")[:_LANES].tolist():
            steps = (min(max(nearest[lane] + k, 0.0), metres[lane]) for k in range(-_STEPS, _STEPS + 1))
            ways = {*map(float, steps), 0.0, float(metres[lane])}
            found += [(round(math.dist(place, self._point(lane, m)) / _SAME_M), lane, m) for m in ways]
        for _, lane, at_m in sorted(found):
            yield lane, at_m

    def _joined_at(self, place: Flat, lane: int, at_m: float) -> _Joined:
        """A place joined at a point of a lane: a node, or a point of that lane and those that lie along it."""
        begin, along, metres = self._lines
        if min(at_m, metres[lane] - at_m) <= _ON_LANE_M:
            own = self._arcs[self._arcs_of[lane][0]]
            return self._at_node(place, own.tail if at_m <= _ON_LANE_M else own.head)
        foot = self._point(lane, at_m)
        off = np.array(foot) - begin
        forward, aside = (off * along).sum(axis=1), np.abs(off[:, 0] * along[:, 1] - off[:, 1] * along[:, 0])
        angle = np.abs(along[:, 0] * along[lane, 1] - along[:, 1] * along[lane, 0])
        beyond = np.maximum(-forward, forward - metres)
        there: list[_Access] = []
        for k in np.flatnonzero((np.hypot(aside, beyond.clip(min=0)) <= _SAME_M) & (angle <= _PARALLEL)).tolist():
            to_m = float(forward[k]), float(metres[k] - forward[k])
            there += [_Access(arc, m) for arc, m in zip(self._arcs_of[k], to_m, strict=False)]
        return self._stub(place, foot, there)

    def _at_node(self, place: Flat, node: str) -> _Joined:
        there = [_Access(arc, 0.0) for arc in self._leaving[node]]
        there += [_Access(arc, self._arcs[arc].metres) for arc in self._entering[node]]
        return self._stub(place, self._places[node], there)

    def _stub(self, place: Flat, foot: Flat, there: list[_Access]) -> _Joined:
        stub_m = math.dist(place, foot)
        if stub_m <= _ON_LANE_M:
            return _Joined(place, foot, 0.0, tuple(there), is_open=True)
        return _Joined(place, foot, stub_m, tuple(there), is_open=self._sees_now(place, foot))

    # --- ways ---

    def _quickest(self, start: _Joined, end: _Joined) -> Length | None:
        search = _Search(end, self._times.speed_mps)
        if start.meets(end):
            search.offer(self._arriving(self._set_out(start, None), start.course if start.stub_m else None, end))
        for number, at_m in start.accesses:
            if at_m < self._arcs[number].metres:
                self._drive(search, number, at_m, self._set_out(start, self._arcs[number].course))
        while (found := search.next_arc()) is not None:
            number, length = found
            here = self._arcs[number]
            for onward in self._leaving[here.head]:
                turned = length.then(0.0, self._bend_s(here.course, self._arcs[onward].course))
                self._drive(search, onward, 0.0, turned)
        return search.best

    def _drive(self, search: _Search, number: int, from_m: float, before: Length) -> None:
        """Drive along an arc from some metres of it on: as far as the goal, if that is there, and to its end."""
        arc, goal_m = self._arcs[number], search.into.get(number, -1.0)
        if goal_m > from_m and self._is_open(arc, from_m, goal_m):
            metres = goal_m - from_m
            search.offer(self._arriving(before.then(metres, metres * arc.pace), arc.course, search.end))
        if self._is_open(arc, from_m, arc.metres):
            metres = arc.metres - from_m
            search.reach(number, arc.end, before.then(metres, metres * arc.pace))

    def _set_out(self, start: _Joined, course: float | None) -> Length:
        """The stub from the place, and the bend where it ends."""
        stub = Length(start.stub_m, start.stub_m / self._times.speed_mps)
        return stub if course is None or not start.stub_m else stub.then(0.0, self._bend_s(start.course, course))

    def _arriving(self, length: Length, course: float | None, end: _Joined) -> Length:
        """A way to where a place is joined, with the stub to it."""
        if not end.stub_m:
            return length
        bend_s = 0.0 if course is None else self._bend_s(course, end.course + math.pi)
        return length.then(end.stub_m, bend_s + end.stub_m / self._times.speed_mps)

    def _bend_s(self, course: float, onward: float) -> float:
        return self._times.bend_s(abs(math.remainder(onward - course, 2 * math.pi)))

    # --- what is free ---

    def _is_open(self, arc: _Arc, from_m: float, to_m: float) -> bool:
        """Whether a part of an arc is free with the doors as they are."""
        if arc.is_open or from_m >= to_m:
            return True
        share = np.array([[from_m], [to_m]]) / arc.metres
        begin, end = np.array(arc.start) + share * (np.array(arc.end) - np.array(arc.start))
        return self._sees_now((begin[0], begin[1]), (end[0], end[1]))

    def _sees_now(self, start: Flat, end: Flat) -> bool:
        return self._paths is None or not self._paths.has_closed_doors or self._sees(start, end, doors_open=False)

    def _sees(self, start: Flat, end: Flat, *, doors_open: bool) -> bool:
        return self._paths is None or self._paths.sees(self._robot, start, end, doors_open=doors_open)
