"""Events of energy, stations and doors: robots that run low, calls at stations, ways that close and open."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Self

from muster.mission.stations import station_sign
from muster.state import words
from muster.state.event import ExecutionEvent, happens
from muster.state.goods_ledger import tied_goods

if TYPE_CHECKING:
    from muster.state.mission_state import MissionState


EMPTY = "its battery is empty"
"""Why a robot takes no part any more that has no energy left."""


def energy_low(data: words.Data) -> str:
    return f"{data.get('robot', '?')} has too little in its battery for what lies ahead" + _charge(data)


def goes_to_station(data: words.Data) -> str:
    return f"{data.get('robot')} goes to {_station(data)}{_charge(data)}"


def arrives_at_station(data: words.Data) -> str:
    return f"{data.get('robot')} is at {_station(data)}{_charge(data)}"


def waits_for_slot(data: words.Data) -> str:
    """`r_1 waits for a slot at [dock]: r_0 is served there`."""
    served = [str(robot) for robot in data.get("served", ())]
    line = f"{data.get('robot')} waits for a slot at {_station(data)}"
    return f"{line}: {', '.join(served)} {'is' if len(served) == 1 else 'are'} served there" if served else line


def service_begins(data: words.Data) -> str:
    """`r_0 is served at [dock]: charge, 58.5 s (48 % in its battery)`."""
    services, takes_s = ", ".join(data.get("services", ())), data.get("takes_s", 0.0)
    return f"{data.get('robot')} is served at {_station(data)}: {services}, {takes_s:.1f} s{_charge(data)}"


def service_ends(data: words.Data) -> str:
    """`r_0 has been served at [dock]: unloaded kg 3 (100 % in its battery)`."""
    gone = data.get("unloaded") or {}
    told = ", ".join(f"{name} {words.amount(much)}".strip() for name, much in gone.items())
    line = f"{data.get('robot')} has been served at {_station(data)}"
    return f"{line}{f': unloaded {told}' if told else ''}{_charge(data)}"


def _station(data: words.Data) -> str:
    return station_sign(str(data.get("station")))


def _charge(data: words.Data) -> str:
    share = data.get("charge")
    return f" ({100 * share:.0f} % in its battery)" if isinstance(share, int | float) else ""


@dataclass(frozen=True, kw_only=True)
class AtStation(ExecutionEvent):
    """What a robot does on a call at a station; `charge` is the share that its battery holds."""

    robot: str
    station: str
    charge: float | None = None
    used: float | None = None

    @classmethod
    def of(cls, robot: str, station: str, share: float | None, used: float, **more: Any) -> Self:
        """Return the event of a robot that holds a share of its energy, None: of none; and has used so much."""
        return cls(robot=robot, station=station, charge=None if share is None else round(share, 6), used=used, **more)

    def change(self, state: MissionState) -> None:
        state.note_used(self.robot, self.used, self.charge)


@happens("goes_to_station", goes_to_station)
class GoesToStation(AtStation):
    """A robot sets out for a station."""

    def change(self, state: MissionState) -> None:
        super().change(state)
        if (robot := state.robots.get(self.robot)) is not None:
            robot.leave(self.time_s)


@happens("arrives_at_station", arrives_at_station)
class ArrivesAtStation(AtStation):
    """A robot is at a station."""


@happens("waits_for_slot", waits_for_slot)
class WaitsForSlot(AtStation):
    """A robot waits until a station has a slot for it."""

    served: tuple[str, ...] = ()


@happens("service_begins", service_begins)
class ServiceBegins(AtStation):
    """A robot is served, for so long."""

    services: tuple[str, ...]
    takes_s: float


@happens("service_ends", service_ends)
class ServiceEnds(AtStation):
    """A robot has been served; `unloaded` is by commodity."""

    written = ("unloaded",)
    unloaded: Mapping[str, float] = field(default_factory=dict)

    def change(self, state: MissionState) -> None:
        super().change(state)
        if (robot := state.robots.get(self.robot)) is not None:
            robot.stops.append(self.station)
        if self.unloaded:
            state.goods.unload(self.robot, tied_goods(state.ledger))


@happens("energy_low", energy_low)
class EnergyLow(ExecutionEvent):
    """A battery does not last for what lies ahead; `charge` is a share, `missing` in the mission's unit."""

    robot: str
    charge: float
    missing: float
    drain: float

    @classmethod
    def of(cls, robot: str, share: float, missing: float, drain: float) -> Self:
        """Return the event of a robot that holds a share of its energy, which drains so fast."""
        return cls(robot=robot, charge=round(share, 6), missing=round(missing, 6), drain=round(drain, 4))


@happens("robot_charged", "{robot} is charged")
class RobotRefilled(ExecutionEvent):
    """A robot that went to charge of itself is free for tasks."""

    robot: str
    station: str


@happens("station_fails", "station {station} fails", mark=words.ALARM)
class StationFails(ExecutionEvent):
    """A station serves nobody from now on."""

    station: str

    def change(self, state: MissionState) -> None:
        state.failed_stations.add(self.station)


@happens("station_returns", "station {station} serves again", mark=words.CHANGE)
class StationReturns(ExecutionEvent):
    """A station serves again."""

    station: str

    def change(self, state: MissionState) -> None:
        state.failed_stations.discard(self.station)


@happens("station_unreachable", "{robot} has no way to station {station}", mark=words.ALARM)
class StationUnreachable(ExecutionEvent):
    """A robot finds no way to a station: nobody is sent there before ways open."""

    station: str
    robot: str
    reason: str = ""

    def change(self, state: MissionState) -> None:
        state.cut_off_stations.add(self.station)


@happens("door_closes", "door {door} closes", mark=words.CHANGE)
class DoorCloses(ExecutionEvent):
    """A zone or lane is closed from now on."""

    door: str

    def change(self, state: MissionState) -> None:
        state.doors.close(self.door)


@happens("door_opens", "door {door} opens", mark=words.CHANGE)
class DoorOpens(ExecutionEvent):
    """A zone or lane is open from now on."""

    door: str

    def change(self, state: MissionState) -> None:
        state.doors.open(self.door)
        state.open_ways()
