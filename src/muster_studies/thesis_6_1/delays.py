"""Table `delays`: what images that are older than the pose they are matched with do to the estimates of tags.

The thesis' raw estimates form patterns that are elongated along the flight (Figure 6.5), and its points of interest are
0.241 m off in the mean. It names no cause. An image that is late by a constant time is one: every estimate lies ahead
of the tag, by the delay times the speed, and by more where the drone flies faster.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from statistics import fmean

import numpy as np

from muster.simulation import Noise
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table, row
from muster_studies.thesis_6_1.flights import Flight, FlightResult
from muster_studies.thesis_6_1.published import points, tags, thirty, truth

DELAYS_S = (0.0, 0.1, 0.2, 0.3, 0.4)
_NUMBER = "6.4"


def late(delay_s: float) -> Flight:
    """The flight among thirty tags in the kinematic world with images that are so late."""
    return thirty(world="kinematic", noise=Noise(camera_delay_s=delay_s))


@dataclass(frozen=True)
class Delays:
    """A row for each delay."""

    number: str = "delays"
    columns: tuple[str, ...] = ("delay s", "tags found", "mean error", "greatest", "raw, rms", "long to short")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        return (late(delay_s) for delay_s in DELAYS_S)

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        rows = [row(self.columns, {"delay s": delay_s, **_cells(found[late(delay_s)])}) for delay_s in DELAYS_S]
        worst = max(entry["error"] for entry in tags(_NUMBER).values())
        thesis: dict[str, Cell] = {
            "tags found": len(tags(_NUMBER)),
            "mean error": points()[_NUMBER]["mean_error"],
            "greatest": worst,
        }
        rows.append(row(self.columns, {"delay s": "thesis", **thesis}))
        notes = (
            "Kinematic world without other noise, metres. mean error, greatest: of points of interest. raw, rms: root "
            "mean square distance of raw estimates from their tags. long to short: standard deviations of the raw "
            "estimates of a tag along and across their pattern, mean over tags.",
        )
        return Table(self.number, "Images that are late", self.columns, tuple(rows), notes, decimals=3)


def _cells(flown: FlightResult) -> dict[str, Cell]:
    errors = flown.errors(truth(_NUMBER))
    off = {tag: flown.raw.positions[flown.raw.tags == int(tag), :2] - place for tag, place in truth(_NUMBER).items()}
    squares = np.concatenate([(each**2).sum(axis=1) for each in off.values()])
    return {
        "tags found": len(errors.matches),
        "mean error": errors.mean_error_m,
        "greatest": errors.greatest_error_m,
        "raw, rms": float(np.sqrt(squares.mean())),
        "long to short": fmean(_elongation(each) for each in off.values() if len(each) > 2),
    }


def _elongation(points: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    """Standard deviation along the pattern of estimates (n, 2), as a multiple of that across it."""
    short, long = np.sqrt(np.linalg.eigvalsh(np.cov(points.T)))
    return float(long / max(short, 1e-9))
