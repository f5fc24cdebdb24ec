"""SPIKE landmarks: spikes in a range profile, taken for cylinders ([market-paper], sections 4.2, 4.3 and 5).

The paper names the algorithm and prints nothing of it. Known elsewhere is its core: of three values A, B, C beside each
other B is a spike where (A - B) + (C - B) is large. Here both differences must be, and B is a run of beams: the range
falls to it by `depth_m` and rises after it. The rest follows from a circle of radius r at distance D:

    a run of n beams is as wide as the circle is seen:   sin(n step / 2) = sin(alpha) = r / D
    a beam at theta from its middle measures             D (cos(theta) - sqrt(sin(alpha)^2 - sin(theta)^2))

which is linear in D: a least-squares D, and r with it. Where r is known each beam gives D by the law of cosines.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import asdict, dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.ranges import require_finite_positive
from muster.perception.kalman import Floats
from muster.perception.laser import require_scan

_INNER = 0.8
"""Share of a circle's radius within which beams count: nearer its rim, half a beam off is centimetres of range."""


@dataclass(frozen=True, kw_only=True)
class SpikeParameters:
    """The parameters of spike detection.

    Parameters
    ----------
    depth_m
        by which its surroundings are further at least; more than noise makes, less than what stands free does.
    radius_m
        of all landmarks, where it is known.
    smallest_m, largest_m
        radii of landmarks, where it is not.
    misfit_m
        root mean square by which ranges may differ from those of a circle.

    Raises
    ------
    ParameterError
        if one is not above 0, or `smallest_m` is above `largest_m`.
    """

    depth_m: float = 0.1
    radius_m: float | None = None
    smallest_m: float = 0.01
    largest_m: float = 0.2
    misfit_m: float = 0.02

    def __post_init__(self) -> None:
        require_finite_positive(**asdict(self))
        if self.smallest_m > self.largest_m:
            raise ParameterError(f"smallest_m: {self.smallest_m}; expected at most largest_m, {self.largest_m}")


@dataclass(frozen=True)
class Landmark:
    """A cylinder, seen from above.

    Parameters
    ----------
    position
        of its centre, metres in the robot's frame: x ahead, y left.
    radius_m
        as measured, or as known.
    misfit_m
        root mean square of what ranges differ from those of this circle.
    beams
        how many hit it.
    """

    position: tuple[float, float]
    radius_m: float
    misfit_m: float
    beams: int

    @property
    def range_m(self) -> float:
        """The range of its centre."""
        return math.hypot(*self.position)

    @property
    def bearing_rad(self) -> float:
        """The bearing of its centre, from straight ahead, anticlockwise."""
        return math.atan2(self.position[1], self.position[0])


def spikes(ranges: Floats, depth_m: float) -> list[slice]:
    """Runs of beams of a profile (n,) that are nearer than the beam before and the beam after by more than a depth.

    What is cut off by the end of the field, or half hidden by something nearer, is none.
    """
    with np.errstate(invalid="ignore"):  # two infinite ranges beside each other differ by nothing
        change = np.diff(ranges)
    steps = np.where(change < -depth_m, -1, np.where(change > depth_m, 1, 0))
    edges = np.flatnonzero(steps)
    return [
        slice(int(fall) + 1, int(rise) + 1)
        for fall, rise in itertools.pairwise(edges)
        if steps[fall] == -1 and steps[rise] == 1
    ]


def landmarks(ranges: Floats, bearings: Floats, search: SpikeParameters | None = None) -> tuple[Landmark, ...]:
    """The cylinders of a scan, from right to left.

    Parameters
    ----------
    ranges
        (n,) metres, inf where a beam met nothing.
    bearings
        (n,) radians, evenly spaced, rising.

    Raises
    ------
    ParameterError
        if the shapes differ.
    """
    require_scan(ranges, bearings)
    search = search or SpikeParameters()
    step = float(bearings[1] - bearings[0])
    seen = (_circle(ranges[run], bearings[run], step, search.radius_m) for run in spikes(ranges, search.depth_m))
    return tuple(mark for mark in seen if mark is not None and _is_one(mark, search))


def _is_one(mark: Landmark, search: SpikeParameters) -> bool:
    fits = search.radius_m is not None or search.smallest_m <= mark.radius_m <= search.largest_m
    return fits and mark.misfit_m <= search.misfit_m


def _circle(ranges: Floats, bearings: Floats, step: float, radius_m: float | None) -> Landmark | None:
    """The circle that a run of beams shows; None where it is seen wider than half around."""
    middle = float(bearings.mean())
    alpha = len(ranges) * step / 2
    if alpha >= math.pi / 2:
        return None
    theta = bearings - middle
    inner = np.abs(np.sin(theta)) <= _INNER * math.sin(alpha)
    theta, ranges = theta[inner], ranges[inner]
    if radius_m is None:
        shares = np.cos(theta) - np.sqrt(math.sin(alpha) ** 2 - np.sin(theta) ** 2)
        distance = float(shares @ ranges / (shares @ shares))
        radius, expected = distance * math.sin(alpha), distance * shares
    else:
        behind = np.sqrt(np.maximum(radius_m**2 - (ranges * np.sin(theta)) ** 2, 0.0))
        distance = float((ranges * np.cos(theta) + behind).mean())
        depth = np.sqrt(np.maximum(radius_m**2 - (distance * np.sin(theta)) ** 2, 0.0))
        radius, expected = radius_m, distance * np.cos(theta) - depth
    misfit = float(np.sqrt(np.mean((ranges - expected) ** 2)))
    position = (distance * math.cos(middle), distance * math.sin(middle))
    return Landmark(position, radius, misfit, len(bearings))
