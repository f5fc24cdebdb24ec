"""The floor plan of a mission: the image among its files, with resolution and origin."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from muster.mission.errors import MissionError
from muster.mission.model import Mission
from muster.motion.maps.ros_yaml import read_ros_map


def floor_of(mission: Mission) -> dict[str, Any] | None:
    """`{"file", "resolution_m", "origin"}`; None if there is no image, or its description cannot be read.

    `work.missions.mission_of` must have written the mission's files.
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
    """The normalised file name; the origin's yaw is 0 by default."""
    return {"file": os.path.normpath(picture), "resolution_m": resolution_m, "origin": [*origin, 0.0, 0.0, 0.0][:3]}
