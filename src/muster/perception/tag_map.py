"""Where a team's cameras have seen tags: marks in each robot's own estimate, and what all of them know of one tag.

A tag that is seen becomes a mark of the robot's estimate (`joint_estimate`), or is the mark that it saw before. Which
one follows from the tag's id, and from the innovation with all that is uncertain of pose and mark: however far a robot
has drifted, a tag that it sees again is one tag, as far as its estimate knows how far it may have drifted.

Robots do not take in what others have seen, so that the errors of two robots' marks are independent, and marks of one
tag are averaged by their information.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from muster.perception.dead_reckoning import Seen, by_mark, with_mark
from muster.perception.estimates import RawEstimates
from muster.perception.joint_estimate import Fix, JointEstimate
from muster.perception.kalman import Floats, is_expected
from muster.perception.point_search import FoundCriteria, FoundPoint
from muster.perception.points_of_interest import PointOfInterest

ANOTHER = 60.0
"""The normalised innovation squared, of two degrees of freedom, from which a tag is another one of the same id.

Chance exceeds it once in 10^13 sightings; one between this and what chance makes often is left out.
"""
_SHIFTED_M = 0.02
"""By how much a mark's place changes before what the team knows of it is computed again."""


@dataclass(eq=False)
class _Mark:
    """One tag in one robot's estimate: its number there, how often it was seen, and where and how well it was known.

    `seen_m` is the standard deviation of its place as seen from the robot, when it was seen last.
    """

    robot: str
    tag: int
    number: int
    sightings: int = 1
    seen_m: float = np.inf
    place: Floats = field(default_factory=lambda: np.full(2, np.inf))
    covariance: Floats = field(default_factory=lambda: np.full((2, 2), np.inf))


@dataclass(eq=False)
class _Place:
    """One place of a tag: its marks, what was known before the run was interrupted, and the find, if it is one."""

    marks: list[_Mark] = field(default_factory=list)
    before: PointOfInterest | None = None
    find: FoundPoint | None = None

    def point(self, tag: int) -> PointOfInterest:
        known = [(mark.place, mark.covariance) for mark in self.marks]
        sightings, robots = sum(mark.sightings for mark in self.marks), {mark.robot for mark in self.marks}
        if self.before is not None:
            known.append((self.before.position, self.before.covariance))
            sightings, robots = sightings + self.before.sightings, robots | set(self.before.robots)
        information = [np.linalg.inv(covariance) for _, covariance in known]
        covariance = np.linalg.inv(sum(information))
        weighed = [each @ place for each, (place, _) in zip(information, known, strict=True)]
        return PointOfInterest(covariance @ sum(weighed), covariance, sightings, tuple(sorted(robots)), tag)


