"""The study: its tables, its legend, how its runs are made, and its pictures.

The tables: arrivals, least distances between robots, durations.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from muster.motion.avoidance import Trajectories
from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rvo.pictures import FIGURES
from muster_studies.rvo.runs import (
    ARRIVAL_M,
    CIRCLE_ARRIVAL_M,
    CIRCLE_HORIZON_S,
    CIRCLE_SHARE,
    HOLD_S,
    METHODS,
    PERTURBED,
    SHARE,
    Job,
)
from muster_studies.rvo.scenarios import misprints, scenarios, tables
from muster_studies.tables import Cell, Table

CIRCLES = {8: 10, 32: 10, 100: 3, 250: 1}
"""Robots on the circle, and with how many seeds at most."""
QUICK_CIRCLES = (8, 32)


@dataclass(frozen=True)
class Found:
    """The figures of a run."""

    robots: int
    arrived: int
    duration_s: float
    least_distance_m: float
    least_gap_m: float
    contacts: int

    @classmethod
    def of(cls, ways: Trajectories) -> Found:
        return cls(
            robots=len(ways.arrivals_s),
            arrived=int(np.isfinite(ways.arrivals_s).sum()),
            duration_s=ways.duration_s,
            least_distance_m=float(ways.least_distances_m.min()),
            least_gap_m=float(ways.least_gaps_m.min()),
            contacts=len(ways.contacts),
        )


NO_FAULT = "no fault"


def verdict(found: Sequence[Found]) -> str:
    """What went wrong in how many runs, if anything."""
    touched = sum(one.contacts > 0 for one in found)
    stuck = sum(one.arrived < one.robots for one in found)
    faults = [f"{count} of {len(found)} {what}" for count, what in ((touched, "touch"), (stuck, "stuck")) if count]
    return ", ".join(faults) or NO_FAULT


@dataclass(frozen=True)
class Published:
    """The scenarios of a published table, by all methods. RVO and HRVO have no need of chance, ORCA and AVO have."""

    number: str

    def jobs(self, effort: Effort) -> Iterator[Job]:
        for scenario in scenarios(self.number):
            for method in METHODS:
                seeds = range(effort.seed_count) if method in PERTURBED else (None,)
                yield from (Job(scenario, method, seed) for seed in seeds)

    def table(self, effort: Effort, results: Mapping[Job, Found]) -> Table:
        columns = ("scenario", "method", "runs", "arrived", "s", "least distance", "least gap", "mark")
        rows = []
        for scenario in scenarios(self.number):
            for method in METHODS:
                found = [one for job, one in results.items() if (job.subject, job.method) == (scenario, method)]
                rows.append((scenario.name, method, *_figures(found, least_distance=True), verdict(found)))
        parameters = tables()["A.18"]
        inflated = 2 * parameters["inflated_radius_m"]
        notes = (
            f"Bodies of {parameters['radius_m']} m touch at {2 * parameters['radius_m']:.2f} m between centres, "
            f"inflated ones at {inflated:.2f} m. Looked at between points of time too.",
            f"A robot is there within {ARRIVAL_M} m of its goal, for good. Two with one goal are there when they stand "
            f"beside each other and both so near to it: {inflated:.2f} m and {ARRIVAL_M} m.",
            f"The preferred velocities of ORCA and AVO are shifted by {SHARE} of their length (seeds 0 and up).",
            *misprints(self.number),
            "The thesis takes 0.16 m between centres for contact, its robots' radius; two of them touch at 0.32 m.",
        )
        return Table(self.number, tables()[self.number]["title"], columns, tuple(rows), notes, decimals=3)


@dataclass(frozen=True)
class Circle:
    """Robots on a circle that go to the opposite side."""

    number: str = "circle"

    def jobs(self, effort: Effort) -> Iterator[Job]:
        for count in self._counts(effort):
            for method in METHODS:
                yield from (Job(count, method, seed) for seed in range(min(CIRCLES[count], effort.seed_count)))

    def _counts(self, effort: Effort) -> Sequence[int]:
        return QUICK_CIRCLES if effort.quick else tuple(CIRCLES)

    def table(self, effort: Effort, results: Mapping[Job, Found]) -> Table:
        columns = ("robots", "method", "runs", "arrived", "s", "least gap", "contacts", "mark")
        rows = []
        for count in self._counts(effort):
            for method in METHODS:
                found = [one for job, one in results.items() if (job.subject, job.method) == (count, method)]
                contacts = sum(one.contacts for one in found)
                rows.append((count, method, *_figures(found), contacts, verdict(found)))
        notes = (
            "Radius 1.5 m each, at most 2 m/s; the circle has a radius of 200 m for 250 robots (on a diameter of 200 m "
            "they would overlap), and in proportion for others. A robot is there within "
            f"{CIRCLE_ARRIVAL_M} m of its goal, for good. contacts: pairs that ever overlap, over all runs.",
            f"ORCA and AVO have a horizon of {CIRCLE_HORIZON_S:.0f} s; AVO accelerates by 1 m/s^2 at most. All "
            f"preferred velocities are shifted, by {CIRCLE_SHARE} of their length.",
        )
        return Table(self.number, "Crossing circle, to the opposite side", columns, tuple(rows), notes, decimals=3)


def _figures(found: Sequence[Found], *, least_distance: bool = False) -> tuple[Cell, ...]:
    distance = (min(one.least_distance_m for one in found),) if least_distance else ()
    arrived = f"{sum(one.arrived for one in found)}/{sum(one.robots for one in found)}"
    worst_s, gap = max(one.duration_s for one in found), min(one.least_gap_m for one in found)
    return len(found), arrived, worst_s, *distance, gap if abs(gap) > _ROUNDING_M else 0.0


_ROUNDING_M = 1e-9

LEGEND = (
    "s: until the last robot of the slowest run is there, or time is up. least gap: least distance between two bodies "
    "in any run, in metres. no fault: all robots of all runs arrive, and none touches another.",
    "ORCA and AVO would wait for ever where robots meet head on, so their preferred velocities are shifted at random, "
    f"anew every {HOLD_S:.0f} s; on the circle so are those of all methods. RVO and HRVO find a side without that.",
)


_TABLES: tuple[Reproduction[Job, Found], ...] = (Published("A.17"), Published("A.22"), Circle())

RVO = Repetition(
    **description("rvo", LEGEND),
    reproductions=_TABLES,
    perform=one_by_one(lambda job: Found.of(job.perform())),
    figures=FIGURES,
)
"""Reciprocal velocity obstacles, and what came after them; Figures A.4 to A.9 and A.15 to A.17."""
