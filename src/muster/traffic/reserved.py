"""Traffic by reservation: robots pass in the order of one plan for all, and wait where another comes first.

The plan is a sequence of straight moves (`core.PassingOrder`, [hoenig2019]). It is made anew when goals change, when
robots have come to the end of it, and when one stands that should go.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from muster import core
from muster.mission.model import Robot
from muster.motion.port import RobotPort
from muster.traffic.managed_port import ManagedPort
from muster.traffic.roadmap import MARGIN_M

AHEAD_M = 2.0
"""For how many metres a robot may have begun moves, which a new plan does not change."""
PLAN_EVERY_S = 1.0
"""The least time between two plans where nobody has a new goal."""
BROKEN_AFTER_S = 5.0
"""A robot that does not move for so long though its way is free counts as an obstacle until it moves."""
_MOVED_M = 0.05
_AT_GOAL_M = 1e-3

Point = tuple[float, float]


@dataclass(frozen=True)
class Traveller:
    """A robot for which moves are planned.

    Parameters
    ----------
    robot
        who it is.
    start
        metres, where its moves begin.
    goal
        metres, where it is to go; None: anywhere.
    heading_rad
        at its start.
    ready_s, hold_s
        seconds for which it stays at its start, and at its goal.
    stays
        whether it stays at its goal for good; else it leaves then.
    fixed
        whether it stays at its start in any case.
    """

    robot: Robot
    start: Point
    goal: Point | None
    heading_rad: float = 0.0
    ready_s: float = 0.0
    hold_s: float = 0.0
    stays: bool = True
    fixed: bool = False


class Move(NamedTuple):
    """A straight move of a traveller, by its number among all, to a place in metres; `leaves`: away from its goal."""

    traveller: int
    to: Point
    leaves: bool = False


Planner = Callable[[Sequence[Traveller]], Iterable[Move]]
"""Moves of travellers, in an order in which each is free while the others stand."""


@dataclass
class _Part:
    """A robot in traffic."""

    robot: Robot
    port: ManagedPort
    number: int
    moves_passed: int = 0  # ends of moves, by the orders before the last
    ends: int = 0  # how many of the places of the last order are ends of moves
    goal: Point | None = None  # by the last plan
    arrives: bool = False  # whether it has something to do there, by the last plan
    to_go: bool = False  # whether it has been let go further than where it is
    stood: Point = (0.0, 0.0)
    moved_s: float = -math.inf  # when it last moved, or had no reason to
    broken: bool = False

    @property
    def near(self) -> Point:
        said = self.port.heard
        return _planar(said.position) if said is not None else self.stood


@dataclass
class ReservedTraffic:
    """A `TrafficManager` whose robots pass in the order of one plan.

    Parameters
    ----------
    plan
        plans moves of all robots.
    margin_m
        what is left between two robots that pass.
    """

    plan: Planner
    plans: int = 0
    margin_m: float = MARGIN_M
    _order: core.PassingOrder = field(init=False)
    _waiting: list[tuple[Robot, ManagedPort]] = field(default_factory=list)  # for their first telemetry
    _parts: list[_Part] = field(default_factory=list)
    _planned_s: float = -math.inf

    def __post_init__(self) -> None:
        self._order = core.PassingOrder(margin=self.margin_m, ahead=AHEAD_M)

    def managed(self, robot: Robot, port: RobotPort) -> RobotPort:
        """The port by which a robot is ordered; the port itself where no other that drives can run into it."""
        if robot.radius_m <= 0 or robot.kind != "ground":
            return port
        managed = ManagedPort(port)
        self._waiting.append((robot, managed))
        return managed

    def look(self, now: float) -> None:
        """See how far robots are, plan anew where that is due, and send robots on."""
        self._take_in(now)
        for part in self._parts:
            self._order.progress(part.number, part.moves_passed + min(part.port.marks_passed, part.ends), part.near)
        self._watch(now)
        if self._plan_is_due(now):
            self._plan_anew(now)
        for part in self._parts:
            self._let_go(part)

    def _take_in(self, now: float) -> None:
        """Robots that have said where they are take part."""
        silent = []
        for robot, port in self._waiting:
            said = port.heard
            if said is None:
                silent.append((robot, port))
                continue
            place = _planar(said.position)
            number = self._order.add(place, robot.radius_m)
            self._parts.append(_Part(robot, port, number, stood=place, moved_s=now))
            self._planned_s = -math.inf
        self._waiting = silent

    def _watch(self, now: float) -> None:
        """A robot that does not move though it may stands in the way of the others, until it moves."""
        for part in self._parts:
            moved = math.dist(part.near, part.stood) > _MOVED_M
            if moved or not part.to_go or part.port.busy:
                part.stood, part.moved_s = part.near, now
            broken = part.to_go and now - part.moved_s > BROKEN_AFTER_S
            if broken != part.broken and (broken or moved):
                part.broken = broken
                self._order.cut()
                self._planned_s = -math.inf

    def _plan_is_due(self, now: float) -> bool:
        if any((self._goal(part), part.port.arrives) != (part.goal, part.arrives) for part in self._parts):
            return True
        if now - self._planned_s < PLAN_EVERY_S:
            return False
        return any(self._falls_short(part) for part in self._parts)

    def _falls_short(self, part: _Part) -> bool:
        """Whether the moves of a robot end before its goal, and it is coming near to where they end."""
        away = self._away_m(part) > _AT_GOAL_M
        return away and not part.broken and self._order.metres_left(part.number) < 2 * AHEAD_M

    def _goal(self, part: _Part) -> Point | None:
        goal = part.port.goal
        return None if goal is None else _planar(goal)

    def _plan_anew(self, now: float) -> None:
        self._planned_s, self.plans = now, self.plans + 1
        self._order.drop_ahead()
        travellers = []
        for part in self._parts:
            part.goal, part.arrives = self._goal(part), part.port.arrives
            self._find_again(part)
            travellers.append(self._traveller(part))
        stopped = set[int]()
        for traveller, to, leaves in self.plan(travellers):
            if traveller not in stopped and not self._order.append(self._parts[traveller].number, to, leaves):
                stopped.add(traveller)

    def _find_again(self, part: _Part) -> None:
        """A robot that is to go on stands where it is now said to be: first words may err, and robots are pushed."""
        to_go_on = part.goal is None or self._away_m(part) > _AT_GOAL_M
        if to_go_on and not part.port.busy and math.dist(self._order.end(part.number), part.near) > _MOVED_M:
            self._order.stands(part.number, part.near)

    def _traveller(self, part: _Part) -> Traveller:
        said, hold_s = part.port.heard, part.port.hold_s
        return Traveller(
            robot=part.robot,
            start=self._order.end(part.number),
            goal=part.goal,
            heading_rad=0.0 if said is None else said.heading,
            ready_s=hold_s if part.port.busy else 0.0,
            hold_s=0.0 if part.port.busy else hold_s,
            stays=not part.port.arrives,
            fixed=part.broken,
        )

    def _let_go(self, part: _Part) -> None:
        """Send a robot as far as it may go."""
        if part.port.busy:
            part.port.waits_for, part.to_go = "", False
            return
        grant = self._order.grant(part.number)
        part.to_go = grant.metres > _MOVED_M
        part.port.left_m = self._order.metres_left(part.number) + self._away_m(part)
        part.port.waits_for = self._held_up_by(part, grant)
        to_goal = grant.last and part.port.arrives and self._away_m(part) <= _AT_GOAL_M
        if grant.points or to_goal:
            said = part.port.heard
            height = said.position[2] if said is not None else 0.0
            if part.port.go([(x, y, height) for x, y in grant.points], to_goal=to_goal):
                part.moves_passed = self._order.passed(part.number)
            part.ends = part.port.marks_passed + grant.ended  # an order that was cut ends with a move

    def _away_m(self, part: _Part) -> float:
        """Metres from where the moves of a robot end to its goal; 0 without one."""
        return 0.0 if part.goal is None else math.dist(self._order.stand(part.number), part.goal)

    def _held_up_by(self, part: _Part, grant: core.Grant) -> str:
        """The robot that comes first, or stands next to one that has found no way; empty where nobody holds it up."""
        if grant.waits_for >= 0:
            return self._parts[grant.waits_for].robot.id
        return self._nearest(part) if self._falls_short(part) and not grant.points else ""

    def _nearest(self, part: _Part) -> str:
        """The robot next to one that has found no way."""
        others = [other for other in self._parts if other is not part]
        return min(others, key=lambda other: math.dist(other.near, part.near)).robot.id if others else ""


def _planar(place: Sequence[float]) -> Point:
    return (place[0], place[1])
