"""Service at stations: robots go there, wait for a slot, and get energy or unload."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from muster.execution.record import Tell
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.station_calls import Call
from muster.execution.robots.task_motion import along, place, travel_s
from muster.execution.stations.energy_watch import has_tasks_without_robot
from muster.execution.stations.slots import Stations
from muster.motion.port import Place, Waypoint
from muster.state.goods_ledger import GoodsLedger, tied_goods
from muster.state.station_events import (
    ArrivesAtStation,
    GoesToStation,
    RobotRefilled,
    ServiceBegins,
    ServiceEnds,
    StationUnreachable,
    WaitsForSlot,
)
from muster.state.task_ledger import Ledger

AT_SLOT_M = 0.3
"""Metres between two bodies at a station, or between the middle of one and the station, that count as being there."""
_MISSING = 1e-3  # share of the capacity by which what was added may stay behind


@dataclass
class StationService:
    """Carries out calls at stations, one robot a method call.

    Parameters
    ----------
    stations, ledger, goods
        of the executor.
    way
        from where a robot is; None: there is none.
    emit, ask
        receive events, and changes that require a new plan.
    """

    stations: Stations
    ledger: Ledger
    goods: GoodsLedger
    way: Callable[[RobotState, Place], Sequence[Waypoint] | None]
    emit: Tell
    ask: Tell

    def advance(self, state: RobotState, now: float) -> None:
        """Check whether a robot has arrived at a station, or its service is over."""
        if state.activity is Activity.TO_STATION and (state.arrived or self._is_there(state)):
            self._arrive(state, now)
        elif state.activity is Activity.SERVED and state.arrived:
            self._end(state, now)

    def set_out(self, state: RobotState, call: Call, now: float) -> None:
        """Send a robot to a station; one with a body waits where it is until there will be a slot when it comes.

        Bodies that wait before a slot are in the way of each other and of those that leave it.
        """
        state.station, state.at_home, state.work = call.station, False, None
        if self._finds_slot(state, now):
            self._drive(state, now)
            return
        state.send(now, Activity.QUEUEING, ())
        state.queued_s, state.away = now, True
        self._say_wait(state)

    def serve_or_wait(self, state: RobotState, now: float) -> None:
        """Begin the service of a robot that waits for a slot, or let it go there, or say for what it waits."""
        if state.away and self._finds_slot(state, now):
            state.slot_wait_s += now - state.queued_s
            self._drive(state, now)
        elif not state.away and self.stations.has_slot_for(state):
            self._begin(state, now)
        else:
            self._say_wait(state)

    def _finds_slot(self, state: RobotState, now: float) -> bool:
        if state.robot.radius_m == 0:
            return True
        least_s = state.times.least_seconds(math.dist(state.position, self._place(state)))
        return self.stations.finds_slot(state, now, least_s)

    def _drive(self, state: RobotState, now: float) -> None:
        way = self.way(state, self._place(state))
        if way is not None and state.rests(travel_s(state.times, state.position, along(way)), now):
            return
        state.away, state.wait_words = False, ""
        if way is None:
            state.stop(now)
            self.ask(StationUnreachable(station=state.station, robot=state.robot.id))
            return
        state.send(now, Activity.TO_STATION, along(way, state.station))
        self.emit(GoesToStation.of(*_at(state)))

    def _say_wait(self, state: RobotState) -> None:
        served = [other.robot.id for other in self.stations.served(state.station)]
        words = f"waits for a slot at {state.station}: {', '.join(served) or 'others come first'}"
        if not state.wait_words:
            self.emit(WaitsForSlot(robot=state.robot.id, station=state.station, served=tuple(served)))
        state.wait_words = words

    def _arrive(self, state: RobotState, now: float) -> None:
        state.note_energy()
        if state.arrived:
            state.begin_activity(now, Activity.QUEUEING)
        else:
            state.send(now, Activity.QUEUEING, ())
        state.queued_s, state.sent_again = now, 0
        self.emit(ArrivesAtStation.of(*_at(state)))

    def _is_there(self, state: RobotState) -> bool:
        """Whether a robot is as near to a station as others that are there let it."""
        others = [one for one in self.stations.at(state.station) if one is not state and not one.away]
        if state.robot.radius_m == 0 or not others:
            return False
        stand = [one.robot.radius_m for one in others if one.activity is not Activity.TO_STATION]
        near_m = max(stand) + state.robot.radius_m if stand else 0.0
        return math.dist(state.position, self._place(state)) <= near_m + AT_SLOT_M

    def _place(self, state: RobotState) -> Place:
        return place(self.stations.known[state.station].position)

    def _begin(self, state: RobotState, now: float) -> None:
        station = self.stations.known[state.station]
        state.slot_wait_s += now - state.queued_s
        state.wait_words = ""
        others = self.stations.served(station.id)
        there = state.position if others and state.robot.radius_m > 0 else self._place(state)
        state.note_energy()
        state.service_s = _takes_s(self.stations, state)
        state.send(
            now,
            Activity.SERVED,
            [Waypoint(there, hold_s=state.service_s, label=station.id, uses=0.0, service=station.id)],
        )
        takes_s = round(state.service_s, 6)
        self.emit(ServiceBegins.of(*_at(state), services=tuple(station.services), takes_s=takes_s))

    def _end(self, state: RobotState, now: float) -> None:
        station = self.stations.known[state.station]
        before = 0.0 if state.energy is None else state.energy.level
        state.note_energy()
        if state.energy is not None and state.energy.told and self._goes_on(state, before, now):
            return
        if state.energy is not None and not state.energy.told:
            state.energy.add(to_add(self.stations, state))
        gone = self.goods.loose(state.robot.id, tied_goods(self.ledger)) if station.unloads else {}
        call = state.call
        if call is not None:
            state.calls.remove(call)
        state.visits += 1
        state.warned_short = 0.0
        state.begin_activity(now, Activity.IDLE)
        self.emit(ServiceEnds.of(*_at(state), unloaded=gone))
        state.refilled_idle = call is not None and not call.planned
        if state.refilled_idle and has_tasks_without_robot(self.ledger, self.stations.crew):
            self.ask(RobotRefilled(robot=state.robot.id, station=station.id))

    def extend(self, state: RobotState, now: float) -> None:
        """Let it be served on, beyond what the service under way was to bring, as far as the robot's call says now."""
        refill = self.stations.refill(state.station)
        if state.energy is None or refill is None or refill.rate is None:
            return
        state.note_energy()
        left_s = _takes_s(self.stations, state) - (0.0 if state.energy.told else now - state.begun_s)
        if left_s > state.service_left_s(now):
            self._stay(state, left_s, now)

    def _stay(self, state: RobotState, left_s: float, now: float) -> None:
        begun = state.begun_s
        hold = Waypoint(state.position, hold_s=left_s, label=state.station, uses=0.0, service=state.station)
        state.send(now, Activity.SERVED, [hold])
        state.begun_s, state.service_s = begun, now - begun + left_s

    def _goes_on(self, state: RobotState, before: float, now: float) -> bool:
        """Go on where telemetry tells that less was added than was to be, as long as anything is."""
        missing = to_add(self.stations, state)
        energy = state.energy
        if energy is None or missing <= _MISSING * energy.capacity or energy.level <= before:
            return False
        self._stay(state, _takes_s(self.stations, state), now)
        return True


def to_add(stations: Stations, state: RobotState) -> float:
    """What a robot is still to get at its station, in the unit of usage: as planned, and what it has learnt to need."""
    energy, refill, call = state.energy, stations.refill(state.station), state.call
    if energy is None or refill is None:
        return 0.0
    return energy.to_add(refill, None if call is None else call.until, stations.used_until_refill(state))


def _takes_s(stations: Stations, state: RobotState) -> float:
    """Seconds that the service of a robot takes."""
    refill = stations.refill(state.station)
    return 0.0 if refill is None or state.energy is None else refill.seconds(to_add(stations, state))


def _at(state: RobotState) -> tuple[str, str, float | None, float]:
    """What events of stations tell of a robot: who is where, with what share of its energy, and its usage."""
    return state.robot.id, state.station, None if state.energy is None else state.energy.share, state.used
