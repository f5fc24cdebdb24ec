"""Traffic by reservation: robots pass in the order of one plan for all, and wait where another comes first.

The plan is a sequence of straight moves (`core.PassingOrder`, [hoenig2019]) by which robots get to several stops, one
after the other. It is made anew when robots are sent elsewhere than was planned, when they have come near to the end of
it, and when one stands that should go.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from muster import core
from muster.mission.model import Robot
from muster.motion.kinematics.registry import limits_of
from muster.motion.outlook import Outlook
from muster.motion.port import Place, RobotPort, Waypoint, planar
from muster.traffic.journeys.travellers import PlannedMoves, Planner, Stop, Traveller
from muster.traffic.names import drives
from muster.traffic.reservation.managed_port import ManagedPort
from muster.traffic.reservation.part import Part
from muster.traffic.reservation.plan_request import AT_GOAL_M, LEAST_STOPS, MOVED_M, PlanRequest
from muster.traffic.reservation.planning import DelayedPlanning, Planning
from muster.traffic.roadmaps.roadmap import MARGIN_M

AHEAD_M = 2.0
"""For how many metres a robot may have begun moves, which a new plan does not change."""
PLAN_EVERY_S = 1.0
"""The least time between two plans where nobody has a new goal."""
INCOMPLETE_FOR_S = 10.0
"""The greatest time for which an incomplete plan holds, as long as robots have moves of it left and no complete plan is
found."""
NOTICE_S = 0.5
"""A robot that has done what it was to do is told within this time where to go next."""
NO_PROGRESS_S = 5.0
"""A robot that does not move for so long though its way is free counts as an obstacle until it moves."""
RETRY_S = 6.0
"""So long after that it is told anew where to go: it may have dropped its order."""
MOST_TRIES = 4
"""So often that time is doubled for one that has no goal."""
NO_ROOM_AFTER = 2
"""One that has nothing to do, and was told anew so often, does not move at all."""
NO_WAY_S = 10.0
"""After so long without a way a robot is told where no way leads at all, whoever stands in it."""
NEEDED_S, EXTENDED_S, EXTENDED_M = 1.0, 2.0, 0.5
"""A real robot is sent farther along its way when what is left of its order lasts for less than braking and the first
of these times. Behind another robot it is sent on by at least the distance, or what it drives in the second time, or
after that time: each order may make its navigation plan anew."""
AHEAD_S = 4.0
"""For how many seconds of driving a real robot may have begun moves, if that is farther than `AHEAD_M`."""
_NEVER_S = -math.inf


@dataclass
class ReservedTraffic:
    """A `TrafficManager` whose robots pass in the order of one plan.

    Parameters
    ----------
    plan
        plans moves of all robots.
    margin_m
        what is left between two robots that pass.
    lanes
        on which only so many may be at once.
    ahead_m
        for how many metres a robot may have begun moves, which a new plan does not change.
    sparing
        whether an order that only leads farther along the same way waits until the robot needs it.
    planning
        makes one plan at a time.
    """

    plan: Planner
    plans: int = 0
    margin_m: float = MARGIN_M
    lanes: Sequence[core.LimitedLane] = ()
    ahead_m: float = AHEAD_M
    sparing: bool = False
    planning: Planning = field(default_factory=DelayedPlanning)
    _order: core.PassingOrder = field(init=False)
    _waiting: list[tuple[Robot, ManagedPort]] = field(default_factory=list)  # for their first telemetry
    _parts: list[Part] = field(default_factory=list)
    _planned_s: float = _NEVER_S  # what was planned does not hold any more
    _sought_s: float = -math.inf  # when a plan was last sought
    _travellers: list[Traveller] = field(default_factory=list)  # of the last plan
    _last: PlannedMoves = PlannedMoves()
    _request: PlanRequest | None = None  # for a plan that is being made
    _closed: frozenset[str] = frozenset()  # doors
    _outlook: Callable[[str], Outlook] = field(default=lambda robot: Outlook(stays=True))

    def __post_init__(self) -> None:
        self._order = core.PassingOrder(margin=self.margin_m, ahead=self.ahead_m, lanes=self.lanes)

    def managed(self, robot: Robot, port: RobotPort) -> RobotPort:
        """The port by which a robot is ordered; the port itself where no other that drives can run into it."""
        if not drives(robot):
            return port
        managed = ManagedPort(port)
        self._waiting.append((robot, managed))
        return managed

    def expect(self, outlook: Callable[[str], Outlook]) -> None:
        """See `TrafficManager`."""
        self._outlook = outlook

    def close(self, doors: Collection[str]) -> None:
        """See `TrafficManager`. Robots that were let go through one that closes are stopped."""
        self.plan.close(doors)
        self._closed = frozenset(doors)
        self._forget_plan()
        for part in self._parts:
            radius_m = part.robot.radius_m
            if not all(self.plan.is_open(np.array(piece), radius_m) for piece in part.pieces_ahead()):
                part.port.halt()
                self._forget_way(part)

    def moved(self, robot: str) -> None:
        """See `TrafficManager`. Others keep off the place where it is now."""
        for part in self._parts:
            if part.robot.id == robot:
                part.port.halt()
                self._forget_way(part)

    def reaches(self, robot: str, places: Sequence[Place]) -> list[bool]:
        """See `TrafficManager`."""
        for part in self._parts[: len(self._travellers)]:
            if part.robot.id == robot:
                return self.plan.reaches(self._travellers, part.number, [planar(place) for place in places])
        return [True for _ in places]

    def makes_no_room(self, robot: str) -> bool:
        """See `TrafficManager`."""
        found = (part for part in self._parts if part.robot.id == robot)
        return any(part.broken and part.tried >= NO_ROOM_AFTER for part in found)

    def look(self, now: float) -> None:
        """See how far robots are, plan anew where that is due, and send robots on."""
        self._take_in(now)
        for part in self._parts:
            part.outlook = self._outlook(part.robot.id)
            self._order.progress(part.number, part.moves_passed + min(part.port.marks_passed, part.ends), part.near)
            self._lead_on(part, now)
        self._watch(now)
        self._take_plan(now)
        if self._request is None and self._plan_is_due(now):
            self._ask_for_plan(now)
        elif self._request is None and now - self._sought_s >= PLAN_EVERY_S and self._keeps_to_incomplete(now):
            self._ask_for_plan(now, only_complete=True)
        self._take_plan(now)
        for part in self._parts:
            self._let_go(part, now)
            self._refuse_what_no_way_leads_to(part, now)

    def _take_in(self, now: float) -> None:
        """Robots that have said where they are take part."""
        silent = []
        for robot, port in self._waiting:
            said = port.heard
            if said is None:
                silent.append((robot, port))
                continue
            place = planar(said.position)
            number = self._order.add(place, robot.radius_m)
            self._parts.append(Part(robot, port, number, stood=place, moved_s=now))
            self._forget_plan()
        self._waiting = silent

    def _watch(self, now: float) -> None:
        """One that does not move though it may stands in the way of the others, until it moves or is tried again."""
        for part in self._parts:
            if (part.gone, part.removed) != (part.outlook.gone, part.outlook.removed):
                self._let_out_or_in(part, now)
            moved = math.dist(part.near, part.stood) > MOVED_M
            if moved or part.port.orders != part.orders:
                part.tried, part.orders = 0, part.port.orders
                if part.broken:
                    self._mend(part, now)
            if part.broken:
                if now - part.broken_s >= RETRY_S * 2**part.tried:
                    part.tried = min(part.tried + 1, MOST_TRIES) if part.port.goal is None else 0
                    self._mend(part, now)
            elif moved or not part.to_go or part.port.at_work:
                part.stood, part.moved_s = part.near, now
            elif now - part.moved_s > NO_PROGRESS_S:
                self._break(part, now)

    def _break(self, part: Part, now: float) -> None:
        """What the robot was told holds: it may have dropped it, or go on at any time."""
        part.broken, part.broken_s = True, now
        self._forget_way(part)

    def _let_out_or_in(self, part: Part, now: float) -> None:
        """A robot that is out was stopped, and is not sent anywhere until it takes part again."""
        part.gone, part.removed, part.broken = part.outlook.gone, part.outlook.removed, False
        part.may_be_at = tuple(part.gone_on(now)) if part.gone and not part.outlook.removed else ()
        part.stood, part.moved_s = part.near, now
        self._forget_way(part)

    def _mend(self, part: Part, now: float) -> None:
        """The robot is stopped, and told anew: where it was told to go others may be sent by now."""
        part.broken, part.stood, part.moved_s = False, part.near, now
        part.port.halt()
        self._forget_way(part)

    def _forget_way(self, part: Part) -> None:
        """The robot stands where it is, as far as the order goes, and a new plan is due."""
        self._forget_plan()
        self._order.stop(part.number, part.near)

    def _forget_plan(self) -> None:
        """Let all robots go no further than they have been let go, until there is a new plan."""
        self._request, self._planned_s = None, _NEVER_S
        self._order.cut()

    def _lead_on(self, part: Part, now: float) -> None:
        """A robot that goes where it was planned to go next, or has done all, goes on along the moves that it has."""
        goal, arrives, aim = part.goal, part.port.arrives, part.aim
        to_next = arrives and goal != aim.goal and aim.ahead[:1] == (goal,) and self._last.complete
        to_rest = goal is None and aim.goal is not None and not aim.ahead and not aim.stays
        if to_next or to_rest:
            part.aim = replace(aim, goal=goal, arrives=arrives, ahead=aim.ahead[1:], stop=aim.stop + 1)
            self._order.lead(part.number, part.aim.stop)
        done = part.aim.arrives and not arrives and goal == part.aim.goal
        part.done_s = min(part.done_s, now) if done else math.inf

    def _plan_is_due(self, now: float) -> bool:
        if self._planned_s == _NEVER_S or any(self._goes_elsewhere(part, now) for part in self._parts):
            return True
        if now - self._planned_s < PLAN_EVERY_S or self._keeps_to_incomplete(now):
            return False
        return any(
            self._falls_short(part) or (part.aim.more and len(part.aim.ahead) < LEAST_STOPS // 2)
            for part in self._parts
        )

    def _keeps_to_incomplete(self, now: float) -> bool:
        """Return whether the last plan is incomplete and robots still go on by its moves."""
        if self._last.complete or now - self._planned_s >= INCOMPLETE_FOR_S:
            return False
        return any(self._order.metres_left(part.number) > MOVED_M for part in self._parts if not part.fixed)

    def _goes_elsewhere(self, part: Part, now: float) -> bool:
        """Whether a robot has been sent elsewhere than was planned; one that has done its work is told soon."""
        goal, arrives = part.goal, part.port.arrives
        if (goal, arrives) == (part.aim.goal, part.aim.arrives):
            return False
        if goal != part.aim.goal or arrives:
            return True
        last = part.aim.stays and not part.aim.ahead
        return not last and now - part.done_s >= NOTICE_S

    def _falls_short(self, part: Part) -> bool:
        """Whether the moves of a robot end before its goal, and it is coming near to where they end."""
        away = self._away_m(part) > AT_GOAL_M
        return away and not part.fixed and self._order.metres_left(part.number) < 2 * self.ahead_m

    def _ask_for_plan(self, now: float, *, only_complete: bool = False) -> None:
        """Begin to plan what follows the moves that may begin meanwhile; `only_complete`: drop an incomplete plan."""
        self._sought_s = now
        request = PlanRequest.of(self._parts, self._order, self.ahead_m, self.planning.takes_s, only_complete)
        self._request = request
        self.planning.begin(lambda: request.planned(self.plan), now)

    def _take_plan(self, now: float) -> None:
        """Let robots go on by the plan that was asked for, where it is there."""
        found = None if self._request is None else self.planning.result(now)
        if self._request is None or found is None:
            return
        request, self._request = self._request, None
        if request.only_complete and not found.complete:
            self._order.release()
            return
        self._order.adopt(request.order)
        self._planned_s, self.plans, self._travellers, self._last = now, self.plans + 1, request.travellers, found
        for part, aim in zip(self._parts, request.aims, strict=True):
            part.aim, part.done_s = aim, math.inf
            self._order.lead(part.number, aim.stop)
            self._lead_on(part, now)  # it may have been sent on meanwhile

    def _let_go(self, part: Part, now: float) -> None:
        """Send a robot as far as it may go."""
        if part.port.at_work:
            part.port.waits_for, part.to_go = "", False
            return
        grant = self._order.grant(part.number)
        part.to_go = grant.metres > MOVED_M
        left_m, away_m = self._order.metres_left(part.number), self._away_m(part)
        is_planned = part.goal == part.aim.goal
        if is_planned and (left_m > 0 or away_m <= AT_GOAL_M or part.port.left_m is None):
            part.port.left_m = left_m + away_m  # without a way it has come no nearer
        part.port.waits_for = self._held_up_by(part, grant)
        to_goal = is_planned and grant.last and part.port.arrives and away_m <= AT_GOAL_M
        part.to_go = part.to_go or to_goal
        if grant.points or to_goal:
            said = part.port.heard
            height = said.position[2] if said is not None else 0.0
            way = [
                Waypoint((x, y, height), speed_mps=speed)
                for (x, y), speed in zip(grant.points, grant.speeds, strict=True)
            ]
            if self.sparing and not to_goal and self._can_wait(part, way, grant, now):
                return
            if part.port.go(way, to_goal=to_goal):
                part.moves_passed, part.sent_s = self._order.passed(part.number), now
            part.ends = part.port.marks_passed + grant.ended  # an order that was cut ends with a move

    def _can_wait(self, part: Part, way: Sequence[Waypoint], grant: core.Grant, now: float) -> bool:
        """Whether a robot does not need yet what a way adds to the order that it has."""
        if part.port.has_come(way):
            return True
        added_m = part.port.added_m(way)
        if grant.last or added_m is None:
            return False
        limits = limits_of(part.robot)
        left_m = sum(math.dist(*piece) for piece in part.pieces_ahead())
        if left_m > limits.braking_m(limits.speed_mps) + NEEDED_S * limits.speed_mps:
            return True
        is_short = added_m < max(EXTENDED_M, EXTENDED_S * limits.speed_mps)
        return is_short and grant.waits_for >= 0 and now - part.sent_s < EXTENDED_S

    def _refuse_what_no_way_leads_to(self, part: Part, now: float) -> None:
        """Lanes may lead to no goal, or never back from one; what lies behind a closed door is not given up here."""
        goal = part.aim.goal
        if (
            goal is None
            or goal != part.goal
            or self._closed
            or not self._falls_short(part)
            or self._order.metres_left(part.number) > 0.0
        ):
            part.no_way_s = math.inf
            return
        part.no_way_s = min(part.no_way_s, now)
        if now - part.no_way_s >= NO_WAY_S:
            part.no_way_s = math.inf
            alone = Traveller(part.robot, self._order.end(part.number), (Stop(goal),))
            if not self.plan.reaches([alone], 0, [goal])[0]:
                part.port.refused = "unreachable: no way leads there"

    def _away_m(self, part: Part) -> float:
        """Metres from where the moves of a robot end to its goal; 0 without one."""
        goal = part.aim.goal
        return 0.0 if goal is None else math.dist(self._order.stand(part.number), goal)

    def _held_up_by(self, part: Part, grant: core.Grant) -> str:
        """The robot that comes first, or stands next to one that has found no way; empty where nobody holds it up."""
        if part.to_go:
            return ""
        if grant.waits_for >= 0:
            return self._parts[grant.waits_for].robot.id
        if self._request is not None:  # whether it has found no way shows when the plan is there
            return part.port.waits_for
        return self._nearest(part) if self._falls_short(part) else ""

    def _nearest(self, part: Part) -> str:
        """The robot next to one that has found no way; one that others have to get round, where such cut it off."""
        others, cut_off = [other for other in self._parts if other is not part], part.number in self._last.cut_off
        found = min(others, key=lambda one: (one.fixed != cut_off, math.dist(one.near, part.near)), default=None)
        return "" if found is None else found.robot.id
