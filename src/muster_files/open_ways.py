"""The gate of exports: no way that is written, drones at their heights, enters an area that is closed to its robot."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from muster.execution.reports.itinerary import Itinerary
from muster.mission.errors import Finding, PlanError
from muster.mission.model import Mission
from muster.verification.closed_areas import ClosedAreas


def require_open_itineraries(mission: Mission, team: Sequence[Itinerary]) -> None:
    """Raise unless every piece of every way keeps out of closed areas.

    A plan that is admissible at the heights of its mission may not be at heights that the options of an export give.

    Raises
    ------
    PlanError
        that names the robot, the leg and the zone.
    """
    areas = ClosedAreas(mission)
    for itinerary in team:
        for before, after in pairwise(itinerary.passages):
            points = [passage.place[: mission.dimensions] for passage in (before, after)]
            found = areas.obstacle(itinerary.robot, *points)
            if found is not None:
                leg = " to ".join(f"({', '.join(f'{c:g}' for c in point)})" for point in points)
                expected = "heights at which the way stays outside of closed areas, or another plan"
                subject = f"{itinerary.robot.id}, {after.task or 'way point'}, the leg from {leg} {found}"
                raise PlanError([Finding("<plan>", None, "closed-area", subject, expected)])
