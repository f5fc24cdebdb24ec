"""The task that finds a mission's floor plan and its place on the earth."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from muster_control.work.floor_plans import floor_of
from muster_control.work.missions import mission_of


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission"}` -> `{"floor", "earth"}`: see `floor_of`, and the mission's `origin_wgs84`; None where none is."""
    mission = mission_of(arguments["mission"])
    earth = mission.origin_wgs84
    return {"floor": floor_of(mission), "earth": None if earth is None else asdict(earth)}
