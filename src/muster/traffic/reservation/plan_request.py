"""A plan of traffic that is asked for: where robots go, and from where."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from muster import core
from muster.motion.port import planar
from muster.traffic.journeys.travellers import PlannedMoves, Planner, Stop, Traveller
from muster.traffic.reservation.part import Aim, Part

STOPS_PLANNED = 120
"""Stops of all robots to which moves are planned, but `LEAST_STOPS` of each; anew where one has fewer than half of
these left."""
LEAST_STOPS = 4
MOVED_M = 0.05
"""Metres by which a robot has moved that is not taken to stand."""
AT_GOAL_M = 1e-3
"""Metres from its goal at which a robot is there."""


@dataclass(frozen=True)
class PlanRequest:
    """A plan that is asked for.

    Parameters
    ----------
    travellers : list of Traveller
        The robots, by number, and the other places where robots may be that are out.
    aims : list of Aim
        Where each robot goes by the plan.
    order : core.PassingOrder
        The moves that may begin until the plan is there, and then those of the plan.
    only_complete : bool
        Whether an incomplete plan changes nothing.
    """

    travellers: list[Traveller]
    aims: list[Aim]
    order: core.PassingOrder
    only_complete: bool

    @classmethod
    def of(
        cls, parts: Sequence[Part], order: core.PassingOrder, ahead_m: float, takes_s: float, only_complete: bool
    ) -> PlanRequest:
        """Return the request of all robots; `order` lets only those moves begin that the plan goes on from.

        Parameters
        ----------
        parts : Sequence of Part
            All robots.
        order : core.PassingOrder
            The order in which they pass by the plan before.
        ahead_m : float
            Metres for which a robot may have begun moves.
        takes_s : float
            Seconds until the plan is there; for so long robots go on that are not sent elsewhere.
        only_complete : bool
            Whether an incomplete plan changes nothing.
        """
        most = max(LEAST_STOPS, STOPS_PLANNED // len(parts))
        aims = [_aim(part, most) for part in parts]
        kept = order.hold(
            [
                ahead_m + takes_s * part.robot.speed_mps if aim.goal == part.aim.goal else 0.0
                for part, (aim, _) in zip(parts, aims, strict=True)
            ]
        )
        travellers = [_traveller(part, aim, stops, kept) for part, (aim, stops) in zip(parts, aims, strict=True)]
        travellers += [Traveller(part.robot, at, fixed=True) for part in parts for at in part.may_be_at]
        return cls(travellers, [aim for aim, _ in aims], kept, only_complete)

    def planned(self, plan: Planner) -> PlannedMoves:
        """Make the plan, and append its moves to the order."""
        found = plan(self.travellers)
        self.order.extend([(k, to, self.aims[k].stop + stop, speed_mps) for k, to, stop, speed_mps in found.moves])
        return found


def _aim(part: Part, most: int) -> tuple[Aim, Sequence[Stop]]:
    """Where a robot goes now and then, for at most so many stops; what it does at one place is one stop."""
    goal, arrives = part.goal, part.port.arrives
    aim = Aim(goal, arrives, part.aim.stop, stays=goal is not None)
    if goal is None or not arrives:
        return aim, [] if goal is None else [Stop(goal)]
    stops = list[Stop]()
    for place, hold_s in (*part.port.visits, *part.outlook.visits):
        at = planar(place)
        before = stops.pop().hold_s if stops and stops[-1].at == at else 0.0
        stops.append(Stop(at, before + hold_s))
    more, stops = len(stops) > most, stops[:most]
    ahead = tuple(stop.at for stop in stops[1:])
    return replace(aim, ahead=ahead, more=more, stays=part.outlook.stays and not more), stops


def _traveller(part: Part, aim: Aim, stops: Sequence[Stop], order: core.PassingOrder) -> Traveller:
    """The robot, from where it is when all moves of the order are done."""
    _find_again(part, aim, order)
    said, busy = part.port.heard, part.port.busy
    return Traveller(
        robot=part.robot,
        start=order.end(part.number),
        stops=(Stop(stops[0].at), *stops[1:]) if busy else tuple(stops),
        heading_rad=0.0 if said is None else said.heading,
        ready_s=stops[0].hold_s if busy else 0.0,
        stays=aim.stays,
        fixed=part.fixed,
    )


def _find_again(part: Part, aim: Aim, order: core.PassingOrder) -> None:
    """A robot that is to go on stands where it is now said to be: first words may err, and robots are pushed."""
    to_go_on = aim.goal is None or math.dist(order.stand(part.number), aim.goal) > AT_GOAL_M
    if to_go_on and not part.port.busy and math.dist(order.end(part.number), part.near) > MOVED_M:
        order.stands(part.number, part.near)
