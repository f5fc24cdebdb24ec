"""Figure 8, errors and risk factor of robots that steer by their estimates; the error at the goal; how far they err.

The paper's robots steer by odometry, with landmarks. Ours do, too; beside that they steer by odometry alone. Errors are
true ones, which no robot knows.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev
from typing import Any

import numpy as np

from muster_studies.comparison_marks import EQUAL
from muster_studies.effort import Effort
from muster_studies.market_5.arena import STEERED_NOISE
from muster_studies.market_5.searches import (
    ALONE,
    LANDMARKED,
    PLACES,
    Search,
    SearchResult,
    found_by_world,
    searches,
)
from muster_studies.rescue.flights import repetitions
from muster_studies.rescue.metrics import METRICS, Metric, printed_goal_error_m
from muster_studies.rescue.teams import ARENA, BODY_RADIUS_M, sent
from muster_studies.rescue.tracking import SAMPLE_M
from muster_studies.tables import Cell, Table, row

SHOWN = tuple(
    metric for metric in METRICS if metric.name in ("goal_error", "mean_error", "greatest_error", "obstacle", "risk")
)
"""What the paper's figure shows by its text; the risk factor both as (8) and as least distance."""


def measured(found: Sequence[SearchResult], metric: Metric, robot: str, place: str) -> list[float]:
    """Of each search in which the robot did something one figure."""
    searched = [one for one in found if one.flown[place].visits[robot]]
    return [float(getattr(one.tracking(robot, place), metric.name)) for one in searched]


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
        return Table(self.number, title, self.columns, tuple(rows), _NOTES, decimals=4, mark_rule=_RULE)


def _cells(metric: Metric, values: Mapping[str, Sequence[float]]) -> dict[str, Cell]:
    printed = printed_goal_error_m() if metric.name == "goal_error" else None
    cells: dict[str, Cell] = {"metric": metric.label, "paper": printed, "mark": metric.mark(values[LANDMARKED])}
    if printed is not None:
        cells["mark"] = EQUAL if max(values[LANDMARKED]) <= printed else "more"
    for place, each in values.items():
        cells |= {place: fmean(each), f"{place} ±": stdev(each) if len(each) > 1 else None}
    return cells


_NOISE = (
    f"Noise, ours, each step: a robot misses {STEERED_NOISE.velocity} of its velocity (standard deviation), each wheel "
    f"slips by up to {STEERED_NOISE.slip} of its way, and its odometry errs by {STEERED_NOISE.odometry} of it."
)
_RULE = f"{EQUAL}: the greatest error at a goal with landmarks is at most what the paper prints."
_NOTES = (
    "The paper's figure is a picture; in words it prints that no error at a goal was greater than 0.0065 m. ±: "
    "standard deviation over the searches, as its bars over five.",
    "landmarks: where robots were that steered by odometry with landmarks; believed: where they took themselves to be; "
    "odometry alone: where robots were that steered by that. At the goal: the greatest distance from a survivor's "
    "place at which work ended.",
    f"(7): at the same shares of the way, every {SAMPLE_M} m. (8) is summed over these points too. Section 5 calls "
    f"the least distance the risk factor: of centres; a body ({BODY_RADIUS_M} m) touches at {BODY_RADIUS_M} m.",
    _NOISE,
)


@dataclass(frozen=True)
class Goals:
    """The error at the goal in each search: the greatest of all robots, true."""

    number: str = "Goals"
    columns: tuple[str, ...] = ("world", "seed", "paper", LANDMARKED, ALONE, "tasks", "tasks alone", "mark")

    def jobs(self, effort: Effort) -> Iterator[Search]:
        yield from searches(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        rows = [row(self.columns, _goal_cells(job, results[job])) for job in searches(effort)]
        reached = sum(cells[-1] == EQUAL for cells in rows)
        notes = (
            "Metres: the greatest distance from a survivor's place at which a robot's work ended, of all robots, where "
            f"they truly were. paper: the most that it prints. At most that with landmarks: {reached} of {len(rows)}.",
            f"{LANDMARKED}: robots steer by odometry corrected by landmarks; {ALONE}: by odometry alone. tasks: done.",
            _NOISE,
        )
        title = "Error at the goal"
        return Table(self.number, title, self.columns, tuple(rows), notes, decimals=4, mark_rule=_RULE)


def _goal_cells(job: Search, one: SearchResult) -> dict[str, Cell]:
    most = {}
    for place in (LANDMARKED, ALONE):
        robots = [robot for robot, visits in one.flown[place].visits.items() if visits]
        most[place] = max(one.tracking(robot, place).goal_error for robot in robots)
    printed = printed_goal_error_m()
    tasks = {place: len(one.flown[place].report.tasks_done) for place in most}
    return {
        "world": job.world,
        "seed": job.seed,
        "paper": printed,
        **most,
        "tasks": tasks[LANDMARKED],
        "tasks alone": tasks[ALONE],
        "mark": EQUAL if most[LANDMARKED] <= printed else "more",
    }


@dataclass(frozen=True)
class Localisation:
    """How far robots were off where they took themselves to be, by odometry alone and with landmarks."""

    number: str = "Localisation"

    def jobs(self, effort: Effort) -> Iterator[Search]:
        yield from searches(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        rows = []
        for world, found in found_by_world(effort, results):
            rows += [{"world": world, "robot": robot, **_off(found, robot)} for robot in team(effort)]
        notes = (
            "Metres from where the robot was, over all steps of all searches. surprise: squared error in units of the "
            "filter's own covariance, by coordinate: 1 of a filter that knows its errors, less of one that is too "
            "careful, more of one that is too sure. better: searches in which landmarks made the mean error less.",
            "The paper prints nothing of this. Landmarks are six cylinders at known places, ours.",
        )
        title = "How far robots are off where they take themselves to be"
        return Table.of_cells(self.number, title, rows, notes, decimals=4)


def _off(found: Sequence[SearchResult], robot: str) -> dict[str, Cell]:
    off = {way: [one.off[robot, way] for one in found] for way in (ALONE, LANDMARKED)}
    surprise = {way: np.concatenate([one.surprise[robot, way][1:] for one in found]) for way in off}
    better = sum(mended.mean() < alone.mean() for alone, mended in zip(off[ALONE], off[LANDMARKED], strict=True))
    return {
        "alone mean m": float(np.concatenate(off[ALONE]).mean()),
        "alone most m": float(np.concatenate(off[ALONE]).max()),
        "landmarks mean m": float(np.concatenate(off[LANDMARKED]).mean()),
        "landmarks most m": float(np.concatenate(off[LANDMARKED]).max()),
        "alone surprise": float(surprise[ALONE].mean() / 2),
        "landmarks surprise": float(surprise[LANDMARKED].mean() / 2),
        "better": f"{better}/{len(found)}",
    }
