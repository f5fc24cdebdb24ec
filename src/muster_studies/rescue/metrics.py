"""Figure 7, reference against flown path of rangeBot; Figure 8, the metrics of all robots over repetitions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import fmean, stdev
from typing import Any

from muster_studies.comparison_marks import OTHER_MEASURE
from muster_studies.effort import Effort
from muster_studies.market_rescue.scenario import paper
from muster_studies.rescue.flights import NOISE, Flight, repetitions
from muster_studies.rescue.scenario import undisturbed
from muster_studies.rescue.teams import BODY_RADIUS_M, sent
from muster_studies.rescue.tracking import SAMPLE_M, Tracking, tracking
from muster_studies.tables import Cell, Table, row

SHOWN_ROBOT = "rangeBot"
"""Of Figure 7."""


def noisy(effort: Effort) -> tuple[Flight, ...]:
    """The repetitions, with noise."""
    return tuple(replace(undisturbed(effort), seed=seed) for seed in range(repetitions(effort)))


@dataclass(frozen=True)
class Figure7:
    """Each flight of one robot beside its reference."""

    number: str = "Figure 7"
    columns: tuple[str, ...] = ("flight", "reference m", "flown m", "mean aside m", "greatest aside m", "arrives s")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        yield undisturbed(effort)
        yield from noisy(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        rows = []
        for flight in self.jobs(effort):
            found = tracking(flight.team, results[flight], SHOWN_ROBOT)
            arrives_s = results[flight].visits[SHOWN_ROBOT][-1].arrives_s
            name = "without noise" if flight.seed is None else f"noise, seed {flight.seed}"
            lengths = found.reference_m, found.flown_m
            rows.append((name, *lengths, found.mean_aside, found.greatest_aside, arrives_s))
        notes = (
            "The reference is the path finder's way, rounded by Bezier splines (4). aside: cross-track, from where the "
            "robot truly was to the nearest point of the reference; the mean evenly along the way, the greatest of all "
            "steps of 0.1 s. The paper prints a picture; --plot DIR draws ours.",
            "The robot is sent the corners of the way, not the splines: it cuts a corner by 2 cm at most, and keeps "
            "off walls while it turns.",
        )
        title = f"Reference and flown way of {SHOWN_ROBOT}"
        return Table(self.number, title, self.columns, tuple(rows), notes, decimals=4)


@dataclass(frozen=True)
class Metric:
    """One figure of `Tracking`."""

    name: str
    label: str

    def mark(self, values: Sequence[float]) -> str:
        """Of distances whether bodies touched. Nothing compares with the paper, which measures by odometry."""
        if self.name == "goal_error":
            return OTHER_MEASURE
        touching = {"obstacle": BODY_RADIUS_M, "robot": 2 * BODY_RADIUS_M}
        if self.name in touching:
            return "no contact" if min(values) > touching[self.name] else "contact"
        return ""


METRICS = (
    Metric("goal_error", "error at the goal, m"),
    Metric("mean_error", "mean error on the way (7), m"),
    Metric("greatest_error", "greatest error on the way (7), m"),
    Metric("obstacle", "least distance to an obstacle, m"),
    Metric("risk", "risk factor (8), 1/m"),
    Metric("robot", "least distance to a robot, m"),
    Metric("odometry_off", "odometry more than true, m"),
)


def printed_goal_error_m() -> float:
    """The one metric that the paper prints as a number: no robot's error was greater."""
    return float(paper()["greatest_position_error_m"])


def measured(effort: Effort, results: Mapping[Any, Any]) -> dict[str, tuple[Tracking, ...]]:
    """By robot what each repetition measured."""
    flights = noisy(effort)
    robots = sent(flights[0].team, flights[0].iterations)
    return {robot: tuple(tracking(one.team, results[one], robot) for one in flights) for robot in robots}


@dataclass(frozen=True)
class Figure8:
    """Mean and spread of each metric for each robot."""

    number: str = "Figure 8"
    columns: tuple[str, ...] = ("metric", "robot", "paper", "mean", "spread", "least", "most", "mark")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        yield from noisy(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        found = measured(effort, results)
        rows = [
            row(self.columns, _cells(metric, robot, [getattr(one, metric.name) for one in each]))
            for metric in METRICS
            for robot, each in found.items()
        ]
        return Table(
            self.number, f"Metrics, flights with noise: {repetitions(effort)}", self.columns, tuple(rows), NOTES, 4
        )


def _cells(metric: Metric, robot: str, values: Sequence[float]) -> dict[str, Cell]:
    return {
        "metric": metric.label,
        "robot": robot,
        "paper": printed_goal_error_m() if metric.name == "goal_error" else None,
        "mean": fmean(values),
        "spread": stdev(values) if len(values) > 1 else None,
        "least": min(values),
        "most": max(values),
        "mark": metric.mark(values),
    }


NOTES = (
    "spread: standard deviation over the flights. The paper prints 0.0065 m as the most of all its robots and flights; "
    "all else in its figure is a picture.",
    f"Noise, ours, each step: a robot misses {NOISE.velocity} of its velocity (standard deviation), slips by up to "
    f"{NOISE.slip} of its way, its odometry errs by {NOISE.odometry} of it, the place that it tells by "
    f"{NOISE.position_m} m, the heading by {NOISE.heading_rad} rad.",
    f"{OTHER_MEASURE}: own errors are of true places, and own robots steer by true places; the paper's robots steer by "
    "odometry, and its errors are by odometry. So the two do not compare. What own odometry is off is the last metric.",
    f"(7): at the same shares of the way, every {SAMPLE_M} m. (8) is summed over these points too. Distances are of "
    f"centres: a body ({BODY_RADIUS_M} m) touches an obstacle at {BODY_RADIUS_M} m, another at {2 * BODY_RADIUS_M} m.",
)
