"""Table `sizes`: a tag's place by its size, as (4.44) and (4.45) are printed and by the pose of its four corners.

The thesis' drone looks down at 45 degrees from 3 m; tags of 0.4 m lie face up on the ground around its line of sight.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from muster.motion.frames import moved, pose_transform
from muster.motion.grid import Floats
from muster.perception.camera import RB5_MOUNT, Intrinsics, View
from muster.perception.localisation import by_length_as_printed, by_size
from muster.perception.tags import CORNERS
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table
from muster_studies.thesis_6_1.flights import Flight, FlightResult

PLACES = ((1.5, 0.0), (3.0, 0.0), (5.0, 0.0), (3.0, 1.5), (3.0, -1.5))
HEIGHT_M, SIZE_M, FOV_RAD = 3.0, 0.4, math.radians(60)
CORNER_PX, PICTURES = 0.2, 100


@dataclass(frozen=True)
class Sizes:
    """A row for each place of the tag: root mean square distances from it, metres."""

    number: str = "sizes"

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        """None: nothing is flown."""
        yield from ()

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        rows: list[tuple[Cell, ...]] = []
        for x, y in PLACES:
            exact, noisy = _errors((x, y, 0.0), 0.0, 1), _errors((x, y, 0.0), CORNER_PX, PICTURES)
            rows.append((f"({x:g}, {y:g})", *_rms(exact), *_rms(noisy)))
        columns = ("tag at", "as printed", "by size", "as printed, noise", "by size, noise")
        notes = (
            f"From {HEIGHT_M:g} m with 45 degrees of tilt, tags of {SIZE_M:g} m; noise: {CORNER_PX} px of each corner, "
            f"root mean square over {PICTURES} pictures. (4.44) takes the depth along the optical axis for the "
            "distance, and a tag seen aslant for a smaller one.",
        )
        return Table(self.number, "Tags placed by their size", columns, tuple(rows), notes, decimals=3)


def _errors(place: tuple[float, float, float], corner_px: float, pictures: int) -> Floats:
    """(pictures, 2): by how many metres both ways are off in each picture."""
    view = View.from_body(Intrinsics.of_view(640, 480, FOV_RAD), [0.0, 0.0, HEIGHT_M, 0.0, 0.0, 0.0], RB5_MOUNT)
    exact = view.project(moved(pose_transform([*place, math.pi, 0.0, 0.0]), SIZE_M * CORNERS))
    random, errors = np.random.default_rng(0), []
    for _ in range(pictures):
        corners = exact + random.normal(0.0, corner_px, exact.shape)
        positions = by_length_as_printed(view, corners, SIZE_M), by_size(view, corners, SIZE_M).position
        errors.append([math.dist(position, place) for position in positions])
    return np.array(errors)


def _rms(errors: Floats) -> tuple[float, ...]:
    return tuple(np.sqrt((errors**2).mean(axis=0)).tolist())
