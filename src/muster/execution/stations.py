"""The stations of a mission during execution: which of them serve, whom, and who waits for a slot."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from muster.execution.robot_state import Activity, RobotState
from muster.mission.model import Station

AT_STATION = (Activity.TO_STATION, Activity.QUEUEING, Activity.SERVED)
"""What a robot does on a call."""


@dataclass
class Stations:
    """Who is at which station follows from what the robots do.

    Parameters
    ----------
    known
        by id.
    crew
        of the executor.
    failed
        those that serve nobody.
    cut_off
        those to which a robot found no way; they are planned for again when ways open.
    """

    known: Mapping[str, Station]
    crew: Mapping[str, RobotState]
    failed: set[str] = field(default_factory=set)
    cut_off: set[str] = field(default_factory=set)

    @classmethod
    def of(cls, stations: Iterable[Station], crew: Mapping[str, RobotState]) -> Stations:
        return cls({station.id: station for station in stations}, crew)

    @property
    def working(self) -> tuple[Station, ...]:
        """The stations that serve, and can be reached as far as is known."""
        return tuple(one for name, one in self.known.items() if name not in self.failed and name not in self.cut_off)

    def at(self, station: str) -> list[RobotState]:
        """The robots that are at a station or on the way to it."""
        return [state for state in self.crew.values() if state.activity in AT_STATION and state.station == station]

    def served(self, station: str) -> list[RobotState]:
        return [state for state in self.at(station) if state.activity is Activity.SERVED]

    def queue(self, station: str) -> list[RobotState]:
        """The robots that wait there, in the order in which they are served: of arrival, ties by id."""
        waiting = [state for state in self.at(station) if state.activity is Activity.QUEUEING]
        return sorted(waiting, key=lambda state: (state.queued_s, state.robot.id))

    def has_slot_for(self, state: RobotState) -> bool:
        """Whether a robot that waits at a station is the next for a slot that is free."""
        station = self.known[state.station]
        free = station.slots - len(self.served(station.id))
        return state in self.queue(station.id)[: max(0, free)]

    def free_slots(self, station: Station) -> int:
        """How many slots nobody is at, waits for, or is on the way to."""
        return station.slots - len(self.at(station.id))
