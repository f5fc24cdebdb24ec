"""Watches the energy of robots: who runs low on the way, who is empty, and who goes to a station of itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from muster.execution.record import Tell
from muster.execution.robots.robot_energy import RobotEnergy
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.station_calls import Call
from muster.execution.robots.task_motion import along, path_length, place, travel_s
from muster.execution.stations.slots import Stations
from muster.mission.model import Station
from muster.motion.port import Place, Waypoint
from muster.state.station_events import EnergyLow
from muster.state.task_ledger import Ledger

TOLERANCE = 0.01
"""Share of the capacity by which a level may be lower than planned; a robot arrives with at least as much."""
_LOW = 0.05  # share of the capacity above what brings a robot to a station, with which it goes there if it is free
_FULL = 0.99
_ORDER = 0.2  # share of the capacity that an order takes, as long as none is done
_TELLING, _AS_PLANNED = 5, 1.02  # tasks that tell how much more is used than planned; up to so many times is as planned


@dataclass
class EnergyWatch:
    """Looks at robots that usage empties.

    Parameters
    ----------
    stations, crew, ledger
        of the executor.
    way
        from where a robot is; None: there is none.
    ahead
        by robot what it uses after each task of its route, by the plan in force.
    ask
        receives events that ask for a new plan.
    on_duty
        whether the fleet stays on duty now, so that orders may come.
    """

    stations: Stations
    crew: Mapping[str, RobotState]
    ledger: Ledger
    way: Callable[[RobotState, Place], Sequence[Waypoint] | None]
    ahead: Callable[[], Mapping[str, Mapping[str, float]]]
    ask: Tell
    on_duty: Callable[[], bool] = lambda: False
    _learnt_from: int = 0
    _usages: dict[str, tuple[Place, dict[Place, float | None]]] = field(default_factory=dict)  # from where robots are

    def forget_ways(self) -> None:
        """Forget what ways use: they are others from now on."""
        self._usages.clear()

    def empty(self) -> Iterator[RobotState]:
        """Robots whose telemetry tells that they are empty."""
        return (one for one in self.crew.values() if not one.out and one.energy is not None and one.energy.is_empty)

    def look(self, now: float) -> None:
        """Robots whose energy does not last to their next refill, or the end of their route: they are planned anew."""
        self._learn_detours()
        for state in self.crew.values():
            energy = state.energy
            if state.out or energy is None:
                continue
            missing = self._missing(state, energy, now)
            if missing <= state.warned_short + TOLERANCE * energy.capacity:
                continue
            state.warned_short = missing
            if state.activity is Activity.RETURNING:
                state.stop(now)
                continue
            self.ask(EnergyLow.of(state.robot.id, energy.share, missing, energy.drain))

    def _learn_detours(self) -> None:
        """Note how much more robots use than planned, be it for others in their way, or for turns."""
        usages = self.ledger.usage.values()
        if len(usages) == self._learnt_from or len(usages) < _TELLING:
            return
        self._learnt_from = len(usages)
        planned, flown = sum(one for one, _ in usages), sum(one for _, one in usages)
        for state in self.crew.values():
            if state.energy is not None:
                state.energy.detours = flown / planned if flown > _AS_PLANNED * planned > 0 else 1.0

    def _missing(self, state: RobotState, energy: RobotEnergy, now: float) -> float:
        """By how much a robot would come below its reserve before it is refilled next; below 0: it does not."""
        if state.activity is Activity.RETURNING:
            needed = state.travel_left_s if state.in_time else state.way_left_m
        elif state.activity in (Activity.DRIVING, Activity.WORKING) and state.route:
            after = self.ahead().get(state.robot.id, {}).get(state.route[0])
            if after is None:
                return 0.0
            call = self.stations.next_refill(state.calls)
            needed = state.used_after(now) - state.used + after - (0.0 if call is None else call.left)
        else:
            return 0.0
        return energy.missing_for(needed)

    def own_call(self, state: RobotState) -> Call | None:
        """Where a robot goes for energy that has nothing to do, if it is to; None: it stays, or goes home.

        It goes once, until it has something to do again.
        """
        energy = state.energy
        if energy is None or energy.share >= _FULL or state.refilled_idle:
            return None
        short = self._is_short_of_home(state, energy)
        if not (short or self.on_duty() or has_tasks_without_robot(self.ledger, self.crew)):
            return None
        found = self._nearest(state, energy)
        if found is not None and (short or self._is_low(energy, *found)):
            return Call(found[0].id, None, planned=False)
        return None

    def _is_short_of_home(self, state: RobotState, energy: RobotEnergy) -> bool:
        """Whether the energy of a robot that is to go home does not bring it there."""
        if state.home is None or state.at_home:
            return False
        home = self._usage(state, state.home)
        return home is not None and energy.missing_for(home) > 0

    def _is_low(self, energy: RobotEnergy, station: Station, to_station: float) -> bool:
        """Whether a robot for which there may be work had better be refilled first."""
        if energy.missing_for(to_station) > -_LOW * energy.capacity:
            return True
        order = self._mean_usage(energy.capacity)
        free = self.stations.free_slots(station) > 0
        return self.on_duty() and free and energy.missing_for(order + to_station) > 0

    def gets_home(self, state: RobotState) -> bool:
        """Whether the energy of a robot brings it to where its route ends, its reserve included."""
        if state.energy is None or state.home is None:
            return True
        home = self._usage(state, state.home)
        return home is None or state.energy.level >= state.energy.drain * home

    def _nearest(self, state: RobotState, energy: RobotEnergy) -> tuple[Station, float] | None:
        """The station that gives it energy to which a robot uses least, and that; None: it reaches none."""
        ways = [(self._usage(state, place(s.position)), s) for s in self._open_to(state)]
        left = energy.level - TOLERANCE * energy.capacity
        near = [(usage, s) for usage, s in ways if usage is not None and energy.drain * usage <= left]
        if not near:
            return None
        usage, station = min(near, key=lambda one: (self.stations.free_slots(one[1]) <= 0, one[0], one[1].id))
        return station, usage

    def _open_to(self, state: RobotState) -> list[Station]:
        """The stations that give a robot energy."""
        return [one for one in self.stations.working if one.gives_energy and one.id not in state.limits.closed]

    def _usage(self, state: RobotState, goal: Place) -> float | None:
        """What the way from where a robot is to a place uses; None where there is none.

        A robot that stays where it is asks again and again.
        """
        at, known = self._usages.get(state.robot.id, (None, {}))
        if at != state.position:
            known = {}
            self._usages[state.robot.id] = state.position, known
        if goal not in known:
            known[goal] = self._usage_of_way(state, goal)
        return known[goal]

    def _usage_of_way(self, state: RobotState, goal: Place) -> float | None:
        way = self.way(state, goal)
        if way is None:
            return None
        there = along(way)
        return travel_s(state.times, state.position, there) if state.in_time else path_length(state.position, there)

    def _mean_usage(self, capacity: float) -> float:
        """What a task of this fleet takes, on average of those that are remembered."""
        usages = [flown for _, flown in self.ledger.usage.values()]
        return sum(usages) / len(usages) if usages else _ORDER * capacity


def has_tasks_without_robot(ledger: Ledger, crew: Mapping[str, RobotState]) -> bool:
    """Whether there are tasks that could be done, and that no robot is to do."""
    barred = ledger.barred
    routed = {name for state in crew.values() if not state.out for name in state.route}
    return any(task.id not in routed and task.id not in barred for task in ledger.open)
