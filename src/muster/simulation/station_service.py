"""Stations of simulated worlds: robots that are served there, and stand there, get energy."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from muster.mission.model import Station
from muster.model.energy import Refill
from muster.simulation.port import Serving, SimulatedPort

NEAR_M = 0.5
"""Metres between the bodies of a robot and of one at the station, or the station itself, at which it is served."""
LOOK_S = 0.5
"""Seconds between two looks at the energy of robots."""


@dataclass
class WorldStations:
    """What stations add to the energy of robots, as time goes on.

    Parameters
    ----------
    stations
        of the mission.
    """

    stations: Mapping[str, Station]
    _given_s: dict[tuple[str, int, int], float] = field(default_factory=dict)  # to a robot, by order and way point

    @classmethod
    def of(cls, stations: Iterable[Station]) -> WorldStations:
        return cls({station.id: station for station in stations})

    def serve(self, port: SimulatedPort, before: Serving | None, seconds: float, largest_m: float) -> None:
        """Some time has gone by, in which a robot was served as it was said before; `largest_m`: the largest radius."""
        energy = port.energy
        if before is None or energy is None or before.station not in self.stations:
            return
        station = self.stations[before.station]
        if not _is_near(port, station, largest_m):
            return
        key = (port.robot, before.order, before.number)
        given_s = self._given_s.get(key, 0.0)
        over = port.serving != before
        until_s = before.hold_s if over and port.has_passed(before) else min(before.hold_s, given_s + seconds)
        refill = Refill.of(station)
        if refill is not None:
            energy.add(refill.added(until_s - given_s, ends=over and port.has_passed(before)))
        self._given_s = {} if over else {**self._given_s, key: until_s}


def _is_near(port: SimulatedPort, station: Station, largest_m: float) -> bool:
    here: Sequence[float] = port.true_position
    there = (*station.position, 0.0)[:3]
    return math.dist(here, there) <= port.body.radius_m + largest_m + NEAR_M
