"""The robots that the system monitor hears, as robots of a mission: [tcf-thesis], section 5.2, has no others."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from muster.mission.errors import MusterError
from muster.mission.model import Robot
from muster.mission.yaml_writer import plain
from muster_robots.custody_settings import CustodySettings
from muster_robots.ros1.parameter_descriptions import robot_from_parameters

_SILENT_S = CustodySettings.link_lost_s


def robots_heard(
    rows: Sequence[Mapping[str, Any]], topics: Callable[[str], str], dimensions: int
) -> list[dict[str, Any]]:
    """Robots where they stand, each as it describes itself on the parameter server.

    Parameters
    ----------
    rows
        what `system_monitor/robots` says.
    topics
        the namespace of a robot's topics.
    dimensions
        coordinates of a position.

    Raises
    ------
    MusterError
        if none is heard, or a description is wrong.
    """
    present = [row for row in rows if row["position"] is not None and row["heard_ago_s"] <= _SILENT_S]
    if not present:
        raise MusterError("robots: none; expected some in the mission, or some that publish odom or pose")
    return [_described(row, topics, dimensions) for row in present]


def _described(row: Mapping[str, Any], topics: Callable[[str], str], dimensions: int) -> dict[str, Any]:
    name = row["robot"]
    stands = Robot(
        id=name, position=tuple(row["position"][:dimensions]), heading_deg=math.degrees(row["heading"] or 0.0)
    )
    described: dict[str, Any] = plain(robot_from_parameters(topics(name), stands))
    return described
