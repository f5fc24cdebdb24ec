"""The published tables of section 6.1, as in the library, and the flights that repeat them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from typing import Any

from muster.library import published
from muster.simulation import NO_NOISE, Noise
from muster_studies.effort import Effort
from muster_studies.runs import mission_named
from muster_studies.thesis_6.published import PublishedPlan, plans
from muster_studies.thesis_6_1.flights import Flight

THIRTY, SIX = "16T-3R-tags", "six-tags"
"""The missions of the two flights."""

NOISE = Noise(position_m=0.03, heading_rad=math.radians(1), attitude_rad=math.radians(1))
STRONG_NOISE = Noise(position_m=0.1, heading_rad=math.radians(3), attitude_rad=math.radians(3))
"""With which raw estimates scatter by 0.3 m, and form the elongated patterns of Figure 6.4."""

SEEDS, QUICK_SEEDS = 3, 1
"""Of flights with noise."""

Truth = Mapping[str, tuple[float, float]]


@cache
def points() -> Mapping[str, Any]:
    """The published tables of tags."""
    found: Mapping[str, Any] = published("tcf-points-of-interest")["tables"]
    return found


def tags(number: str) -> Mapping[str, Mapping[str, Any]]:
    """The rows of Table 6.4 or 6.5, by tag."""
    return {str(row["tag"]): row for row in points()[number]["tags"]}


def truth(number: str) -> Truth:
    """Where the tags of Table 6.4 or 6.5 are, metres."""
    return {tag: (row["truth"][0], row["truth"][1]) for tag, row in tags(number).items()}


def seed_count(effort: Effort) -> int:
    """How often a flight with noise is flown."""
    return effort.seeds or (QUICK_SEEDS if effort.quick else SEEDS)


@cache
def flown_plan() -> PublishedPlan:
    """The plan of Table 6.2 that the thesis carried out."""
    (plan,) = (plan for plan in plans("6.2") if plan.usages("gazebo"))
    return plan


def thirty(plan: PublishedPlan | None = None, **how: Any) -> Flight:
    """A plan of Table 6.2 carried out among the tags of Table 6.4; by default the one that the thesis carried out."""
    plan = plan or flown_plan()
    return Flight(mission=THIRTY, routes=plan.sequences, ignored=plan.ignored, **how)


def six(**how: Any) -> Flight:
    """The flight of Table A.10."""
    mission = mission_named(SIX)
    tasks = tuple(task.id for task in mission.tasks)
    return Flight(mission=SIX, routes=((mission.robots[0].id, tasks),), **how)


FLIGHTS = {"6.4": thirty, "6.5": six}
"""By table of tags."""


def noisy(number: str, effort: Effort, world: str) -> list[Flight]:
    """The flight of a table of tags with noise, with all seeds."""
    return [FLIGHTS[number](world=world, noise=NOISE, seed=seed) for seed in range(seed_count(effort))]


def calm(number: str, world: str) -> Flight:
    """The flight of a table of tags without noise."""
    return FLIGHTS[number](world=world, noise=NO_NOISE)
