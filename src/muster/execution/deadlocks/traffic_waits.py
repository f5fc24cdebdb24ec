"""Waiting in traffic: which robot holds up which, since when and where; and jams, in which nobody goes on by itself.

A robot waits in traffic where it hardly gets on and another is in its way. Its port tells for whom
(`Telemetry.waits_for`); where that does not tell, it follows from where the robots are. Waiting is not being stuck,
however long it takes.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

from muster.execution.robots.monitor import distance_to_piece
from muster.execution.robots.robot_state import MOVING, Activity, RobotState
from muster.motion.kinematics.registry import limits_of
from muster.motion.port import Place
from muster.state.robot_events import GoesOn, WaitsInTraffic
from muster.state.traffic_account import TrafficAccount

LEAST_WAIT_S = 1.0
"""Seconds for which a robot is held up before that counts as waiting, and gets on before that is over."""
_HARDLY = 0.1
"""Share of its speed below which a robot hardly gets on."""
_CLEAR_M = 0.1
"""Metres between two bodies that hinder each other."""
_NEARER_M = 0.2
"""Metres by which a way has to grow shorter to count as progress out of a jam."""
_ROUND = 2.0
"""Times the way that a robot can have driven since the last look, by which a way grows longer that leads elsewhere."""


@dataclass
class TrafficWait:
    """One wait of a robot: for whom it waits now, where and since when; seconds by robot that it waited for.

    `told` is whether it has lasted so long that it counts.
    """

    waits_for: str
    place: Place
    since_s: float
    until_s: float
    seconds: dict[str, float] = field(default_factory=dict)
    told: bool = False

    def note(self, waits_for: str, now: float) -> None:
        """It goes on, until now."""
        self.seconds[waits_for] = self.seconds.get(waits_for, 0.0) + now - self.until_s
        self.waits_for, self.until_s = waits_for, now


@dataclass
class Progress:
    """How a robot gets on to one target: the least way left to it, and what held it up since it had come so near.

    `behind_s`: for how long it waited for each robot; `jammed_s`: for how long it was in a jam; `held_s`: the same
    since one of the jam stood aside; `asides`: how often it did itself; `told`: whether the jam was told.
    """

    robot: str
    target: str
    least_m: float = math.inf
    behind_s: dict[str, float] = field(default_factory=dict)
    jammed_s: float = 0.0
    held_s: float = 0.0
    asides: int = 0
    told: bool = False

    def note(self, left_m: float) -> None:
        if left_m < self.least_m - _NEARER_M:
            self.goes_round(left_m)
            self.jammed_s, self.held_s, self.asides, self.told = 0.0, 0.0, 0, False

    def goes_round(self, left_m: float) -> None:
        """It was sent another way, which is longer."""
        self.least_m = left_m
        self.behind_s.clear()


class TrafficWaits:
    """Keeps who waits in traffic.

    Parameters
    ----------
    crew
        by id; robots that are out may be in the way, too.

    Attributes
    ----------
    sent_round
        the robots whose ways have become longer at the last look: their navigation has sent them another way.
    """

    def __init__(self, crew: Mapping[str, RobotState]) -> None:
        self._crew = crew
        # At the last look: of which order, and whether traffic had planned it.
        self._left_m: dict[str, tuple[tuple[int, bool], float]] = {}
        self._looked_s = 0.0
        self._out: set[str] = set()
        self.waits: dict[str, TrafficWait] = {}
        self.progress: dict[str, Progress] = {}
        self.sent_round: set[str] = set()

    def pass_over(self, now: float) -> None:
        """Leave a pause that ends now out of all waits."""
        self._looked_s = now
        for wait in self.waits.values():
            wait.until_s = now

    def look(self, now: float) -> Iterator[WaitsInTraffic | GoesOn]:
        """See who waits now; yields an event of each wait that begins to count, or is over."""
        self.sent_round.clear()
        self._notice_who_is_out()
        for robot, state in self._crew.items():
            left_m = state.way_left_m
            nearer_m = self._nearer_m(state, left_m)
            could_m = state.robot.speed_mps * (now - self._looked_s)
            self._note_progress(state, left_m)
            if nearer_m < -_ROUND * could_m - _NEARER_M and _under_way(state):
                self.sent_round.add(robot)
                self.progress[robot].goes_round(left_m)
            other = self._held_up_by(state, now, hardly=nearer_m < _HARDLY * could_m)
            wait = self.waits.get(robot)
            if other and wait is None:
                self.waits[robot] = TrafficWait(other, state.position, now, now)
            elif other and wait is not None:
                wait.note(other, now)
                if not wait.told and now - wait.since_s >= LEAST_WAIT_S:
                    wait.told = True
                    place = plain_place(wait.place)
                    yield WaitsInTraffic(robot=robot, waits_for=wait.waits_for, position=place, since_s=wait.since_s)
            elif wait is not None and (now - wait.until_s >= LEAST_WAIT_S or not _under_way(state)):
                yield from self._over(robot, wait)
        since_s, self._looked_s = self._looked_s, now
        for robot, wait in self.waits.items():
            behind_s = self.progress[robot].behind_s
            behind_s[wait.waits_for] = behind_s.get(wait.waits_for, 0.0) + now - since_s
        for core in self._cores():
            for one in self.members(core):
                one.jammed_s += now - since_s
        for jam in self.jams():
            for one in self.members(jam):
                one.held_s += now - since_s

    def _notice_who_is_out(self) -> None:
        """Count waits anew: for a robot that goes out, as ways lead round it from now on; all, where one returns.

        Whom robots wait for may not be who cut them off.
        """
        out = {robot for robot, state in self._crew.items() if state.out}
        for one in self.progress.values():
            for robot in list(one.behind_s) if self._out - out else out - self._out:
                one.behind_s.pop(robot, None)
        self._out = out

    def with_waits(self, account: TrafficAccount) -> TrafficAccount:
        """An account of waits that are over, with those that are not."""
        whole = TrafficAccount({robot: dict(others) for robot, others in account.pairs.items()})
        for robot, wait in self.waits.items():
            if wait.told:
                whole.add(robot, wait.seconds, wait.place)
        return whole

    def waits_for(self, robot: str) -> str:
        """For whom a robot waits in traffic; empty where it does not."""
        wait = self.waits.get(robot)
        return wait.waits_for if wait is not None and wait.told else ""

    def jams(self) -> set[frozenset[str]]:
        """Robots that wait in a ring, and those that wait for one that stands without waiting for anybody.

        Who waits for one that drives, works or is out is in no jam: that one goes on, or is put out.
        """
        return {core for core in self._cores() if not any(self._stands_aside(robot) for robot in core)}

    def _cores(self) -> set[frozenset[str]]:
        """The robots of all jams, of those too in which one stands aside for now."""
        found = set()
        for robot in self.waits:
            chain = [robot]
            while (wait := self.waits.get(chain[-1])) is not None and wait.waits_for not in chain:
                chain.append(wait.waits_for)
            if wait is not None:
                found.add(frozenset(chain[chain.index(wait.waits_for) :]))
            elif self._stands(chain[-1]):
                found.add(frozenset(chain[-2:]))
        return found

    def members(self, jam: Collection[str]) -> list[Progress]:
        """How those of a jam get on who wait, by their ids."""
        return [self.progress[robot] for robot in sorted(jam) if robot in self.waits]

    def _note_progress(self, state: RobotState, left_m: float) -> None:
        robot, target = state.robot.id, state.route[0] if state.route else ""
        target = state.station if state.activity is Activity.TO_STATION else target
        if robot not in self.progress or self.progress[robot].target != target:
            self.progress[robot] = Progress(robot, target)
        if _under_way(state):
            self.progress[robot].note(left_m)

    def _over(self, robot: str, wait: TrafficWait) -> Iterator[GoesOn]:
        del self.waits[robot]
        if wait.told:
            waited_s = {other: seconds for other, seconds in wait.seconds.items() if seconds > 0}
            place = plain_place(wait.place)
            yield GoesOn(robot=robot, until_s=wait.until_s, waited_s=waited_s, position=place)

    def _stands(self, robot: str) -> bool:
        """Whether a robot stands and does nothing that ends by itself; one of which nothing is known may."""
        state = self._crew.get(robot)
        if state is None or state.out:
            return state is None
        return state.activity is Activity.WAITING or (state.activity is Activity.IDLE and not state.route)

    def _stands_aside(self, robot: str) -> bool:
        return robot in self._crew and self._crew[robot].aside_until_s > self._looked_s

    def _held_up_by(self, state: RobotState, now: float, *, hardly: bool) -> str:
        """Who holds a robot up, which hardly gets on or not; empty where nobody does."""
        if now < state.aside_until_s and not state.out and state.robot.id in self.waits:
            return self.waits[state.robot.id].waits_for
        said = state.telemetry
        if said is None or not _under_way(state):
            return ""
        if said.waits_for is not None:
            return said.waits_for
        return self._in_its_way(state) if hardly and _has_way(state) else ""

    def _nearer_m(self, state: RobotState, left_m: float) -> float:
        """By how much its way has grown shorter since the last look; inf where its order is new."""
        robot = state.robot.id
        told, before_m = self._left_m.get(robot, ((-1, False), 0.0))
        now_told = state.order, state.steered
        self._left_m[robot] = now_told, left_m
        return before_m - left_m if told == now_told else math.inf

    def _in_its_way(self, state: RobotState) -> str:
        """The nearest robot that another would touch on its way before it could stop; empty where there is none."""
        robot, begin = state.robot, state.position
        reach_m = robot.radius_m + _stopping_m(state)
        found, nearest_m = "", math.inf
        for other in self._crew.values():
            body = other.robot
            if other is state or not (body.radius_m > 0 and robot.radius_m > 0) or body.kind != robot.kind:
                continue
            apart_m = robot.radius_m + body.radius_m + _CLEAR_M
            away_m = math.dist(other.position, begin)
            if away_m < min(nearest_m, reach_m + apart_m) and any(
                distance_to_piece(other.position, a, b) < min(apart_m, away_m) for a, b in _pieces(state, reach_m)
            ):
                found, nearest_m = body.id, away_m
        return found


def _under_way(state: RobotState) -> bool:
    return not state.out and state.activity in MOVING


def _has_way(state: RobotState) -> bool:
    """Whether it is not yet where it is to be next; at work a robot stands as near to that as its body lets others."""
    near_m = state.robot.radius_m if state.activity is Activity.WORKING else 0.0
    return bool(state.points_left) and math.dist(state.position, state.points_left[0]) > near_m


def _stopping_m(state: RobotState) -> float:
    speed, most = state.robot.speed_mps, limits_of(state.robot).acceleration_mps2
    return speed * speed / (2 * most)


def _pieces(state: RobotState, reach_m: float) -> Iterator[tuple[Place, Place]]:
    """The straight pieces of its way, as far as it reaches."""
    begin = state.position
    for end in state.points_left:
        long = math.dist(begin, end)
        if long > reach_m:
            share = reach_m / long
            x, y, z = (a + share * (b - a) for a, b in zip(begin, end, strict=True))
            yield begin, (x, y, z)
            return
        yield begin, end
        begin, reach_m = end, reach_m - long


def plain_place(place: Place) -> tuple[float, ...]:
    """A place to the millimetre, as events have it: two coordinates on the ground."""
    return tuple(round(c, 3) for c in (place if place[2] else place[:2]))
