"""Events of robots: those that take part or do not, their ends, and how they pass each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from muster.state.event import ExecutionEvent, happens

if TYPE_CHECKING:
    from muster.state.mission_state import MissionState


@dataclass(frozen=True, kw_only=True)
class RobotOut(ExecutionEvent):
    """A robot takes no part any more: what it was at is free for others."""

    robot: str
    reason: str = ""

    def change(self, state: MissionState) -> None:
        state.take_out(self.robot, self.kind, self.time_s)


@happens("robot_fails", alarming=True)
class RobotFails(RobotOut):
    """A robot has failed, and what it has on board lies where it is."""

    def change(self, state: MissionState) -> None:
        super().change(state)
        state.goods.fall(self.robot)


@happens("robot_silent", alarming=True)
class RobotSilent(RobotOut):
    """A robot is not heard any more; `goes_on`: it decides for itself, and goes on with its work."""

    goes_on: bool = False

    def change(self, state: MissionState) -> None:
        if not self.goes_on:
            super().change(state)


@happens("robot_stuck", alarming=True)
class RobotStuck(RobotOut):
    """A robot does not get on."""


@happens("robot_returns")
class RobotReturns(ExecutionEvent):
    """A robot takes part again."""

    robot: str
    reason: str = ""

    def change(self, state: MissionState) -> None:
        if (robot := state.robots.get(self.robot)) is not None:
            robot.out = ""
        state.open_ways()


@happens("robot_joins")
class RobotJoins(ExecutionEvent):
    """A robot joins: as in a mission file, or the id of one of the mission's events."""

    robot: Mapping[str, Any] | str

    def change(self, state: MissionState) -> None:
        state.join(state.robot_of(self.robot))


@happens("returns")
class Returns(ExecutionEvent):
    """A robot goes to where its route ends."""

    robot: str


@happens("robot_at_end")
class RobotAtEnd(ExecutionEvent):
    """A robot is where its route ends."""

    robot: str


@happens("no_way_to_end")
class NoWayToEnd(ExecutionEvent):
    """A robot has no way to where its route ends, and stays."""

    robot: str


@happens("robot_runs_low")
class RobotRunsLow(ExecutionEvent):
    """The capacity of a robot is too small for its route."""

    robot: str
    capacity: float | None


@happens("energy_low")
class EnergyLow(ExecutionEvent):
    """A battery does not last for what lies ahead; `charge` is a share, `missing` in the mission's unit."""

    robot: str
    charge: float
    missing: float
    drain: float


@happens("robot_charged")
class RobotCharged(ExecutionEvent):
    """A robot that went to charge of itself is free for tasks."""

    robot: str
    station: str


@happens("robot_sent_again")
class RobotSentAgain(ExecutionEvent):
    """A robot without progress is sent once more."""

    robot: str
    reason: str


@happens("robot_goes_round")
class RobotGoesRound(ExecutionEvent):
    """A robot goes round one that stands."""

    robot: str
    round: str


@happens("robot_makes_room")
class RobotMakesRoom(ExecutionEvent):
    """A robot that has nothing to do goes off the way of another."""

    robot: str
    makes_room_for: str


@happens("robot_stands_aside")
class RobotStandsAside(ExecutionEvent):
    """A robot stands aside in a jam."""

    robot: str
    waits_for: str


@happens("waits_in_traffic")
class WaitsInTraffic(ExecutionEvent):
    """A robot waits for another that is in its way, since when and where."""

    robot: str
    waits_for: str
    position: tuple[float, ...]
    since_s: float


@happens("goes_on")
class GoesOn(ExecutionEvent):
    """A robot that waited in traffic goes on; `waited_s` is by robot for how long it waited for it."""

    robot: str
    until_s: float
    waited_s: Mapping[str, float]
    position: tuple[float, ...] = ()

    def change(self, state: MissionState) -> None:
        x, y, z = (*self.position, 0.0, 0.0, 0.0)[:3]
        state.traffic.add(self.robot, self.waited_s, (x, y, z))


@happens("traffic_jam", alarming=True)
class TrafficJam(ExecutionEvent):
    """Robots hold each other up."""

    robots: tuple[str, ...]
    position: tuple[float, ...]
    since_s: float


@happens("final_states")
class FinalStates(ExecutionEvent):
    """Where robots are at the end, and whether they still fly, drive or are armed."""

    robots: tuple[Mapping[str, Any], ...]


@happens("elsewhere")
class Elsewhere(ExecutionEvent):
    """A robot does not stand where the mission says."""

    what: str


@happens("robots_free")
class RobotsFree(ExecutionEvent):
    """No robot has a task any more, and another plan may do tasks that were left out."""

    left_out: tuple[str, ...] = field(default_factory=tuple)
