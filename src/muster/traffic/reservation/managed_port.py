"""The port of a robot that traffic steers: what it is ordered becomes goals, and it is sent as far as it may go."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby, pairwise, takewhile

from muster.motion.outlook import Visit
from muster.motion.port import Place, RobotPort, Telemetry, Waypoint, planar

_STRAIGHT_M = 0.01


class ManagedPort:
    """A `RobotPort` between who orders a robot and the robot.

    Way points that only mark a way are left to traffic; the others are its goals, one after the other. Several at one
    place, one after the other, are one goal.

    Parameters
    ----------
    port
        of the robot.
    """

    def __init__(self, port: RobotPort) -> None:
        self._port = port
        self._orders = 0
        self._waypoints: tuple[Waypoint, ...] = ()
        self._passed = 0  # of these, by the orders to the robot before the last
        self._sent: tuple[Waypoint, ...] | None = None  # None: to be sent anew in any case
        self._sent_order = 0
        self._marks = 0  # how many of those sent come before what is to be done at the goal
        self._numbers: tuple[int, ...] = ()  # of the others, among the way points
        self._broken_off: list[Place] = []  # where it was on its way to when it was last stopped
        self.waits_for = ""
        self.left_m: float | None = None
        self.refused = ""

    @property
    def robot(self) -> str:
        return self._port.robot

    @property
    def orders(self) -> int:
        """How many orders it has got so far."""
        return self._orders

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """See `RobotPort`. The robot is sent on when traffic next looks."""
        self._orders += 1
        self._break_off()
        self._waypoints, self._passed, self._numbers = tuple(waypoints), 0, ()
        self.waits_for, self.left_m, self.refused = "", None, ""
        return self._orders

    def cancel(self) -> int:
        """See `RobotPort`. The robot stops at once; where it stands in the way traffic sends it on a little."""
        self._break_off()
        self._sent_order, self._marks = self._port.cancel(), 0
        return self.send(())

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        said = self._port.telemetry()
        if said is None:
            return None
        return replace(
            said,
            order=self._orders,
            passed=self.passed,
            refused=self.refused or said.refused,
            waits_for=self.waits_for,
            left_m=self.left_m,
        )

    @property
    def heard(self) -> Telemetry | None:
        """What the robot itself last said."""
        return self._port.telemetry()

    @property
    def passed(self) -> int:
        """How many way points of its order are passed."""
        done = self._sent_passed - self._marks
        return self._numbers[done - 1] + 1 if done > 0 and self._numbers else self._passed

    @property
    def goal(self) -> Place | None:
        """Where it is to go next, or stay; None where it may be anywhere."""
        numbers = self._next()
        if numbers:
            return self._waypoints[numbers[0]].position
        return self._waypoints[-1].position if self._waypoints else None

    @property
    def arrives(self) -> bool:
        """Whether something is to be done at its goal."""
        return bool(self._next())

    @property
    def visits(self) -> list[Visit]:
        """Where its order leads, its goal first."""
        left = [point for point in self._waypoints[self.passed :] if not point.via]
        groups = (list(group) for _, group in groupby(left, key=lambda point: point.position))
        return [Visit(group[0].position, sum(point.hold_s for point in group)) for group in groups]

    @property
    def busy(self) -> bool:
        """Whether the robot does something at its goal: it is not to be sent elsewhere."""
        return bool(self._numbers) and self._sent_passed < self._marks + len(self._numbers) and self._at_goal

    @property
    def at_work(self) -> bool:
        """Whether the robot is busy by its own account: it has taken the order to be."""
        return self.busy and self._said is not None

    @property
    def marks_passed(self) -> int:
        """How many of the places are passed to which it was last sent, its goal not counted."""
        return min(self._marks, self._sent_passed)

    def go(self, way: Sequence[Waypoint], *, to_goal: bool = False) -> bool:
        """Send the robot along a way, and let it do at its end what is to be done at its goal.

        Without a way it does that where its goal is. Returns whether that is another order than the last.
        """
        numbers = self._next() if to_goal else ()
        at = [replace(self._waypoints[k], position=way[-1].position) if way else self._waypoints[k] for k in numbers]
        sent = (*way, *at)
        if self._sent is not None and sent == self._sent[self._sent_passed :]:
            return False
        self._passed = self.passed
        self._sent, self._marks, self._numbers = sent, len(way), numbers
        self._sent_order = self._port.send(sent)
        return True

    def has_come(self, way: Sequence[Waypoint]) -> bool:
        """Whether a way leads only to where the robot has come by its last order, which had nothing to do there."""
        sent = self._sent or ()
        return bool(sent) and not self._numbers and self._sent_passed >= len(sent) and sent[-1:] == tuple(way)

    def added_m(self, way: Sequence[Waypoint]) -> float | None:
        """Return by how many metres a way leads farther than what is left of the last order; None if it differs."""
        said = self._said
        left = () if self._sent is None or self._numbers else self._sent[self._sent_passed :]
        if said is None or not left or len(way) < len(left) or tuple(way[: len(left) - 1]) != left[:-1]:
            return None
        before = planar(left[-2].position if len(left) > 1 else said.position)
        end, beyond = planar(left[-1].position), [planar(waypoint.position) for waypoint in way[len(left) - 1 :]]
        first_m = math.dist(end, beyond[0])
        detour_m = math.dist(before, end) + first_m - math.dist(before, beyond[0])
        if detour_m > _STRAIGHT_M or left[-1].speed_mps != way[len(left) - 1].speed_mps:
            return None
        return first_m + sum(math.dist(a, b) for a, b in pairwise(beyond))

    @property
    def sent_ahead(self) -> list[Place]:
        """The places to which it was last sent and has not said to have come; after a stop those before it."""
        if self._sent is None:
            return self._broken_off
        return [waypoint.position for waypoint in self._sent[self._sent_passed :]]

    def halt(self) -> None:
        """Let the robot stop where it is until it is sent on."""
        self._passed = self.passed
        self._sent, self._marks, self._numbers = (), 0, ()
        self._sent_order = self._port.cancel()

    def _break_off(self) -> None:
        self._broken_off, self._sent = self.sent_ahead, None

    def _next(self) -> tuple[int, ...]:
        """The numbers of the next way points at one place that are no marks."""
        left = [k for k in range(self.passed, len(self._waypoints)) if not self._waypoints[k].via]
        return tuple(takewhile(lambda k: self._waypoints[k].position == self._waypoints[left[0]].position, left))

    @property
    def _at_goal(self) -> bool:
        return self._sent_passed >= self._marks

    @property
    def _sent_passed(self) -> int:
        return 0 if self._said is None else self._said.passed

    @property
    def _said(self) -> Telemetry | None:
        """What the robot last said, if that is of the order that it was last sent."""
        said = self._port.telemetry()
        return said if said is not None and said.order == self._sent_order else None
