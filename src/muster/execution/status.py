"""The status of a mission at a moment: each robot's activity, wait and remaining route, and each task's progress."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.stations.slots import AT_STATION, Stations
from muster.state.robots import OUT
from muster.state.task_ledger import Ledger

if TYPE_CHECKING:
    from muster.execution.executor import Executor

IN_TRAFFIC = "in traffic"
"""The activity of a robot under way that waits for another."""
_AT_TASK = (Activity.DRIVING, Activity.WAITING, Activity.WORKING)


@dataclass(frozen=True, kw_only=True)
class RobotStatus:
    """One robot, now.

    Parameters
    ----------
    activity
        `driving`, `waiting`, `working`, `returning`, `idle`; `driving to dock`, `queueing at dock`, `charging at dock`,
        `swapping at dock` and `unloading at dock` on a call at the station of that id; `in traffic` where it would
        drive or work, and waits for another robot that is in its way.
    out
        why it takes no part, in words; empty if it does.
    task
        at which it is, or to which it drives.
    waits_for
        the prerequisites for which it waits there.
    waits
        why it waits, in words: `waits for window: opens at 600 s`, `waits for team: r_2`, `waits in traffic for r_3`;
        empty if it does not.
    held_up_by
        the robot for which it waits in traffic; empty where it does not.
    team
        the robots that do the task together with it, itself included, where they are several.
    route
        tasks that it is still to do, the current one first.
    used, usage_left
        in the mission's unit; None left: any amount.
    charge
        what its battery says, 0 to 1; None where it says nothing.
    station
        at which it is, or to which it drives; empty: none.
    on_board
        what it carries, by commodity.
    available
        the availability `a_i` of [tcf-thesis], 5.3.1.
    """

    activity: str
    out: str
    task: str | None
    waits_for: tuple[str, ...]
    waits: str
    team: tuple[str, ...]
    route: tuple[str, ...]
    used: float
    usage_left: float | None
    charge: float | None
    available: bool
    held_up_by: str = ""
    station: str = ""
    on_board: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Status:
    """The crew and the tasks by their ids, now."""

    robots: Mapping[str, RobotStatus]
    tasks: Mapping[str, str]


def status_of(executor: Executor) -> Status:
    """How the mission that is carried out stands."""
    limited = "capacity" not in executor.planned.ignored
    crew = executor.crew
    traffic = executor.traffic
    robots = {
        name: _in_traffic(_robot(state, executor, limited=limited), traffic.waits_for(name))
        for name, state in crew.items()
    }
    return Status(robots, executor.state.stages)


def _robot(state: RobotState, executor: Executor, *, limited: bool) -> RobotStatus:
    crew, ledger = executor.crew, executor.ledger
    at_task = state.activity in _AT_TASK and bool(state.route)
    capacity = state.capacity if limited else None
    return RobotStatus(
        activity=activity_in_words(state, executor.stations),
        out=OUT.get(state.out, state.out),
        task=state.route[0] if at_task else None,
        waits_for=tuple(ledger.missing(state.route[0])) if state.activity is Activity.WAITING else (),
        waits=_wait(state, ledger),
        team=_team(state, crew) if at_task else (),
        route=tuple(state.route),
        used=state.used,
        usage_left=None if capacity is None else max(0.0, capacity - state.used),
        charge=state.share_left,
        available=state.available,
        station=state.station if state.activity in AT_STATION else "",
        on_board=executor.goods.load(state.robot.id),
    )


def activity_in_words(state: RobotState, stations: Stations) -> str:
    """What a robot is doing; at a station that, and where."""
    if state.activity not in AT_STATION:
        return state.activity.value
    station = stations.known[state.station]
    doing = "charging" if station.charges else "swapping" if station.swaps else "unloading"
    words = {Activity.TO_STATION: "driving to", Activity.QUEUEING: "queueing at", Activity.SERVED: f"{doing} at"}
    return f"{words[state.activity]} {station.id}"


def _in_traffic(robot: RobotStatus, held_up_by: str) -> RobotStatus:
    if not held_up_by:
        return robot
    return replace(robot, activity=IN_TRAFFIC, held_up_by=held_up_by, waits=f"waits in traffic for {held_up_by}")


def _wait(state: RobotState, ledger: Ledger) -> str:
    if state.activity is Activity.QUEUEING:
        return state.wait_words
    if state.activity is not Activity.WAITING:
        return ""
    missing = ledger.missing(state.route[0])
    return state.wait_words or (f"waits for {', '.join(missing)}" if missing else "")


def _team(state: RobotState, crew: Mapping[str, RobotState]) -> tuple[str, ...]:
    task = state.route[0]
    team = tuple(other.robot.id for other in crew.values() if not other.out and task in other.route)
    return team if len(team) > 1 else ()
