"""Incremental search for points of interest: raw estimates in, points found so far out; sans I/O.

Estimates are grouped by decoded tag, so the number of points need not be known; a tag that lies at two places is two
points. A point counts as found when it has enough sightings and a small enough covariance.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.perception.clusters import Labels, linked
from muster.perception.estimates import RawEstimates
from muster.perception.points_of_interest import PointOfInterest, points_of_interest


@dataclass(frozen=True, kw_only=True)
class FoundCriteria:
    """The criteria by which a point of interest counts as found.

    Parameters
    ----------
    sightings
        the least number of images in which it was seen.
    deviation_m
        the greatest standard deviation of its position in any direction.
    moved_m
        the distance by which its position must differ from the reported one to be reported again.
    apart_m, independent_after_s
        see `linked` and `points_of_interest`.

    Raises
    ------
    ParameterError
        if a number is not above 0.
    """

    sightings: int = 3
    deviation_m: float = 0.15
    moved_m: float = 0.1
    apart_m: float = 1.0
    independent_after_s: float = 5.0

    def __post_init__(self) -> None:
        for name in ("sightings", "deviation_m", "moved_m", "apart_m", "independent_after_s"):
            if not (value := getattr(self, name)) > 0:
                raise ParameterError(f"{name}: {value}; expected above 0")

    def holds(self, point: PointOfInterest) -> bool:
        """Whether the point counts as found."""
        greatest = float(np.linalg.eigvalsh(point.covariance)[-1])
        return point.sightings >= self.sightings and greatest <= self.deviation_m**2


@dataclass(frozen=True, eq=False)
class FoundPoint:
    """A point of interest that was found: its tag, its number among those with this tag, when, its latest estimate."""

    tag: int
    number: int
    at_s: float
    point: PointOfInterest


class PointSearch:
    """What a team has seen and found so far."""

    def __init__(self, criteria: FoundCriteria | None = None) -> None:
        self._criteria = criteria or FoundCriteria()
        self._seen: dict[int, list[RawEstimates]] = defaultdict(list)
        self._labels: dict[int, Labels] = {}
        self._finds: dict[int, list[FoundPoint]] = defaultdict(list)
        self._reported: dict[tuple[int, int], PointOfInterest] = {}

    @property
    def raw(self) -> RawEstimates:
        """All estimates, by tag and then in the order in which they came."""
        return RawEstimates.joined([part for tag in sorted(self._seen) for part in self._seen[tag]])

    @property
    def seen(self) -> frozenset[int]:
        """The tags that were seen."""
        return frozenset(self._seen)

    @property
    def finds(self) -> tuple[FoundPoint, ...]:
        """All points found, in order of time, with their latest estimates."""
        return tuple(sorted((find for of in self._finds.values() for find in of), key=lambda find: find.at_s))

    def take(self, estimates: RawEstimates, now: float) -> tuple[FoundPoint, ...]:
        """Add estimates; returns points that are newly found, or have moved since they were reported."""
        new = []
        for tag in np.unique(estimates.tags).tolist():
            self._seen[tag].append(_of_tag(estimates, tag))
            new += [find for find in self._known(tag, now) if self._is_new(find)]
        for find in new:
            self._reported[find.tag, find.number] = find.point
        return tuple(new)

    def resume(self, finds: Iterable[FoundPoint]) -> None:
        """Take over what was found before; each point counts from then on as one estimate with its covariance."""
        for find in finds:
            point, where = find.point, np.atleast_2d(find.point.position)
            self._finds[find.tag].append(find)
            self._reported[find.tag, find.number] = point
            tags, times = np.array([find.tag]), np.array([find.at_s])
            self._seen[find.tag].append(RawEstimates(where, point.covariance[None], tags, point.robots[:1], times))

    def _known(self, tag: int, now: float) -> list[FoundPoint]:
        """The latest estimates of the points with a tag; points that were found before stay found."""
        criteria, finds = self._criteria, self._finds[tag]
        raw = RawEstimates.joined(self._seen[tag])
        self._seen[tag] = [raw]
        labels = self._labels[tag] = linked(raw.positions, criteria.apart_m, self._labels.get(tag))
        points = points_of_interest(raw, labels, independent_after_s=criteria.independent_after_s)
        free = list(finds)  # each found point takes one cluster: of several near ones that with most sightings
        for point in sorted(points, key=lambda point: -point.sightings):
            known = _nearest(free, point, criteria.apart_m)
            if known is not None:
                free.remove(known)
                finds[known.number] = FoundPoint(tag, known.number, known.at_s, point)
            elif criteria.holds(point):
                finds.append(FoundPoint(tag, len(finds), now, point))
        return finds

    def _is_new(self, find: FoundPoint) -> bool:
        reported = self._reported.get((find.tag, find.number))
        if reported is None:
            return True
        return float(np.linalg.norm(find.point.position - reported.position)) > self._criteria.moved_m


def _of_tag(estimates: RawEstimates, tag: int) -> RawEstimates:
    of = np.flatnonzero(estimates.tags == tag)
    covariances = None if estimates.covariances is None else estimates.covariances[of]
    robots = tuple(estimates.robots[k] for k in of)
    return RawEstimates(estimates.positions[of], covariances, estimates.tags[of], robots, estimates.times_s[of])


def _nearest(finds: list[FoundPoint], point: PointOfInterest, apart_m: float) -> FoundPoint | None:
    """The found point at this position, if any."""
    away = [float(np.linalg.norm(find.point.position - point.position)) for find in finds]
    nearest = int(np.argmin(away)) if away else 0
    return finds[nearest] if away and away[nearest] <= apart_m else None
