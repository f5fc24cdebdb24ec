"""Robots that wait make room for those that come, and come back, as those of the simulated worlds do.

One that has nothing to do stands where it last was sent. Where another is to go to a place so near that both bodies do
not fit, or is held up on its way there, it steps aside to the nearest place at which it is in nobody's way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from muster.bridges.steering import Driven
from muster.mission.model import Robot
from muster.motion.port import Place, Waypoint

_HELD_UP_S = 1.0
"""A robot that is to go and hardly does for so long is held up."""
_SLOW = 0.1
"""Share of its speed below which a robot hardly goes."""
_AHEAD_M = 3.0
"""So far ahead of one that is held up, those are asked who stand there."""
_DIRECTIONS, _RINGS = 24, 8


@dataclass(frozen=True)
class _Claim:
    """A piece of ground that a robot needs: a segment, or a place where both ends are one."""

    robot: Robot
    begin: Place
    end: Place

    def distance_m(self, place: Place) -> float:
        """In the plane, from a place to the segment."""
        (ax, ay, _), (bx, by, _), (px, py, _) = self.begin, self.end, place
        dx, dy = bx - ax, by - ay
        long = dx * dx + dy * dy
        share = 0.0 if long == 0 else min(1.0, max(0.0, ((px - ax) * dx + (py - ay) * dy) / long))
        return math.hypot(px - ax - share * dx, py - ay - share * dy)


class MakingRoom:
    """Remembers where those who wait belong, and who is held up since when.

    Parameters
    ----------
    arrival_m
        how near to a place a robot counts as there.
    margin_m
        between two bodies, at least.
    may_stand
        whether a robot may stand at a place: not in walls or forbidden zones.
    """

    def __init__(
        self,
        *,
        arrival_m: float,
        margin_m: float = 0.1,
        may_stand: Callable[[Driven, Place], bool] = lambda _, __: True,
    ) -> None:
        self._arrival_m, self._margin_m, self._may_stand = arrival_m, margin_m, may_stand
        self._posts: dict[str, Place] = {}
        self._asides: dict[str, Place] = {}
        self._slow_since: dict[str, float] = {}

    def arranged(self, now: float, team: Sequence[Driven]) -> list[Driven]:
        """The team with aims for those that wait and are in the way, or are to come back.

        Parameters
        ----------
        now
            seconds of any clock that does not go back.
        """
        claims = [claim for driven in team if driven.aim is not None for claim in self._claims(now, driven)]
        return [self._moved(driven, team, claims) if driven.waits else self._busy(driven) for driven in team]

    def _busy(self, driven: Driven) -> Driven:
        self._posts.pop(driven.robot.id, None)
        self._asides.pop(driven.robot.id, None)
        return driven

    def _claims(self, now: float, driven: Driven) -> Iterator[_Claim]:
        """Where it is to go, and if it is held up the ground before it."""
        robot = driven.robot
        assert driven.aim is not None
        yield _Claim(robot, driven.aim.position, driven.aim.position)
        if not driven.goes or math.hypot(*driven.velocity[:2]) > _SLOW * robot.speed_mps:
            self._slow_since.pop(robot.id, None)
        elif now - self._slow_since.setdefault(robot.id, now) >= _HELD_UP_S:
            far = math.dist(driven.position[:2], driven.aim.position[:2])
            share = min(1.0, _AHEAD_M / far) if far > 0 else 1.0
            x, y = (a + share * (b - a) for a, b in zip(driven.position[:2], driven.aim.position[:2], strict=True))
            yield _Claim(robot, driven.position, (x, y, driven.position[2]))

    def _moved(self, driven: Driven, team: Sequence[Driven], claims: Sequence[_Claim]) -> Driven:
        name = driven.robot.id
        post = self._posts.setdefault(name, driven.position)
        if not self._in_the_way(driven, post, claims):
            self._asides.pop(name, None)
            there = math.dist(driven.position[:2], post[:2]) <= self._arrival_m
            return driven if there else replace(driven, aim=Waypoint(post))
        aside = self._asides.get(name)
        if aside is None or self._in_the_way(driven, aside, claims):
            aside = self._place_for(driven, team, claims)
        if aside is None:
            return driven
        self._asides[name] = aside
        arrived = math.dist(driven.position[:2], aside[:2]) <= self._arrival_m
        return replace(driven, aim=Waypoint(aside), arrived=arrived)

    def _in_the_way(self, driven: Driven, place: Place, claims: Sequence[_Claim]) -> bool:
        return any(claim.distance_m(place) < self._apart_m(driven.robot, claim.robot) for claim in claims)

    def _apart_m(self, one: Robot, other: Robot) -> float:
        """What two bodies need; one without a body is in nobody's way, nor is one on the ground in that of a drone."""
        if one.kind != other.kind or not (one.radius_m > 0 and other.radius_m > 0):
            return 0.0
        return one.radius_m + other.radius_m + self._margin_m

    def _place_for(self, driven: Driven, team: Sequence[Driven], claims: Sequence[_Claim]) -> Place | None:
        """The nearest place at which it is in nobody's way; None if none is near."""
        x, y, z = driven.position
        step = driven.robot.radius_m + self._margin_m
        for ring in range(1, _RINGS + 1):
            for k in range(_DIRECTIONS):
                angle = 2 * math.pi * k / _DIRECTIONS
                place = (x + ring * step * math.cos(angle), y + ring * step * math.sin(angle), z)
                if not self._in_the_way(driven, place, claims) and self._is_free(driven, place, team):
                    return place
        return None

    def _is_free(self, driven: Driven, place: Place, team: Sequence[Driven]) -> bool:
        """Whether no other body is there, or is to come back there, and the map has room."""
        others = [other for other in team if other.robot.id != driven.robot.id]
        return self._may_stand(driven, place) and all(
            math.dist(place[:2], taken[:2]) >= self._apart_m(driven.robot, other.robot)
            for other in others
            for taken in (other.position, self._posts.get(other.robot.id, other.position))
        )
