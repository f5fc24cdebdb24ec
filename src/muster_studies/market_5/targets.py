"""Survivors found by lasers: rangeBot's own (Figure 7), and all by the whole team."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from typing import Any

from muster.perception.matching import ErrorTable
from muster_studies.effort import Effort
from muster_studies.market_5.arena import CYLINDER_RADIUS_M, SCANNER, SURVIVORS
from muster_studies.market_5.searches import (
    FARTHEST_M,
    LANDMARKED,
    LEAST,
    SCAN_S,
    Search,
    SearchResult,
    found_by_world,
    searches,
)
from muster_studies.rescue.metrics import SHOWN_ROBOT
from muster_studies.tables import Cell, Table, row

NOBODY = "none of them"


def error_of(found: ErrorTable, survivor: str) -> float | None:
    """The error of a survivor's estimated position, metres; None where it was not found."""
    return next((match.error_m for match in found.matches if match.name == survivor), None)


def single_errors(one: SearchResult, survivor: str, robot: str | None = None) -> list[float]:
    """Metres that each sighting of a survivor is off."""
    return [math.dist(seen.place.mean, SURVIVORS[survivor]) for seen in one.sightings(survivor, robot)]


@dataclass(frozen=True)
class Figure7:
    """How well rangeBot localises the survivor that is its own, alone and with the team."""

    number: str = "Figure 7"
    columns: tuple[str, ...] = ("world", "seed", "survivor", "sightings", "each m", f"{SHOWN_ROBOT} m", "team m")

    def jobs(self, effort: Effort) -> Iterator[Search]:
        yield from searches(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        rows = []
        for job in searches(effort):
            cells = {"world": job.world, "seed": job.seed, **_own_survivor(results[job])}
            rows.append(row(self.columns, cells))
        notes = (
            "The paper names its accuracy of target localisation as a metric (4.2), and shows a picture; it prints no "
            "number. --plot DIR draws ours.",
            f"Each {SCAN_S} s a scan of {len(SCANNER.bearings)} beams, ranges off by {SCANNER.range_m} m (standard "
            "deviation), ours. each m: mean error of single sightings; then of all that the robot saw, and that all "
            "three saw, weighed by what each can know.",
        )
        title = f"The survivor that {SHOWN_ROBOT} localises by SPIKE"
        return Table(self.number, title, self.columns, tuple(rows), notes, decimals=4)


def _own_survivor(one: SearchResult) -> dict[str, Cell]:
    survivor = one.flown[LANDMARKED].visits[SHOWN_ROBOT][-1].task
    single = single_errors(one, survivor, SHOWN_ROBOT)
    return {
        "survivor": survivor,
        "sightings": len(single),
        "each m": fmean(single) if single else None,
        f"{SHOWN_ROBOT} m": error_of(one.found([SHOWN_ROBOT]), survivor),
        "team m": error_of(one.found(), survivor),
    }


@dataclass(frozen=True)
class Targets:
    """Which survivors the team finds, when, and how far off."""

    number: str = "Targets"

    def jobs(self, effort: Effort) -> Iterator[Search]:
        yield from searches(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        rows = []
        for world, found in found_by_world(effort, results):
            rows += [{"world": world, "survivor": name, **_cells(found, name)} for name in SURVIVORS]
            elsewhere = sum(len(one.found().extra) for one in found)
            rows.append({"world": world, "survivor": NOBODY, "found": str(elsewhere)})
        notes = (
            f"Survivors are cylinders of {2 * CYLINDER_RADIUS_M} m, unknown to the robots. Found is what was seen "
            f"{LEAST} times within centimetres, {FARTHEST_M} m from a survivor at most; {NOBODY}: found where nothing "
            "is. first s: mean of when it was first seen. Robots go to known places, as the paper's do, by odometry "
            "with landmarks; what they find does not change the plan.",
        )
        return Table.of_cells(self.number, "Survivors that the team finds", rows, notes, decimals=4)


def _cells(found: Sequence[SearchResult], survivor: str) -> dict[str, Cell]:
    errors = [error for one in found if (error := error_of(one.found(), survivor)) is not None]
    seen = [sightings for one in found if (sightings := one.sightings(survivor))]
    single = [error for one in found for error in single_errors(one, survivor)]
    return {
        "found": f"{len(errors)}/{len(found)}",
        "first by": tuple(sorted({sightings[0].robot for sightings in seen})),
        "first s": fmean(sightings[0].time_s for sightings in seen) if seen else None,
        "sightings": sum(map(len, seen)),
        "each m": fmean(single) if single else None,
        "team m": fmean(errors) if errors else None,
        "team most m": max(errors, default=None),
    }
