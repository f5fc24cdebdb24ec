"""The published scenarios, and the crossing circle, as crowds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from muster.library import as_corrected, as_printed, published
from muster.motion.avoidance import Crowd
from muster_studies.misprints import errata

CIRCLE_ROBOTS, CIRCLE_RADIUS_M = 250, 200.0
BODY_RADIUS_M, TOP_SPEED_MPS = 1.5, 2.0


@cache
def tables() -> Mapping[str, Any]:
    """The published tables of both appendices."""
    found: Mapping[str, Any] = published("tcf-avoidance")["tables"]
    return found


@dataclass(frozen=True)
class Scenario:
    """One column of a published table: where robots start, and where they go."""

    table: str
    number: str
    side: str = ""
    """`as printed` or `as corrected`, where that makes a difference."""

    @property
    def name(self) -> str:
        return f"{self.number} {self.side}".rstrip()

    @property
    def robots(self) -> Mapping[str, Mapping[str, Any]]:
        """By robot its start and goal, (x, y) in metres."""
        take = as_corrected if self.side == "as corrected" else as_printed
        found: Mapping[str, Mapping[str, Any]] = take(tables()[self.table]["scenarios"][self.number])
        return found

    def crowd(self) -> Crowd:
        """The robots with the radii and the speed of Table A.18; those of Table A.22 are of the same kind."""
        parameters, rows = tables()["A.18"], list(self.robots.values())
        return Crowd(
            starts=np.array([row["start"] for row in rows], dtype=np.float64),
            goals=np.array([row["goal"] for row in rows], dtype=np.float64),
            radii=np.full(len(rows), parameters["radius_m"]),
            inflated_radii=np.full(len(rows), parameters["inflated_radius_m"]),
            max_speeds=np.full(len(rows), parameters["max_speed_mps"]),
        )


def scenarios(table: str) -> Iterator[Scenario]:
    """Those of one table; one with a misprint twice."""
    for number, robots in tables()[table]["scenarios"].items():
        misprinted = any(list(errata(robot)) for robot in robots.values())
        for side in ("as printed", "as corrected") if misprinted else ("",):
            yield Scenario(table, number, side)


def misprints(table: str) -> Iterator[str]:
    """What is wrong in a table, and how it is read."""
    for number, robots in tables()[table]["scenarios"].items():
        for robot, row in robots.items():
            for text in errata(row):
                yield f"Scenario {number}, {robot}: {text}."


def circle(count: int) -> Crowd:
    """Robots on a circle that go to the opposite side; 250 of them on a radius of 200 m, others in proportion."""
    angles = 2 * np.pi * np.arange(count) / count
    starts = CIRCLE_RADIUS_M * count / CIRCLE_ROBOTS * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return Crowd(
        starts=starts,
        goals=-starts,
        radii=np.full(count, BODY_RADIUS_M),
        max_speeds=np.full(count, TOP_SPEED_MPS),
    )
