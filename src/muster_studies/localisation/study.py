"""The study: its tables, and how its runs are made."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, median
from typing import Any

from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.localisation.consistency import Consistencies, Consistency, ConsistencyJob
from muster_studies.localisation.drives import SCAN_S, SCANNER, SLIP, TURN_RAD
from muster_studies.localisation.errors import (
    BEARING_RAD,
    RANGE_M,
    SEEN_M,
    Track,
    by_monte_carlo,
    by_odometry,
    by_scan_matching,
    carried,
    drives,
    of_team,
)
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.tables import Table

DRIVEN_S, QUICK_S = 60.0, 20.0
"""How long a robot drives, and after it was carried elsewhere drives on; the latter in a quick study."""
FOUND_M = 0.5
"""Within which a robot is found."""

Run = Callable[[int, float], Track]
METHODS: Mapping[tuple[str, str], Run] = {
    ("tracking", "odometry"): lambda seed, s: by_odometry(drives(seed, s)),
    ("tracking", "scan matching"): lambda seed, s: by_scan_matching(drives(seed, s)),
    ("tracking", "Monte Carlo"): lambda seed, s: by_monte_carlo(drives(seed, s), seed, known=True),
    ("global", "Monte Carlo"): lambda seed, s: by_monte_carlo(drives(seed, s), seed, known=False),
    ("kidnapped", "Monte Carlo"): lambda seed, s: by_monte_carlo(carried(seed, s), seed, known=True),
    ("team", "odometry"): lambda seed, s: of_team(seed, s, together=False),
    ("team", "and sightings of a teammate"): lambda seed, s: of_team(seed, s, together=True),
}
"""By table and method."""


@dataclass(frozen=True)
class Job:
    """One run of one method, so many seconds long."""

    table: str
    method: str
    seed: int
    seconds: float

    def perform(self) -> Track:
        return METHODS[self.table, self.method](self.seed, self.seconds)


def seconds(effort: Effort) -> float:
    return QUICK_S if effort.quick else DRIVEN_S


def _methods(table: str) -> Iterator[str]:
    return (method for number, method in METHODS if number == table)


def _jobs(table: str, effort: Effort) -> Iterator[Job]:
    return (
        Job(table, method, seed, seconds(effort)) for method in _methods(table) for seed in range(effort.seed_count)
    )


@dataclass(frozen=True)
class Tracking:
    """Errors of methods that know where the robot starts."""

    number: str
    title: str
    notes: tuple[str, ...]

    def jobs(self, effort: Effort) -> Iterator[Job]:
        return _jobs(self.number, effort)

    def table(self, effort: Effort, found: Mapping[Job, Track]) -> Table:
        rows = []
        for method in _methods(self.number):
            errors = [found[job].errors_m for job in self.jobs(effort) if job.method == method]
            mean, greatest = fmean(float(one.mean()) for one in errors), max(float(one.max()) for one in errors)
            rows.append((method, len(errors), mean, greatest, fmean(float(one[-1]) for one in errors)))
        columns = ("method", "runs", "mean error m", "greatest m", "at the end m")
        return Table(self.number, self.title, columns, tuple(rows), self.notes, decimals=3)


@dataclass(frozen=True)
class Finding:
    """How often and how soon a robot that does not know its pose finds it."""

    number: str
    title: str
    notes: tuple[str, ...]
    carried: bool = False

    def jobs(self, effort: Effort) -> Iterator[Job]:
        return _jobs(self.number, effort)

    def table(self, effort: Effort, found: Mapping[Job, Track]) -> Table:
        tracks = [found[job] for job in self.jobs(effort)]
        after_s = seconds(effort) if self.carried else 0.0
        times = [track.found_s(FOUND_M, after_s) for track in tracks]
        known = [time for time in times if time is not None]
        ends = [float(track.errors_m[-1]) for track, time in zip(tracks, times, strict=True) if time is not None]
        row = (*_methods(self.number), len(tracks), len(known), *_or_none(median, known), *_or_none(max, known))
        columns = ("method", "runs", "found", "median s", "latest s", "error at the end m")
        return Table(self.number, self.title, columns, ((*row, *_or_none(fmean, ends)),), self.notes, decimals=3)


def _or_none(of: Callable[[Sequence[float]], float], values: Sequence[float]) -> tuple[float | None]:
    return (of(values) if values else None,)


_TABLES: tuple[Reproduction[Any, Any], ...] = (
    Tracking(
        "tracking", "A robot that knows where it starts", (f"Drives of {DRIVEN_S:g} s, with --quick of {QUICK_S:g} s.",)
    ),
    Finding(
        "global",
        "A robot that does not know where it starts",
        (f"found: within {FOUND_M} m from then on to the end of the drive.",),
    ),
    Finding(
        "kidnapped",
        "A robot that is carried elsewhere",
        ("At the end of the drive it goes on at another place for as long; times count from there.",),
        carried=True,
    ),
    Tracking(
        "team",
        "A robot without a map that sees one with a map",
        (
            f"Both drive ways of their own. The second sees the first within {SEEN_M:g} m where no wall is between, "
            f"off by {RANGE_M} m and {BEARING_RAD} rad, and joins what both know by covariance intersection.",
        ),
    ),
    Consistencies(),
)

_LEGEND = (
    "Drives over the floor plan of mission floor, in the kinematic world, between random places. Every "
    f"{SCAN_S:g} s a laser of {SCANNER.reach_m:g} m scans, off by {SCANNER.range_m} m; odometry since the last scan "
    f"is off by {100 * SLIP:g} % of the way and {TURN_RAD} rad. Errors are "
    "distances of the estimated from the true place.",
)


def _performed(job: Job | ConsistencyJob) -> Track | Consistency:
    return job.perform()


LOCALISATION = Repetition(
    **description("localisation", _LEGEND),
    reproductions=_TABLES,
    perform=one_by_one(_performed),
    extras=("map",),
)
"""Lidar odometry, Monte Carlo localisation and collaborative localisation, which the theses review."""
