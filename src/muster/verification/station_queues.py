"""Who is served when at a station: in the order that a plan states, or in the order of arrival.

A station serves no more robots at once than it has slots. One that comes later in its order is not served earlier; a
robot uses a slot from the begin to the end of its service, and none where that takes no time.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from graphlib import TopologicalSorter
from typing import NamedTuple

from muster.mission.plan import tie_order
from muster.verification.measure import MeasuredRoute, Service


class Turn(NamedTuple):
    """One visit of a station: the station, the robot, and the place in its route from 0."""

    station: str
    robot: str
    place: int


Name = str | Turn
"""Of a stop: the id of a task, or the visit of a station."""

Graph = Mapping[Name, set[Name]]


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

    def stated(self, before: Graph) -> dict[str, list[Turn]]:
        """The visits of each station all of whose begins the plan states, in that order.

        Ties go by arrivals and ids of robots, where `before` does not say that one visit leads to the other.
        """
        known = {
            station: turns
            for station, turns in self.by_station().items()
            if all(self.visits[turn].call.turn is not None for turn in turns)
        }
        if not known:
            return {}
        gone = self.in_turn(before, {}, self._stated_turn)
        return {station: sorted(gone[station], key=self._stated_turn) for station in known}

    def _stated_turn(self, turn: Turn) -> tuple[float, float]:
        return self.visits[turn].call.turn or (math.inf, math.inf)

    def in_turn(
        self,
        before: Graph,
        known: Mapping[str, Sequence[Turn]],
        arrives: Callable[[Turn], float | tuple[float, float]],
        begin: Callable[[Name], None] = lambda _: None,
    ) -> dict[str, list[Turn]]:
        """The order in which each station serves, if all stops begin one after another.

        Whoever is first of all that wait anywhere is served next: what has not arrived yet waits for one of these, and
        arrives later.

        Parameters
        ----------
        before
            for each node those that begin before it, without a cycle.
        known
            the orders that are known, which `before` keeps.
        arrives
            what visits of the other stations are sorted by, once all before them has begun.
        begin
            is called for each node in turn.
        """
        sorter = TopologicalSorter(before)
        sorter.prepare()
        served = {station: list(turns) for station, turns in known.items()}
        waiting: list[tuple[float | tuple[float, float], tuple[int, int], Turn]] = []
        while sorter.is_active():
            ready = sorter.get_ready()
            for name in ready:
                if isinstance(name, Turn) and name.station not in known:
                    heapq.heappush(waiting, (arrives(name), self.rank(name), name))
                    continue
                begin(name)
                sorter.done(name)
            if not ready:
                turn = heapq.heappop(waiting)[-1]
                served.setdefault(turn.station, []).append(turn)
                begin(turn)
                sorter.done(turn)
        return served

    def rank(self, turn: Turn) -> tuple[int, int]:
        """What breaks ties between visits: ids of robots in their order, then places in a route."""
        return self._rank[turn.robot], turn.place
