"""No leg and no work enters an area that is closed to the robot."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.closed_legs import CLOSED_AREA, closed_legs
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class ClosedArea:
    """Robots keep out of zones that are closed to them, and inside the boundary. It cannot be ignored."""

    kind = CLOSED_AREA
    ignorable = False

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        """Yield a violation for each leg, work and end that enters a closed area."""
        yield from closed_legs(case.mission, case.travel.areas, route.robot, route.planned)

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Return False: that a leg does not exist is the rule `unreachable`'s to say."""
        return False
