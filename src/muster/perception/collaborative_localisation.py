"""Collaborative localisation: robots that see each other share what they know of their poses.

A robot that sees another at a range and bearing has in it a landmark, whose place is an estimate. What two robots know
may rest on the same sightings, so that their errors are not independent; covariance intersection ([julier1997]) stays
consistent whatever they share ([tcf-thesis], section 2.2.2, reviews the idea).
"""

from __future__ import annotations

import numpy as np

from muster.perception.errors import GroundErrors
from muster.perception.ground_fusion import range_and_bearing_off, range_and_bearing_to
from muster.perception.kalman import Correction, Estimate, extended_correction, gated

_SHARES = np.linspace(0.05, 0.95, 19)
"""Of the own knowledge, which are tried."""


def by_teammate(
    estimate: Estimate, mate: Estimate, range_m: float, bearing_rad: float, errors: GroundErrors
) -> Estimate:
    """Correct a robot's estimate by another robot that it sees.

    Parameters
    ----------
    estimate
        (n,), x, y and heading first, as `ground_fusion` has it.
    mate
        (2,) or more, x and y first: the other's own estimate.
    range_m, bearing_rad
        to the other, from straight ahead to the left; their errors are `range_m` and `bearing_rad` of `errors`.

    Returns
    -------
    the estimate whose position varies least; the old one where none of those tried varies less, or where the sighting
    does not fit (`kalman.gated`).

    Raises
    ------
    ParameterError
        if both estimates have the same place.
    """
    best = estimate
    for share in _SHARES:
        own = Estimate(estimate.mean, estimate.covariance / share)
        found = gated(own, _corrected(own, mate, (range_m, bearing_rad), errors, 1 - share))
        if found is not own and _spread(found) < _spread(best):
            best = found
    return best


def _spread(estimate: Estimate) -> float:
    return float(np.trace(estimate.covariance[:2, :2]))


def _corrected(
    own: Estimate, mate: Estimate, seen: tuple[float, float], errors: GroundErrors, share: float
) -> Correction:
    sensor = range_and_bearing_to(mate.mean[:2], "mate: {}; expected another place than the robot's own")
    by_place = -sensor(own.mean)[1][:, :2]  # moving the mate moves the measurement the other way
    spread = by_place @ (mate.covariance[:2, :2] / share) @ by_place.T
    uncertainty = spread + np.diag([errors.range_m**2, errors.bearing_rad**2])
    return extended_correction(own, sensor, seen, uncertainty, range_and_bearing_off)
