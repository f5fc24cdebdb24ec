"""Events of robots: those that take part or do not, their ends, and how they pass each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from muster.state import words
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


@happens("robot_fails", "{robot} is out", mark=words.ALARM)
class RobotFails(RobotOut):
    """A robot has failed, and what it has on board lies where it is."""

    def change(self, state: MissionState) -> None:
        super().change(state)
        state.goods.fall(self.robot)


@happens("robot_silent", "{robot} is not heard any more", mark=words.ALARM)
class RobotSilent(RobotOut):
    """A robot is not heard any more; `goes_on`: it decides for itself, and goes on with its work."""

    goes_on: bool = False

    def change(self, state: MissionState) -> None:
        if not self.goes_on:
            super().change(state)


@happens("robot_suspended", "{robot} takes no part for now", mark=words.ALARM)
class RobotSuspended(RobotOut):
    """A robot is heard, and somebody else has it: a pilot, a failsafe of its own. It takes part again afterwards."""


@happens("robot_stuck", "{robot} does not get on", mark=words.ALARM)
class RobotStuck(RobotOut):
    """A robot does not get on."""


@happens("robot_removed", "{robot} is taken away", mark=words.ALARM)
class RobotRemoved(RobotOut):
    """Somebody takes a robot away, with what it has on board: its place is free."""

    def change(self, state: MissionState) -> None:
        super().change(state)
        state.open_ways()


@happens("robot_moved", "{robot} is moved to {position}", mark=words.CHANGE)
class RobotMoved(ExecutionEvent):
    """Somebody moves a robot: coordinates in the map frame, metres. Work that it was at is broken off.

    Where it was it is in nobody's way any more, and from where it is there may be ways that it did not have.
    """

    robot: str
    position: tuple[float, ...]

    def change(self, state: MissionState) -> None:
        state.break_off_work(self.robot)
        state.open_ways()


@happens("robot_returns", "{robot} takes part again", mark=words.CHANGE)
class RobotReturns(ExecutionEvent):
    """A robot takes part again."""

    robot: str
    reason: str = ""

    def change(self, state: MissionState) -> None:
        if (robot := state.robots.get(self.robot)) is not None:
            robot.out = ""
        state.open_ways()


@happens("robot_joins", "{robot} joins", mark=words.CHANGE)
class RobotJoins(ExecutionEvent):
    """A robot joins: as in a mission file, or the id of one of the mission's events."""

    robot: Mapping[str, Any] | str

    def change(self, state: MissionState) -> None:
        state.join(state.robot_of(self.robot))


@happens("returns", "{robot} goes to where its route ends")
class Returns(ExecutionEvent):
    """A robot goes to where its route ends."""

    robot: str


@happens("robot_at_end", "{robot} is where its route ends")
class RobotAtEnd(ExecutionEvent):
    """A robot is where its route ends."""

    robot: str


@happens("no_way_to_end", "{robot} has no way to where its route ends, and stays", mark=words.ALARM)
class NoWayToEnd(ExecutionEvent):
    """A robot has no way to where its route ends, and stays."""

    robot: str


@happens("robot_runs_low", "the capacity of {robot} is too small for its route")
class RobotRunsLow(ExecutionEvent):
    """The capacity of a robot is too small for its route."""

    robot: str
    capacity: float | None


@happens("robot_sent_again", "{robot} is sent again")
class RobotSentAgain(ExecutionEvent):
    """A robot without progress is sent once more."""

    robot: str
    reason: str


@happens("robot_goes_round", "{robot} goes round {round}, which stands in its way")
class RobotGoesRound(ExecutionEvent):
    """A robot goes round one that stands."""

    robot: str
    round: str


@happens("way_closed", words.way_closed, mark=words.CHANGE)
class WayClosed(ExecutionEvent):
    """An obstacle closes the way of a robot: it goes by another, longer by so many metres; None: there is none."""

    robot: str
    longer_m: float | None = None


@happens("robot_makes_room", "{robot} makes room for {makes_room_for}")
class RobotMakesRoom(ExecutionEvent):
    """A robot that has nothing to do goes off the way of another."""

    robot: str
    makes_room_for: str


@happens("robot_stands_aside", "{robot} stands aside for {waits_for}")
class RobotStandsAside(ExecutionEvent):
    """A robot stands aside in a jam."""

    robot: str
    waits_for: str


@happens("waits_in_traffic", "{robot} waits in traffic for {waits_for}, at {position}")
class WaitsInTraffic(ExecutionEvent):
    """A robot waits for another that is in its way, since when and where."""

    robot: str
    waits_for: str
    position: tuple[float, ...]
    since_s: float


@happens("goes_on", words.goes_on)
class GoesOn(ExecutionEvent):
    """A robot that waited in traffic goes on; `waited_s` is by robot for how long it waited for it."""

    robot: str
    until_s: float
    waited_s: Mapping[str, float]
    position: tuple[float, ...] = ()

    def change(self, state: MissionState) -> None:
        x, y, z = (*self.position, 0.0, 0.0, 0.0)[:3]
        state.traffic.add(self.robot, self.waited_s, (x, y, z))


@happens("traffic_jam", "traffic jam: {robots} hold each other up at {position} since {since_s} s", mark=words.ALARM)
class TrafficJam(ExecutionEvent):
    """Robots hold each other up."""

    robots: tuple[str, ...]
    position: tuple[float, ...]
    since_s: float


@happens("final_states", words.final_states)
class FinalStates(ExecutionEvent):
    """Where robots are at the end, and whether they still fly, drive or are armed."""

    robots: tuple[Mapping[str, Any], ...]


@happens("elsewhere", "{what}", mark=words.ALARM)
class Elsewhere(ExecutionEvent):
    """A robot does not stand where the mission says."""

    what: str


@happens("robots_free", "robots are free: tasks that were left out are planned for again", mark=words.DETAIL)
class RobotsFree(ExecutionEvent):
    """No robot has a task any more, and another plan may do tasks that were left out."""

    left_out: tuple[str, ...] = field(default_factory=tuple)
