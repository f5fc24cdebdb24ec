"""Orders for work: least way and time, way points with the time that the work takes, and its stop for a whole team."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.task_motion import Work, path_length, travel_s
from muster.motion.port import Place, Waypoint
from muster.state.task_ledger import Ledger


def least_s(state: RobotState, start: Place, way: Sequence[Waypoint]) -> float:
    """Seconds that a robot drives at least."""
    rise_m = abs(way[-1].position[2] - start[2]) if way else 0.0
    return state.times.least_seconds(path_length(start, way), rise_m)


def usage_home(state: RobotState, work: Work, way: Sequence[Waypoint]) -> tuple[float, float]:
    """What the way from the exit of a task to the end of the route uses, and the seconds that it takes at least."""
    usage = travel_s(state.times, work.exit, way) if state.in_time else path_length(work.exit, way)
    return usage, least_s(state, work.exit, way)


def work_for(state: RobotState, lasts_s: float, now: float, *, stands: bool) -> None:
    """Let a robot work, and stay where the work ends until so much time is over; `stands`: it works where it is."""
    state.works = True
    if state.work is not None:
        work = _where_it_stands(state, state.work) if stands else state.work
        state.send(now, Activity.WORKING, delayed(work, state.delay_s + lasts_s - state.work_s))
        state.work_s = lasts_s


def _where_it_stands(state: RobotState, work: Work) -> Work:
    """Work at one place, done where the robot is: a team stands around the place, which has room for one body."""
    if len(work.waypoints) > 1:
        return work
    return replace(work, waypoints=(replace(work.waypoints[0], position=state.position),))


def delayed(work: Work, by_s: float) -> list[Waypoint]:
    """The way points of work that takes so much longer: the robot stays in the last, and uses there what is not way."""
    *before, last = work.waypoints
    stays = [replace(point, uses=0.0) for point in before]
    return [*stays, replace(last, hold_s=last.hold_s + by_s, uses=work.stayed_cost_m)]


def least_usage(state: RobotState, work: Work, there: Sequence[Waypoint], lasts_s: float) -> float:
    """Usage when a task is done, if nothing comes in the way, in the mission's unit."""
    if state.in_time:
        return state.used + least_s(state, state.position, there) + lasts_s
    return state.used + path_length(state.position, there) + max(work.cost_m, work.way_m)


def stop_work(crew: Mapping[str, RobotState], ledger: Ledger, task: str, now: float) -> tuple[str, ...]:
    """Stop all robots at work on a task, and on those that began with it; return the tasks that are under way."""
    under_way = tuple(name for name in ledger.unit(task) if ledger.at_work(name))
    for state in crew.values():
        if state.activity is Activity.WORKING and state.route and state.route[0] in (*under_way, task):
            state.stop(now)
    return under_way
