"""The edge weights of TSPLIB [reinelt1991]: functions of coordinates, and matrices in all their layouts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from muster.mission.values.arrays import Floats

_EARTH_RADIUS_KM = 6378.388
_PI = 3.141592
"""As TSPLIB has it: with more digits some weights differ."""


def _nint(values: Floats) -> Floats:
    """The nearest whole numbers, halves up."""
    return np.floor(values + 0.5)


def _euclidean(gaps: Floats) -> Floats:
    return np.asarray(np.sqrt((gaps**2).sum(axis=0)))


def _largest(gaps: Floats) -> Floats:
    return np.asarray(gaps.max(axis=0))


def _att(gaps: Floats) -> Floats:
    """The pseudo-Euclidean weight, rounded up."""
    exact = np.sqrt((gaps**2).sum(axis=0) / 10)
    near = _nint(exact)
    return np.where(near < exact, near + 1, near)


def _xray(gaps: Floats, divisors: tuple[float, float, float]) -> Floats:
    """Hundredths of the longest of three motions of a diffractometer, the first of which goes around."""
    around = np.minimum(gaps[0], np.abs(gaps[0] - 360))
    return _nint(100 * _largest(np.array([around, gaps[1], gaps[2]]) / np.array(divisors)[:, None]))


_OF_GAPS: Mapping[str, tuple[int, Callable[[Floats], Floats]]] = MappingProxyType(
    {
        "EUC_2D": (2, lambda gaps: _nint(_euclidean(gaps))),
        "EUC_3D": (3, lambda gaps: _nint(_euclidean(gaps))),
        "CEIL_2D": (2, lambda gaps: np.ceil(_euclidean(gaps))),
        "CEIL_3D": (3, lambda gaps: np.ceil(_euclidean(gaps))),
        "FLOOR_2D": (2, lambda gaps: np.floor(_euclidean(gaps))),
        "FLOOR_3D": (3, lambda gaps: np.floor(_euclidean(gaps))),
        "MAN_2D": (2, lambda gaps: _nint(gaps.sum(axis=0))),
        "MAN_3D": (3, lambda gaps: _nint(gaps.sum(axis=0))),
        "MAX_2D": (2, lambda gaps: _largest(_nint(gaps))),
        "MAX_3D": (3, lambda gaps: _largest(_nint(gaps))),
        "ATT": (2, _att),
        "XRAY1": (3, lambda gaps: _xray(gaps, (1.0, 1.0, 1.0))),
        "XRAY2": (3, lambda gaps: _xray(gaps, (1.25, 1.5, 1.15))),
    }
)
"""By type: the number of coordinates, and the weights of the differences to one node (coordinates, nodes)."""

EXPLICIT = "EXPLICIT"
COORDINATES: Mapping[str, int] = MappingProxyType({name: count for name, (count, _) in _OF_GAPS.items()} | {"GEO": 2})
"""How many coordinates a node has, by the type of edge weights."""


def weights_of(kind: str, points: Floats) -> Floats:
    """The weights between all nodes: whole numbers; 0 from a node to itself.

    Parameters
    ----------
    kind
        a type of `COORDINATES`.
    points
        (n, 2) or (n, 3) coordinates as they stand in the file; GEO: latitude and longitude as degrees.minutes.

    Returns
    -------
    (n, n) weights; inf or NaN where coordinates are too large.
    """
    with np.errstate(all="ignore"):
        if kind == "GEO":
            table = _geographic(points)
        else:
            of_gaps = _OF_GAPS[kind][1]
            table = np.array([of_gaps(np.abs(points - point).T) for point in points])
    np.fill_diagonal(table, 0.0)
    return table


def _geographic(points: Floats) -> Floats:
    """Kilometres along great circles of an idealised sphere."""
    degrees = np.trunc(points)
    latitude, longitude = (_PI * (degrees + 5.0 * (points - degrees) / 3.0) / 180.0).T
    q1 = np.cos(longitude[:, None] - longitude)
    q2 = np.cos(latitude[:, None] - latitude)
    q3 = np.cos(latitude[:, None] + latitude)
    cosine = np.clip(0.5 * ((1.0 + q1) * q2 - (1.0 - q1) * q3), -1.0, 1.0)
    return np.asarray(np.trunc(_EARTH_RADIUS_KM * np.arccos(cosine) + 1.0))


_SAME_ORDER = MappingProxyType(
    {
        "UPPER_COL": "LOWER_ROW",
        "LOWER_COL": "UPPER_ROW",
        "UPPER_DIAG_COL": "LOWER_DIAG_ROW",
        "LOWER_DIAG_COL": "UPPER_DIAG_ROW",
    }
)
"""Layouts by columns, and those by rows whose numbers stand in the same order: the weights are symmetric."""

LAYOUTS = ("FULL_MATRIX", "UPPER_ROW", "LOWER_ROW", "UPPER_DIAG_ROW", "LOWER_DIAG_ROW", *_SAME_ORDER)


def numbers_in(layout: str, n: int) -> int:
    """How many numbers a matrix of n nodes has in a layout."""
    if layout == "FULL_MATRIX":
        return n * n
    return n * (n + 1) // 2 if "DIAG" in layout else n * (n - 1) // 2


def matrix_of(layout: str, n: int, numbers: Floats) -> Floats:
    """The (n, n) matrix in so many numbers of a layout; its diagonal is 0, whatever stands there."""
    layout = _SAME_ORDER.get(layout, layout)
    if layout == "FULL_MATRIX":
        table = numbers.reshape(n, n).copy()
    else:
        first = 0 if "DIAG" in layout else 1
        rows, columns = np.triu_indices(n, first) if layout.startswith("UPPER") else np.tril_indices(n, -first)
        table = np.zeros((n, n))
        table[rows, columns] = numbers
        table[columns, rows] = numbers
    np.fill_diagonal(table, 0.0)
    return table
