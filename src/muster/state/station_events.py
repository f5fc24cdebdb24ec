"""Events of energy, stations and doors: robots that run low, calls at stations, ways that close and open."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Self

from muster.state import words
from muster.state.event import ExecutionEvent, happens
from muster.state.goods_ledger import tied_goods

if TYPE_CHECKING:
    from muster.state.mission_state import MissionState


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


@happens("goes_to_station", words.goes_to_station)
class GoesToStation(AtStation):
    """A robot sets out for a station."""


@happens("arrives_at_station", words.arrives_at_station)
class ArrivesAtStation(AtStation):
    """A robot is at a station."""


@happens("waits_for_slot", words.waits_for_slot)
class WaitsForSlot(AtStation):
    """A robot waits until a station has a slot for it."""

    served: tuple[str, ...] = ()


@happens("service_begins", words.service_begins)
class ServiceBegins(AtStation):
    """A robot is served, for so long."""

    services: tuple[str, ...]
    takes_s: float


@happens("service_ends", words.service_ends)
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


@happens("energy_low", words.energy_low)
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
