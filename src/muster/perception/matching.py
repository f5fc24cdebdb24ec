"""Estimated positions matched with true ones: the tables 6.4 and 6.5 of [tcf-thesis], as data.

Matched by linear sum assignment: one to one, so that the sum of all distances is least.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.perception.optional_parts import require_physics


@dataclass(frozen=True)
class Match:
    """One row: a thing that is there, and what was found of it; places in metres of the map frame."""

    name: str
    truth: tuple[float, ...]
    found: tuple[float, ...]
    error_m: float


@dataclass(frozen=True)
class ErrorTable:
    """Tables 6.4 and 6.5.

    Attributes
    ----------
    matches
        the greatest error first.
    missed
        names of what is there and was not found.
    extra
        places that were found and where nothing is.
    mean_distance_m
        between what is there: over all pairs of two (d_ip in 6.1.2); NaN for fewer than two. The 12.29 m of Table 6.4
        are this; the 2.38 m of Table 6.5 count each tag's distance 0 to itself, too, and should be 2.86 m.
    """

    matches: tuple[Match, ...]
    missed: tuple[str, ...]
    extra: tuple[tuple[float, ...], ...]
    mean_distance_m: float

    @property
    def mean_error_m(self) -> float:
        """Over the matches; NaN without any."""
        return sum(match.error_m for match in self.matches) / len(self.matches) if self.matches else math.nan

    @property
    def greatest_error_m(self) -> float:
        """Over the matches; NaN without any."""
        return self.matches[0].error_m if self.matches else math.nan


def error_table(
    found: Sequence[npt.ArrayLike], truth: Mapping[str, npt.ArrayLike], farthest_m: float = math.inf
) -> ErrorTable:
    """Match places found with the true ones, both (d,), metres.

    What is `farthest_m` apart or more is no match: rather one is missed, and one was found where nothing is.

    Raises
    ------
    ParameterError
        if the places are not all of two or all of three finite coordinates, or `farthest_m` is not above 0.
    MissingExtraError
        if SciPy is not installed.
    """
    if not farthest_m > 0:
        raise ParameterError(f"farthest_m: {farthest_m}; expected metres above 0")
    names = list(truth)
    there = _places("truth", list(truth.values()))
    seen = _places("found", found)
    if len(there) and len(seen) and there.shape[1] != seen.shape[1]:
        raise ParameterError(f"found: {seen.shape[1]} coordinates; expected {there.shape[1]}, as the truth")
    pairs = matched(there, seen, farthest_m)
    rows = [
        Match(names[i], tuple(there[i].tolist()), tuple(seen[j].tolist()), math.dist(there[i], seen[j]))
        for i, j in pairs
    ]
    rows.sort(key=lambda row: -row.error_m)
    met, used = {i for i, _ in pairs}, {j for _, j in pairs}
    return ErrorTable(
        tuple(rows),
        tuple(name for i, name in enumerate(names) if i not in met),
        tuple(tuple(place.tolist()) for j, place in enumerate(seen) if j not in used),
        _mean_distance(there),
    )


def matched(truth: Floats, found: Floats, farthest_m: float = math.inf) -> list[tuple[int, int]]:
    """Pairs of an index into truth (n, d) and one into found (m, d), each once at most, by the first.

    Raises
    ------
    MissingExtraError
        if SciPy is not installed.
    """
    require_physics("matching points of interest", "scipy")
    from scipy.optimize import linear_sum_assignment

    if not len(truth) or not len(found):
        return []
    distances = np.linalg.norm(truth[:, None] - found[None], axis=2)
    pairs = zip(*linear_sum_assignment(np.minimum(distances, farthest_m)), strict=True)
    return [(int(i), int(j)) for i, j in pairs if distances[i, j] < farthest_m]


def _places(name: str, places: Sequence[npt.ArrayLike]) -> Floats:
    rows = [np.asarray(place, dtype=np.float64) for place in places]
    shapes = sorted({row.shape for row in rows})
    if not rows:
        return np.empty((0, 2))
    if shapes not in ([(2,)], [(3,)]):
        raise ParameterError(f"{name}: shapes {shapes}; expected all (2,) or all (3,)")
    array = np.array(rows)
    if not np.isfinite(array).all():
        raise ParameterError(f"{name}: a number that is not finite; expected finite numbers")
    return array


def _mean_distance(places: Floats) -> float:
    count = len(places)
    if count < 2:
        return math.nan
    return float(np.linalg.norm(places[:, None] - places[None], axis=2).sum() / (count * (count - 1)))
