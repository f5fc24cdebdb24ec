"""Orders for work: least way and time, way points with the time that the work takes, and its stop for a whole team."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.task_motion import MotionPlanner, Way, Work, path_length, place, travel_s, work_of
from muster.mission.model import Task
from muster.motion.actions import Impossible
from muster.motion.port import Place, Waypoint
from muster.state.task_ledger import Ledger

AT_M = 0.2
"""Metres from the place of a delivery within which a robot puts its load down there, wherever the task moves to."""


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


def lead_elsewhere(
    crew: Sequence[RobotState], before: Task, task: Task, plan_motion: MotionPlanner, way: Way, now: float
) -> bool:
    """Let robots that carry a load to a delivery bring it to where the task is by now.

    Parameters
    ----------
    crew
        the robots at work on the task.
    before, task
        the task where it was, and as it is by now: its pickup has not moved.

    Returns
    -------
    whether they do; they go on as before if the task is no delivery, one of them puts its load down already, or there
    is no way for one.
    """
    orders = [_led_elsewhere(state, before, task, plan_motion, way) for state in crew]
    if not crew or any(order is None for order in orders):
        return False
    for state, order in zip(crew, orders, strict=True):
        assert order is not None
        work, stops, ways, home = order
        state.work = work
        state.home_usage, state.home_s = usage_home(state, work, home)
        state.go_other_ways(now, ways, stops)
        left_s = sum(
            travel_s(state.times, start, there)
            for start, there in zip([state.position, *(stop.position for stop in stops)], ways, strict=False)
        )
        state.work_s = now - state.begun_s + left_s + sum(stop.hold_s for stop in stops)
    return True


def _led_elsewhere(
    state: RobotState, before: Task, task: Task, plan_motion: MotionPlanner, way: Way
) -> tuple[Work, list[Waypoint], list[Sequence[Waypoint]], Sequence[Waypoint]] | None:
    """Return the work on a delivery that has moved, what is left of its stops, the ways to these, and the way home."""
    left, was_at = state.stops_left, place(before.position)
    if task.action is None or task.action.pickup is None or was_at not in [stop.position for stop in left]:
        return None
    if left[0].position == was_at and math.dist(was_at, state.position) <= AT_M:
        return None
    work = work_of(task, state.robot, plan_motion, way, state.times)
    if isinstance(work, Impossible):
        return None
    places = [point.position for point in work.waypoints if not point.via][-len(left) :]
    ways = [way(state.robot, start, goal) for start, goal in pairwise([state.position, *places])]
    home = () if state.home is None else way(state.robot, work.exit, state.home)
    found = [there for there in ways if there is not None]
    if len(found) < len(ways) or home is None:
        return None
    stops = [replace(stop, position=there) for stop, there in zip(left, places, strict=True)]
    return work, stops, found, home


def stop_work(crew: Mapping[str, RobotState], ledger: Ledger, task: str, now: float) -> tuple[str, ...]:
    """Stop all robots at work on a task, and on those that began with it; return the tasks that are under way."""
    under_way = tuple(name for name in ledger.unit(task) if ledger.at_work(name))
    for state in crew.values():
        if state.activity is Activity.WORKING and state.route and state.route[0] in (*under_way, task):
            state.stop(now)
    return under_way
