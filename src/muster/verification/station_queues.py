"""Who is served when at a station: in the order that a plan states, or in the order of arrival.

A station serves no more robots at once than it has slots. One that comes later in its order is not served earlier; a
robot uses a slot from the begin to the end of its service, and none where that takes no time.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from muster.mission.plan import tie_order
from muster.verification.measure import MeasuredRoute, Service


class Turn(NamedTuple):
    """One visit of a station: the station, the robot, and the place in its route from 0."""

    station: str
    robot: str
    place: int


@dataclass
class Queue:
    """One station while its visits are gone through in its order: the ends of the last services, one a slot."""

    slots: int
    ends: list[tuple[float, int, Turn]] = field(default_factory=list)
    last: tuple[float, Turn] | None = None
    taken: int = 0

    def bounds(self) -> list[tuple[float, Turn]]:
        """The moments before which nobody else is served, each with the visit that makes it."""
        full = [(self.ends[0][0], self.ends[0][2])] if len(self.ends) >= self.slots else []
        return full if self.last is None else [*full, self.last]

    def take(self, turn: Turn, begin: float, seconds: float) -> None:
        """Serve the next visit."""
        self.last = (begin, turn)
        if seconds <= 0:
            return
        self.taken += 1
        end = (begin + seconds, self.taken, turn)
        if len(self.ends) >= self.slots:
            heapq.heappushpop(self.ends, end)
        else:
            heapq.heappush(self.ends, end)


class Stations:
    """The visits of all stations in some routes."""

    def __init__(self, routes: Sequence[MeasuredRoute]) -> None:
        self.visits: dict[Turn, Service] = {
            Turn(stop.station.id, route.robot.id, k): stop
            for route in routes
            for k, stop in enumerate(route.stops)
            if isinstance(stop, Service)
        }
        names = [route.robot.id for route in routes]
        self._rank = {names[i]: k for k, i in enumerate(tie_order(names))}
        self._slots = {turn.station: visit.station.slots for turn, visit in self.visits.items()}

    def queues(self) -> dict[str, Queue]:
        """The queue of each station that is visited, before anybody is served."""
        return {name: Queue(slots) for name, slots in self._slots.items()}

    def by_station(self) -> dict[str, list[Turn]]:
        """The visits of each station."""
        found: dict[str, list[Turn]] = {}
        for turn in self.visits:
            found.setdefault(turn.station, []).append(turn)
        return found

    def stated(self) -> dict[str, list[Turn]]:
        """The visits of each station all of whose begins the plan states, in that order."""
        return {
            station: sorted(turns, key=self._stated_turn)
            for station, turns in self.by_station().items()
            if all(self.visits[turn].call.turn is not None for turn in turns)
        }

    def _stated_turn(self, turn: Turn) -> tuple[tuple[float, float], int, int]:
        stated = self.visits[turn].call.turn
        assert stated is not None
        return stated, *self.rank(turn)

    def rank(self, turn: Turn) -> tuple[int, int]:
        """What breaks ties between visits: ids of robots in their order, then places in a route."""
        return self._rank[turn.robot], turn.place
