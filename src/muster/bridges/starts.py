"""A mission begins where its robots are, not where its file says: their own poses for its starts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from muster.mission.model import Mission, Robot
from muster.motion.port import RobotPort

ELSEWHERE_M = 0.5
"""A robot that stands farther from where the mission says is told of."""


def from_where_they_stand(mission: Mission, ports: Mapping[str, RobotPort]) -> tuple[Mission, tuple[str, ...]]:
    """The mission with the robots' own places and headings, and a line for each that stands elsewhere than it says.

    All robots of the mission must have said where they are.
    """
    robots, remarks = [], []
    for robot in mission.robots:
        said = ports[robot.id].telemetry()
        assert said is not None
        there = replace(
            robot, position=said.position[: mission.dimensions], heading_deg=round(math.degrees(said.heading), 3)
        )
        robots.append(there)
        remarks += _elsewhere(robot, there)
    return replace(mission, robots=tuple(robots)), tuple(remarks)


def _elsewhere(planned: Robot, there: Robot) -> list[str]:
    far = math.dist(planned.position[: len(there.position)], there.position)
    if far <= ELSEWHERE_M:
        return []
    begins, says = (", ".join(f"{c:.2f}" for c in robot.position) for robot in (there, planned))
    return [f"robot {planned.id} stands at ({begins}), {far:.2f} m from ({says}) of the mission, and begins there"]
