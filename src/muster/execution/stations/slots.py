"""The stations of a mission during execution: which of them serve, whom, and who waits for a slot."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.station_calls import Call
from muster.mission.ignorable_rules import as_it_holds
from muster.mission.model import Station
from muster.model.energy import Refill
from muster.state import MissionState

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
    failed, cut_off
        of the state of the mission: those that serve nobody; those to which a robot found no way, which are planned
        for again when ways open.
    """

    known: Mapping[str, Station]
    crew: Mapping[str, RobotState]
    failed: Collection[str] = ()
    cut_off: Collection[str] = ()

    @classmethod
    def of(cls, state: MissionState, crew: Mapping[str, RobotState]) -> Stations:
        known = {one.id: as_it_holds(one, state.ledger.ignored) for one in state.mission.stations}
        return cls(known, crew, state.failed_stations, state.cut_off_stations)

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
        waiting = [one for one in self.at(station) if one.activity is Activity.QUEUEING and not one.away]
        return sorted(waiting, key=lambda state: (state.queued_s, state.robot.id))

    def has_slot_for(self, state: RobotState) -> bool:
        """Whether a robot that waits at a station is the next for a slot that is free."""
        station = self.known[state.station]
        free = station.slots - len(self.served(station.id))
        return state in self.queue(station.id)[: max(0, free)]

    def finds_slot(self, state: RobotState, now: float, after_s: float) -> bool:
        """Whether a slot will be free, as far as is known, for a robot that is not yet there and takes so many seconds.

        Robots on the way or there come first, and those that wait elsewhere for longer.
        """

        def before(other: RobotState) -> bool:
            if other.activity is Activity.SERVED:
                return other.service_left_s(now) > after_s
            since = (state.queued_s, state.robot.id) if state.away else (math.inf, "")
            return not other.away or (other.queued_s, other.robot.id) < since

        taken = sum(before(other) for other in self.at(state.station) if other is not state)
        return taken < self.known[state.station].slots

    def refill(self, station: str) -> Refill | None:
        """The service of a station that adds energy; None: it adds none."""
        return Refill.of(self.known[station])

    def next_refill(self, calls: Sequence[Call]) -> Call | None:
        """The first of some calls at which energy is to be had."""
        return next((call for call in calls if self.refill(call.station) is not None), None)

    def used_until_refill(self, state: RobotState) -> float:
        """What a robot uses after its next call until it is refilled again, or its route ends, as planned."""
        if not state.calls:
            return 0.0
        call, *later = state.calls
        after = self.next_refill(later)
        return call.left - (0.0 if after is None else after.left)

    def free_slots(self, station: Station) -> int:
        """How many slots nobody is at, waits for, or is on the way to."""
        return station.slots - len(self.at(station.id))
