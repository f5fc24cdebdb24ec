"""Waiting robots make room for robots under way, and return afterwards, as in the simulated worlds.

Only one that has done what it was sent to do is moved. Where another is to go to a place so near that both bodies do
not fit, or is held up on its way there, it steps aside to the nearest place at which it is in nobody's way. It comes
back when nobody has claimed its place for a while and nobody stands there: else two robots that meet at one place stand
off for ever, one making way and coming back, as soon as the other is heard late. It comes back only from where it was
sent aside: whom somebody else has moved, or drives, stays where that leads.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from muster.mission.model import Robot
from muster.motion.port import Place, Waypoint
from muster_robots.steering import SteeredRobot

_HELD_UP_S = 1.0
"""A robot that is to go and hardly does for so long is held up."""
_SLOW = 0.1
"""Share of its speed below which a robot hardly goes."""
_KEEPS_AWAY_S = 3.0
"""Seconds for which one that made room stays away after its place was last claimed."""
_AHEAD_M = 3.0
"""Metres ahead of a robot that is held up, within which robots that stand yield."""
_DIRECTIONS, _RINGS = 24, 8
_STRAYS_M = 0.5
"""Farther beside its way, and its body's breadth, a robot was moved by somebody else; nearer it goes around others."""


@dataclass(frozen=True)
class _Claim:
    """A piece of ground that a robot needs: a segment, or a place where both ends are one."""

    robot: Robot
    begin: Place
    end: Place

    def distance_m(self, place: Place) -> float:
        return _distance_m(place, self.begin, self.end)


@dataclass(frozen=True)
class _Trip:
    """What a robot that waits was sent to do here: from where, and to where."""

    begin: Place
    end: Place