class TagMap:
    """What a team has seen and found so far."""

    def __init__(self, criteria: FoundCriteria | None = None) -> None:
        self._criteria = criteria or FoundCriteria()
        self._raw: list[RawEstimates] = []
        self._marks: dict[str, list[_Mark]] = defaultdict(list)
        self._places: dict[int, list[_Place]] = defaultdict(list)
        self._reported: dict[tuple[int, int], Floats] = {}

    @property
    def raw(self) -> RawEstimates:
        """All estimates by single sightings, in the order in which they came."""
        return RawEstimates.joined(self._raw)

    @property
    def seen(self) -> frozenset[int]:
        """The tags that were seen."""
        return frozenset(self._places)

    @property
    def finds(self) -> tuple[FoundPoint, ...]:
        """All points found, in order of time, with their latest estimates."""
        finds = (place.find for places in self._places.values() for place in places if place.find is not None)
        return tuple(sorted(finds, key=lambda find: find.at_s))

    def take(
        self, robot: str, estimate: JointEstimate, seen: Sequence[tuple[int, Seen]], raw: RawEstimates, now: float
    ) -> tuple[JointEstimate, tuple[FoundPoint, ...]]:
        """Add what one robot saw in a picture.

        Parameters
        ----------
        estimate
            of the robot, with the marks that it got here before.
        seen, raw
            tags by id, and where the robot sees them; and the same on the map.

        Returns
        -------
        the robot's estimate with what it saw, and points that are newly found, or have moved since they were reported.
        """
        if not seen:
            return estimate, ()
        self._raw.append(raw)
        marks, looked_at = self._marks[robot], set[int]()
        for tag, where in seen:
            estimate, mark = self._with(robot, estimate, tag, where)
            if mark is not None:
                looked_at.add(mark.number)
        for number in looked_at:
            marks[number].seen_m = _greatest(estimate.seen_covariance(number))
        shifted = [mark for mark in marks if self._is_shifted(mark, estimate) or mark.number in looked_at]
        for mark in shifted:
            mark.place = estimate.marks[mark.number]
            mark.covariance = estimate.place_covariance(mark.number)
        return estimate, tuple(self._new(shifted, now))

    def resume(self, finds: Iterable[FoundPoint]) -> None:
        """Take over what was found before; each point counts from then on as one estimate with its covariance."""
        for find in finds:
            self._places[find.tag].append(_Place(before=find.point, find=find))
            self._reported[find.tag, find.number] = find.point.position

    def _with(self, robot: str, estimate: JointEstimate, tag: int, seen: Seen) -> tuple[JointEstimate, _Mark | None]:
        """The estimate with one sighting, and the mark that it is of; None where it fits no mark and is left out."""
        known = [mark for mark in self._marks[robot] if mark.tag == tag]
        fixes = [(by_mark(estimate, mark.number, seen), mark) for mark in known]
        fix, mark = min(fixes, key=lambda one: one[0].nis, default=(None, None))
        if fix is not None and mark is not None and not self._is_another(fix):
            if not is_expected(fix.nis, 2):
                return estimate, None
            mark.sightings += 1
            return fix.estimate, mark
        mark = _Mark(robot, tag, len(estimate.marks))
        self._marks[robot].append(mark)
        return with_mark(estimate, seen), mark

    def _is_another(self, fix: Fix) -> bool:
        """Whether what was seen is not the mark, but another tag of its id: tags as near as `apart_m` are one."""
        return fix.nis > ANOTHER and float(np.linalg.norm(fix.innovation)) > self._criteria.apart_m

    def _is_shifted(self, mark: _Mark, estimate: JointEstimate) -> bool:
        return bool(np.abs(estimate.marks[mark.number] - mark.place).max() > _SHIFTED_M)

    def _new(self, marks: Sequence[_Mark], now: float) -> Iterator[FoundPoint]:
        """Compute anew what is known of the places of marks, and give those that are news."""
        for tag, place in dict.fromkeys((mark.tag, self._place_of(mark)) for mark in marks):
            point = place.point(tag)
            if place.find is None and not self._is_found(place, point):
                continue
            number = self._next_number(tag) if place.find is None else place.find.number
            at_s = now if place.find is None else place.find.at_s
            place.find = FoundPoint(tag, number, at_s, point)
            reported = self._reported.get((tag, number))
            if reported is None or np.linalg.norm(point.position - reported) > self._criteria.moved_m:
                self._reported[tag, number] = point.position
                yield place.find

    def _is_found(self, place: _Place, point: PointOfInterest) -> bool:
        """Whether it was seen often, and well enough from a robot, however well that knew its own place."""
        nearest = min((mark.seen_m for mark in place.marks), default=0.0)
        return point.sightings >= self._criteria.sightings and nearest <= self._criteria.deviation_m

    def _next_number(self, tag: int) -> int:
        return sum(place.find is not None for place in self._places[tag])

    def _place_of(self, mark: _Mark) -> _Place:
        """The place that a mark is of: the nearest that it may be, of which this robot has no other mark."""
        places = self._places[mark.tag]
        for place in places:
            if mark in place.marks:
                return place
        free = [place for place in places if all(other.robot != mark.robot for other in place.marks)]
        apart = [(_apart(place.point(mark.tag), mark), k) for k, place in enumerate(free)]
        nearest, k = min(apart, default=(np.inf, 0))
        if nearest >= ANOTHER:
            places.append(_Place())
            free, k = places, len(places) - 1
        free[k].marks.append(mark)
        return free[k]


def _apart(point: PointOfInterest, mark: _Mark) -> float:
    """The squared distance of a mark from a point, in units of what both are uncertain by."""
    off = mark.place - point.position[:2]
    return float(off @ np.linalg.solve(point.covariance[:2, :2] + mark.covariance, off))


def _greatest(covariance: Floats) -> float:
    """The greatest standard deviation along any direction."""
    return float(np.sqrt(max(0.0, np.linalg.eigvalsh(covariance)[-1])))
