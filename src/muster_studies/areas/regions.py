"""Regions over which the ways of other planners are published."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from muster.mission.texts.packaged_files import packaged_data
from muster_studies.areas.shapes import Field


@dataclass(frozen=True)
class PublishedWay:
    """A planner's way over a region, as printed: its length, and the share of the region that is seen from it."""

    way_m: float
    seen_percent: float


@dataclass(frozen=True)
class Region:
    """A region, and the ways over it; None where a planner found none."""

    name: str
    field: Field
    stc: PublishedWay
    boustrophedon: PublishedWay | None


@cache
def regions() -> tuple[Region, ...]:
    """The regions of [apostolidis2022]."""
    data = packaged_data("muster_studies.areas", "regions.yaml")
    return tuple(_region(one, data["width_m"]) for one in data["regions"])


def _region(data: Mapping[str, Any], width_m: float) -> Region:
    area, *holes = (tuple((x, y) for x, y in ring) for ring in (data["area"], *data.get("holes", ())))
    other = data.get("boustrophedon")
    return Region(
        name=str(data["region"]),
        field=Field(area, tuple(holes), width_m),
        stc=PublishedWay(**data["stc"]),
        boustrophedon=None if other is None else PublishedWay(**other),
    )
