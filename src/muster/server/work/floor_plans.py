"""The floor plan of a mission: its picture among the mission's files, and how it lies."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from muster.mission.errors import MissionError
from muster.mission.model import Mission
from muster.motion.maps.ros_yaml import read_ros_map


def floor_of(mission: Mission) -> dict[str, Any] | None:
    """`{"file", "resolution_m", "origin"}`; None where there is no picture, or what describes it cannot be read.

    The mission's files are where `work.missions.mission_of` has laid them.
    """
    chart = mission.map
    if chart is None:
        return None
    if chart.ros_yaml is not None:
        try:
            described = read_ros_map(Path(chart.ros_yaml))
        except MissionError:
            return None
        picture = Path(chart.ros_yaml).parent / described.image
        return _floor(picture, described.resolution, described.origin)
    if chart.image is None or chart.resolution_m is None:
        return None
    return _floor(Path(chart.image), chart.resolution_m, chart.origin or ())


def _floor(picture: Path, resolution_m: float, origin: tuple[float, ...]) -> dict[str, Any]:
    """The file's name without detours, as files are kept; the origin's yaw is 0 where it is not given."""
    return {"file": os.path.normpath(picture), "resolution_m": resolution_m, "origin": [*origin, 0.0, 0.0, 0.0][:3]}
