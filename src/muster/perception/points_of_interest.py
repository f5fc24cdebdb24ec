"""Points of interest: the fused estimate of each cluster, with its covariance ([tcf-thesis] 4.3.3).

The thesis takes the mean of a cluster. Where every estimate has a covariance, estimates are weighed by it, as a Kalman
filter weighs repeated sightings of an object at rest: distant and oblique views, which are stretched along the line of
sight, count less along it. Where estimates scatter more than their covariances say, the covariance of the result grows
by as much.

A robot's localisation error lasts for a while, and sightings in quick succession share it. So sightings of one robot
within one interval (`independent_after_s`) together count as one, and a drone that hovers weighs no more than one that
passes by. A constant error (a misaligned camera) does not average out, and scatter does not show it.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.perception.clusters import LONE, Labels
from muster.perception.estimates import NO_TAG, RawEstimates

_RADII_95 = ((0.0, 0.2, 0.4, 0.6, 0.8, 1.0), (1.960, 1.970, 2.005, 2.081, 2.230, 2.448))
"""Ratios of the least to the greatest deviation, and the radius, in greatest deviations, that holds 95 %."""


@dataclass(frozen=True, eq=False)
class PointOfInterest:
    """An object that was found.

    Attributes
    ----------
    position
        (d,) metres in the map frame.
    covariance
        (d, d) m^2; NaN where there is but one sighting, of unknown covariance.
    sightings
        in how many estimates it was seen.
    robots
        who saw it, by id.
    tag
        the id decoded most often, None where none was.
    """

    position: Floats
    covariance: Floats
    sightings: int
    robots: tuple[str, ...]
    tag: int | None


def points_of_interest(
    raw: RawEstimates, labels: Labels, *, least: int = 1, independent_after_s: float = 0.0
) -> tuple[PointOfInterest, ...]:
    """Filter each cluster of `labels` (n,) that has at least `least` estimates, in the order of the labels.

    With `independent_after_s` 0 all estimates are independent. It bears on those alone that have covariances.

    Raises
    ------
    ParameterError
        if `independent_after_s` is below 0.
    """
    if not 0 <= independent_after_s < math.inf:
        raise ParameterError(f"independent_after_s: {independent_after_s}; expected seconds of at least 0")
    clusters = [np.flatnonzero(labels == label) for label in np.unique(labels[labels != LONE])]
    return tuple(_point(raw, members, independent_after_s) for members in clusters if len(members) >= least)


def radius_95(covariance: Floats) -> float:
    """Return the radius of the circle that holds a Gaussian error of covariance (2, 2) with a probability of 95 %.

    To 1 %: the Gaussian is integrated for some ratios of both deviations (`_RADII_95`).
    """
    least, greatest = np.sqrt(np.maximum(np.linalg.eigvalsh(covariance), 0.0)).tolist()
    ratio = least / greatest if greatest > 0 else 0.0
    return float(greatest * np.interp(ratio, *_RADII_95))


def remarks(points: tuple[PointOfInterest, ...], seen: Collection[int] = ()) -> tuple[str, ...]:
    """Remarks for the user: nothing found, or a tag at more than one place; `seen` are the tags that were seen."""
    if not points:
        if not seen:
            return ("no point of interest: no tag was seen",)
        tags = ", ".join(map(str, sorted(seen)))
        return (f"no point of interest: seen, but too rarely or from too far, {_tags(len(seen))} {tags}",)
    places = Counter(point.tag for point in points if point.tag is not None)
    return tuple(f"tag {tag} is at {count} places" for tag, count in sorted(places.items()) if count > 1)


def _tags(count: int) -> str:
    return "tag" if count == 1 else "tags"


def _point(raw: RawEstimates, members: npt.NDArray[np.intp], independent_after_s: float) -> PointOfInterest:
    places = raw.positions[members]
    if raw.covariances is None:
        position, covariance = _mean(places)
    else:
        shares = _shares(raw, members, independent_after_s)
        position, covariance = _weighed(places, raw.covariances[members], shares)
    decoded = Counter(tag for tag in raw.tags[members].tolist() if tag != NO_TAG)
    tag = min(decoded, key=lambda tag: (-decoded[tag], tag)) if decoded else None
    robots = tuple(sorted({raw.robots[member] for member in members}))
    return PointOfInterest(position, covariance, len(members), robots, tag)


def _mean(places: Floats) -> tuple[Floats, Floats]:
    """The mean (d,), and by their scatter its covariance (d, d)."""
    count, size = places.shape
    mean = places.mean(axis=0)
    if count == 1:
        return mean, np.full((size, size), np.nan)
    apart = places - mean
    return mean, apart.T @ apart / (count - 1) / count


def _shares(raw: RawEstimates, members: npt.NDArray[np.intp], independent_after_s: float) -> Floats:
    """(n,) as what part of an independent sighting each counts."""
    if independent_after_s == 0:
        return np.ones(len(members))
    stretches = np.floor(raw.times_s[members] / independent_after_s).tolist()
    groups = [(raw.robots[member], stretch) for member, stretch in zip(members, stretches, strict=True)]
    sizes = Counter(groups)
    return np.array([1 / sizes[group] for group in groups])


def _weighed(places: Floats, covariances: Floats, shares: Floats) -> tuple[Floats, Floats]:
    """The mean (d,) weighed by information, and its covariance (d, d), larger where they scatter too much."""
    information = shares[:, None, None] * np.linalg.inv(covariances)
    covariance = np.linalg.inv(information.sum(axis=0))
    mean = covariance @ np.einsum("nij,nj->i", information, places)
    apart = places - mean
    squares = np.einsum("ni,nij,nj->", apart, information, apart)
    freedom = places.shape[1] * (round(shares.sum()) - 1)  # shares add up to the number of independent sightings
    return mean, covariance * max(1.0, squares / freedom if freedom else 1.0)
