"""A task or station with `only_robots` is for those robots alone."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Mission, Robot, Station, Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute, Service
from muster.verification.rules.pair_rule import PairRule
from muster.verification.verdict import Violation


class Lock(PairRule):
    """The robot is one of `only_robots` of each task that it does and each station where it calls."""

    kind = "lock"

    def refusal(self, mission: Mission, robot: Robot, task: Task) -> str | None:
        return _refusal(robot, task)

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        """Yield a violation for each task that the robot may not do, and for each call at a station closed to it."""
        yield from super().violations(case, route)
        for stop in route.stops:
            refusal = _refusal(route.robot, stop.station) if isinstance(stop, Service) else None
            if refusal is not None:
                yield Violation(self.kind, route.robot.id, None, f"calls at {stop.place_id}, {refusal}")


def _refusal(robot: Robot, place: Task | Station) -> str | None:
    if place.only_robots is None or robot.id in place.only_robots:
        return None
    return f"only for {', '.join(place.only_robots)}"
