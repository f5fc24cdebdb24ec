"""Figure 8, errors and risk factor by true and by estimated positions of robots; and how far these differ.

The paper's robots steer by odometry, and its errors are by odometry: how well robots follow their own estimates. Ours
steer by their true places, so no own error is of the same measure. All are shown; none has a check mark.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev
from typing import Any

import numpy as np

from muster_studies.comparison_marks import OTHER_MEASURE
from muster_studies.effort import Effort
from muster_studies.market_5.searches import (
    LASER,
    ODOMETRY,
    PLACES,
    TRUE,
    Search,
    SearchResult,
    found_by_world,
    searches,
)
from muster_studies.rescue.flights import NOISE, repetitions
from muster_studies.rescue.metrics import METRICS, Metric, printed_goal_error_m
from muster_studies.rescue.teams import ARENA, BODY_RADIUS_M, sent
from muster_studies.rescue.tracking import SAMPLE_M
from muster_studies.tables import Cell, Table, row

SHOWN = tuple(
    metric for metric in METRICS if metric.name in ("goal_error", "mean_error", "greatest_error", "obstacle", "risk")
)
"""What the paper's figure shows by its text; the risk factor both as (8) and as least distance."""


def measured(found: Sequence[SearchResult], metric: Metric, robot: str, place: str) -> list[float]:
    """Of each search one figure."""
    return [float(getattr(one.tracking(robot, place), metric.name)) for one in found]


def team(effort: Effort) -> tuple[str, ...]:
    """The robots that have something to do."""
    return sent(ARENA, searches(effort)[0].iterations)


@dataclass(frozen=True)
class Figure8:
    """Mean and spread of each metric for each robot, in each world, by each place."""

    number: str = "Figure 8"
    columns: tuple[str, ...] = (
        "world",
        "metric",
        "robot",
        "paper",
        *(f"{place}{sign}" for place in PLACES for sign in ("", " ±")),
        "mark",
    )

    def jobs(self, effort: Effort) -> Iterator[Search]:
        yield from searches(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        rows = []
        for world, found in found_by_world(effort, results):
            for metric in SHOWN:
                for robot in team(effort):
                    cells = _cells(metric, {place: measured(found, metric, robot, place) for place in PLACES})
                    rows.append(row(self.columns, {"world": world, "robot": robot, **cells}))
        title = f"Errors and risk factor, searches in each world: {repetitions(effort)}"
        return Table(self.number, title, self.columns, tuple(rows), _NOTES, decimals=4)


def _cells(metric: Metric, values: Mapping[str, Sequence[float]]) -> dict[str, Cell]:
    cells: dict[str, Cell] = {
        "metric": metric.label,
        "paper": printed_goal_error_m() if metric.name == "goal_error" else None,
        "mark": metric.mark(values[TRUE]),
    }
    for place, each in values.items():
        cells |= {place: fmean(each), f"{place} ±": stdev(each) if len(each) > 1 else None}
    return cells


_NOTES = (
    "The paper's figure is a picture; in words it prints that no error at a goal was greater than 0.0065 m. ±: "
    "standard deviation over the searches, as its bars over five.",
    "true: where robots were. odometry, laser: where they took themselves to be by odometry alone, and with landmarks.",
    f"{OTHER_MEASURE}: the paper's robots steer by odometry, and its errors are by odometry; ours steer by true "
    "places. Then the true error is that of steering, and the error by odometry adds what odometry is off: neither is "
    "the paper's measure.",
    f"(7): at the same shares of the way, every {SAMPLE_M} m. (8) is summed over these points too. Section 5 calls "
    f"the least distance the risk factor: of centres; a body ({BODY_RADIUS_M} m) touches at {BODY_RADIUS_M} m.",
    f"Noise, ours, each step: a robot misses {NOISE.velocity} of its velocity (standard deviation), slips by up to "
    f"{NOISE.slip} of its way, its odometry errs by {NOISE.odometry} of it, its heading by {NOISE.heading_rad} rad.",
)


@dataclass(frozen=True)
class Localisation:
    """How far robots were off, by odometry alone and with landmarks."""

    number: str = "Localisation"
    columns: tuple[str, ...] = (
        "world",
        "robot",
        "odometry mean m",
        "odometry most m",
        "laser mean m",
        "laser most m",
        "odometry surprise",
        "laser surprise",
        "better",
    )

    def jobs(self, effort: Effort) -> Iterator[Search]:
        yield from searches(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        rows = []
        for world, found in found_by_world(effort, results):
            rows += [
                row(self.columns, {"world": world, "robot": robot, **_off(found, robot)}) for robot in team(effort)
            ]
        notes = (
            "Metres from where the robot was, over all steps of all searches. surprise: squared error in units of the "
            "filter's own covariance, by coordinate: 1 of a filter that knows its errors, less of one that is too "
            "careful, more of one that is too sure. better: searches in which landmarks made the mean error less.",
            "The paper prints nothing of this. Landmarks are six cylinders at known places, ours.",
        )
        title = "Where robots take themselves to be, by odometry and with landmarks"
        return Table(self.number, title, self.columns, tuple(rows), notes, decimals=4)


def _off(found: Sequence[SearchResult], robot: str) -> dict[str, Cell]:
    off = {place: [one.off[robot, place] for one in found] for place in (ODOMETRY, LASER)}
    surprise = {place: np.concatenate([one.surprise[robot, place][1:] for one in found]) for place in off}
    better = sum(laser.mean() < odometry.mean() for odometry, laser in zip(off[ODOMETRY], off[LASER], strict=True))
    return {
        "odometry mean m": float(np.concatenate(off[ODOMETRY]).mean()),
        "odometry most m": float(np.concatenate(off[ODOMETRY]).max()),
        "laser mean m": float(np.concatenate(off[LASER]).mean()),
        "laser most m": float(np.concatenate(off[LASER]).max()),
        "odometry surprise": float(surprise[ODOMETRY].mean() / 2),
        "laser surprise": float(surprise[LASER].mean() / 2),
        "better": f"{better}/{len(found)}",
    }
