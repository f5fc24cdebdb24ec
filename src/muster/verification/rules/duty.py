"""From leaving its start to the end of its route a robot is under way for no longer than its longest duty."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Mission
from muster.verification.measure import MeasuredRoute
from muster.verification.rules.span_rule import Span, SpanRule


class Duty(SpanRule):
    """A route ends, the way to its end included, at most `longest_duty_s` after the robot leaves its start."""

    kind = "duty"

    def is_in(self, mission: Mission) -> bool:
        return any(robot.longest_duty_s is not None for robot in mission.robots)

    def spans(self, route: MeasuredRoute) -> Iterator[Span]:
        most = route.robot.longest_duty_s
        if most is not None:
            said = "its duty, from leaving its start to the end of its route,"
            yield Span(self.kind, route.robot.id, None, None, most, said)
