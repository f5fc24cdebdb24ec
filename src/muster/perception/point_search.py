"""Points of interest while they are being found: sightings in, what is known by now out; sans I/O.

The tag that is decoded tells what belongs together, so their number need not be known; a tag that lies at two places is
two points. A point counts as found when it was seen often enough and is known well enough.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.perception.clusters import Labels, linked
from muster.perception.estimates import RawEstimates
from muster.perception.points_of_interest import PointOfInterest, points_of_interest


@dataclass(frozen=True, kw_only=True)
class FoundCriteria:
    """When a point of interest counts as found.

    Parameters
    ----------
    sightings
        in at least so many images.
    deviation_m
        along no direction is the standard deviation of its place greater.
    moved_m
        by which a place must differ from the one that was told before it is told again.
    apart_m, independent_after_s
        see `linked` and `points_of_interest`.

    Raises
    ------
    ParameterError
        if a number is not above 0.
    """

    sightings: int = 3
    deviation_m: float = 0.15
    moved_m: float = 0.25
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
    """A point of interest that was found: the how-manieth with its tag, from 0; when first; what is known of it now."""

    tag: int
    number: int
    at_s: float
    point: PointOfInterest


class PointSearch:
    """What a team has seen so far, and found."""

    def __init__(self, proof: FoundCriteria | None = None) -> None:
        self._proof = proof or FoundCriteria()
        self._seen: dict[int, list[RawEstimates]] = defaultdict(list)
        self._labels: dict[int, Labels] = {}
        self._finds: dict[int, list[FoundPoint]] = defaultdict(list)
        self._told: dict[tuple[int, int], PointOfInterest] = {}

    @property
    def raw(self) -> RawEstimates:
        """All estimates, by tag and then in the order in which they came."""
        return RawEstimates.joined([part for tag in sorted(self._seen) for part in self._seen[tag]])

    @property
    def seen(self) -> frozenset[int]:
        """The tags that were seen at all."""
        return frozenset(self._seen)

    @property
    def finds(self) -> tuple[FoundPoint, ...]:
        """All that was found, in order of time, with what is known of it now."""
        return tuple(sorted((find for of in self._finds.values() for find in of), key=lambda find: find.at_s))

    def take(self, estimates: RawEstimates, now: float) -> tuple[FoundPoint, ...]:
        """Take new estimates in; returns what is found by that, or lies elsewhere than was told."""
        news = []
        for tag in np.unique(estimates.tags).tolist():
            self._seen[tag].append(_of_tag(estimates, tag))
            news += [find for find in self._known(tag, now) if self._is_news(find)]
        for find in news:
            self._told[find.tag, find.number] = find.point
        return tuple(news)

    def _known(self, tag: int, now: float) -> list[FoundPoint]:
        """What is known now of the points with a tag; those that were found before stay found."""
        proof, finds = self._proof, self._finds[tag]
        raw = RawEstimates.joined(self._seen[tag])
        self._seen[tag] = [raw]
        labels = self._labels[tag] = linked(raw.positions, proof.apart_m, self._labels.get(tag))
        points = points_of_interest(raw, labels, independent_after_s=proof.independent_after_s)
        free = list(finds)  # a find is one point: that which was seen most often, should more be near
        for point in sorted(points, key=lambda point: -point.sightings):
            known = _nearest(free, point, proof.apart_m)
            if known is not None:
                free.remove(known)
                finds[known.number] = FoundPoint(tag, known.number, known.at_s, point)
            elif proof.holds(point):
                finds.append(FoundPoint(tag, len(finds), now, point))
        return finds

    def _is_news(self, find: FoundPoint) -> bool:
        told = self._told.get((find.tag, find.number))
        return told is None or float(np.linalg.norm(find.point.position - told.position)) > self._proof.moved_m


def _of_tag(estimates: RawEstimates, tag: int) -> RawEstimates:
    of = np.flatnonzero(estimates.tags == tag)
    covariances = None if estimates.covariances is None else estimates.covariances[of]
    robots = tuple(estimates.robots[k] for k in of)
    return RawEstimates(estimates.positions[of], covariances, estimates.tags[of], robots, estimates.times_s[of])


def _nearest(finds: list[FoundPoint], point: PointOfInterest, apart_m: float) -> FoundPoint | None:
    """The find that this point is, if any."""
    away = [float(np.linalg.norm(find.point.position - point.position)) for find in finds]
    nearest = int(np.argmin(away)) if away else 0
    return finds[nearest] if away and away[nearest] <= apart_m else None