class Yielding:
    """Keeps where waiting robots belong, and which robots are held up since when.

    Parameters
    ----------
    arrival_m
        how near to a place a robot counts as there.
    margin_m
        between two bodies, at least.
    may_go
        whether a robot may go straight from a place to another, and stand there: no walls or forbidden zones.
    """

    def __init__(
        self,
        *,
        arrival_m: float,
        margin_m: float = 0.1,
        may_go: Callable[[Robot, Place, Place], bool] = lambda *_: True,
    ) -> None:
        self._arrival_m, self._margin_m, self._may_go = arrival_m, margin_m, may_go
        self._posts: dict[str, Place] = {}  # from where a robot was sent aside last
        self._trips: dict[str, _Trip] = {}  # of those that are on their way aside, there, or on their way back
        self._slow_since: dict[str, float] = {}
        self._claimed_s: dict[str, float] = {}  # when the place of a robot was claimed last

    def arranged(self, now: float, team: Sequence[SteeredRobot]) -> list[SteeredRobot]:
        """The team with aims for those that wait and are in the way, or are to come back.

        Parameters
        ----------
        now
            seconds of any clock that does not go back.
        """
        claims = [claim for steered in team if steered.aim is not None for claim in self._claims(now, steered)]
        return [self._moved(now, steered, team, claims) if steered.waits else self._busy(steered) for steered in team]

    def _busy(self, steered: SteeredRobot) -> SteeredRobot:
        self._forget(steered)
        return steered

    def _forget(self, steered: SteeredRobot) -> None:
        self._posts.pop(steered.robot.id, None)
        self._trips.pop(steered.robot.id, None)
        self._claimed_s.pop(steered.robot.id, None)

    def _claims(self, now: float, steered: SteeredRobot) -> Iterator[_Claim]:
        """Where it is to go, and if it is held up the ground before it."""
        robot = steered.robot
        assert steered.aim is not None
        yield _Claim(robot, steered.aim.position, steered.aim.position)
        if not steered.goes or math.hypot(*steered.velocity[:2]) > _SLOW * robot.speed_mps:
            self._slow_since.pop(robot.id, None)
        elif now - self._slow_since.setdefault(robot.id, now) >= _HELD_UP_S:
            far = math.dist(steered.position[:2], steered.aim.position[:2])
            share = min(1.0, _AHEAD_M / far) if far > 0 else 1.0
            x, y = (a + share * (b - a) for a, b in zip(steered.position[:2], steered.aim.position[:2], strict=True))
            yield _Claim(robot, steered.position, (x, y, steered.position[2]))

    def _moved(
        self, now: float, steered: SteeredRobot, team: Sequence[SteeredRobot], claims: Sequence[_Claim]
    ) -> SteeredRobot:
        name = steered.robot.id
        if self._strays(steered):
            self._forget(steered)
        trip, post = self._trips.get(name), self._posts.get(name, steered.position)
        if self._in_the_way(steered, post, claims):
            self._claimed_s[name] = now
        elif trip is None:
            return steered
        elif self._may_come_back(now, steered, post, team):
            return self._back(steered, trip, post)
        if trip is None or self._in_the_way(steered, trip.end, claims):
            aside = self._place_for(steered, post, team, claims)
            if aside is None:
                return steered
            trip = _Trip(steered.position, aside)
            self._posts[name], self._trips[name] = post, trip
        arrived = self._is_at(steered, trip.end, self._arrival_m)
        if arrived:
            self._trips[name] = _Trip(trip.end, trip.end)
        return replace(steered, aim=Waypoint(trip.end), arrived=arrived)

    def _may_come_back(self, now: float, steered: SteeredRobot, post: Place, team: Sequence[SteeredRobot]) -> bool:
        """Whether its place has not been claimed for a while, and nobody is on it; or it is on its way already."""
        name = steered.robot.id
        if self._trips[name].end == post:
            return True
        others = [other for other in team if other.robot.id != name]
        taken = any(
            math.dist(post[:2], other.position[:2]) < self._apart_m(steered.robot, other.robot) for other in others
        )
        return not taken and now - self._claimed_s.get(name, -math.inf) >= _KEEPS_AWAY_S

    def _back(self, steered: SteeredRobot, trip: _Trip, post: Place) -> SteeredRobot:
        """On its way back, to its post; it stays where others have led it from where there is no straight way."""
        name = steered.robot.id
        if self._is_at(steered, post, self._arrival_m):
            del self._trips[name]
            return steered
        if trip.end != post:
            if not self._may_go(steered.robot, steered.position, post):
                self._forget(steered)
                return steered
            self._trips[name] = _Trip(steered.position, post)
        return replace(steered, aim=Waypoint(post))

    def _strays(self, steered: SteeredRobot) -> bool:
        """Whether it is where nothing here has sent it."""
        name = steered.robot.id
        trip, post = self._trips.get(name), self._posts.get(name)
        if trip is not None and trip.begin != trip.end:
            return _distance_m(steered.position, trip.begin, trip.end) > 2 * steered.robot.radius_m + _STRAYS_M
        stands = post if trip is None else trip.end
        return stands is not None and not self._is_at(steered, stands, 2 * self._arrival_m)

    def _is_at(self, steered: SteeredRobot, place: Place, within_m: float) -> bool:
        return math.dist(steered.position[:2], place[:2]) <= within_m

    def _in_the_way(self, steered: SteeredRobot, place: Place, claims: Sequence[_Claim]) -> bool:
        return any(claim.distance_m(place) < self._apart_m(steered.robot, claim.robot) for claim in claims)

    def _apart_m(self, one: Robot, other: Robot) -> float:
        """What two bodies need; one without a body is in nobody's way, nor is one on the ground in that of a drone."""
        if one.kind != other.kind or not (one.radius_m > 0 and other.radius_m > 0):
            return 0.0
        return one.radius_m + other.radius_m + self._margin_m

    def _place_for(
        self, steered: SteeredRobot, post: Place, team: Sequence[SteeredRobot], claims: Sequence[_Claim]
    ) -> Place | None:
        """The nearest place at which it is in nobody's way, and from which it can come back; None if none is near."""
        x, y, z = steered.position
        step = steered.robot.radius_m + self._margin_m
        for ring in range(1, _RINGS + 1):
            for k in range(_DIRECTIONS):
                angle = 2 * math.pi * k / _DIRECTIONS
                place = (x + ring * step * math.cos(angle), y + ring * step * math.sin(angle), z)
                if (
                    not self._in_the_way(steered, place, claims)
                    and self._is_free(steered, place, team)
                    and self._may_go(steered.robot, steered.position, place)
                    and self._may_go(steered.robot, place, post)
                ):
                    return place
        return None

    def _is_free(self, steered: SteeredRobot, place: Place, team: Sequence[SteeredRobot]) -> bool:
        """Whether no other body is there, or is to come back there."""
        others = [other for other in team if other.robot.id != steered.robot.id]
        return all(
            math.dist(place[:2], taken[:2]) >= self._apart_m(steered.robot, other.robot)
            for other in others
            for taken in (other.position, self._posts.get(other.robot.id, other.position))
        )


def _distance_m(place: Place, begin: Place, end: Place) -> float:
    """In the plane, from a place to a segment."""
    (ax, ay, _), (bx, by, _), (px, py, _) = begin, end, place
    dx, dy = bx - ax, by - ay
    long = dx * dx + dy * dy
    share = 0.0 if long == 0 else min(1.0, max(0.0, ((px - ax) * dx + (py - ay) * dy) / long))
    return math.hypot(px - ax - share * dx, py - ay - share * dy)
