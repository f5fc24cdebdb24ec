"""The fences of plan files as the map of one mission: inclusions are its boundary, exclusions its zones.

A mission has one boundary for all robots, so all fences must have the same. Fences have no heights.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

Corner = tuple[float, float]
"""Latitude and longitude in degrees, or metres of the map frame."""

_SAME_M = 0.01


@dataclass(frozen=True)
class Fences:
    """The polygons of one file, in degrees: inclusions and exclusions."""

    inside: tuple[tuple[Corner, ...], ...]
    outside: tuple[tuple[Corner, ...], ...]


def map_of(
    fences: Sequence[Fences],
    kinds: Sequence[str],
    metres: Callable[[Corner], Corner],
    refused: Callable[[int], Exception],
) -> dict[str, Any] | None:
    """The `map` of a mission file; None if no file has a fence.

    Parameters
    ----------
    fences, kinds
        of each file: its polygons, and whether its vehicle is of kind `ground` or `air`.
    metres
        degrees in the map frame.
    refused
        makes the error for a file, by its index, whose fence has another boundary.
    """
    if not any(fence.inside or fence.outside for fence in fences):
        return None
    boundary: list[Corner] | None = None
    zones: list[tuple[list[Corner], list[str]]] = []
    for k, (fence, kind) in enumerate(zip(fences, kinds, strict=True)):
        bounds = [[metres(corner) for corner in ring] for ring in fence.inside]
        if len(bounds) != 1 or not _same(bounds[0], boundary or bounds[0]):
            raise refused(k)
        boundary = boundary or bounds[0]
        for ring in fence.outside:
            corners = [metres(corner) for corner in ring]
            known = next((of for polygon, of in zones if _same(polygon, corners)), None)
            if known is None:
                zones.append((corners, [kind]))
            elif kind not in known:
                known.append(kind)
    return {"boundary": boundary, "zones": [{"polygon": polygon, "forbidden_to": of} for polygon, of in zones]}


def _same(a: Sequence[Corner], b: Sequence[Corner]) -> bool:
    return len(a) == len(b) and all(math.dist(p, q) < _SAME_M for p, q in zip(a, b, strict=True))
