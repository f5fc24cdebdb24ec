"""Robots are brought home, without any task: each to its start, or as its fleet brings robots home and down.

A fleet may have a method `recover(at_end, halted)`, by which it does that itself, as drones do that return and land.
The robots of all others are sent to their starts by a mission with a task for each: with ways, traffic and monitoring
of any other run.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from muster.execution import Report
from muster.execution.fleet import Fleet
from muster.mission.model import Event, Mission, Robot, Task
from muster.mission.plan import Plan, Route
from muster.mission.system.clock import Clock
from muster.motion.port import Telemetry
from muster.running.journal import AWAY_M, Journal
from muster.running.live import Live, carry_out_live
from muster.running.observed_run import ObservedRun
from muster.state import ExecutionEvent, MissionState
from muster.state.reasons import is_no_loss

RECOVERED = "not to be done: robots were brought home"
"""Why no task was done."""
_UP_M = 0.5
"""A robot in the air goes over its start before it comes down, if it is this much higher than that."""
_BODY = (
    "id",
    "heading_deg",
    "speed_mps",
    "radius_m",
    "kind",
    "kinematics",
    "yaw_rate_radps",
    "acceleration_mps2",
    "climb_mps",
    "avoidance_priority",
)
"""Fields of a robot that say how it moves: no rule of the mission keeps it from its way home."""


def bring_home(
    mission: Mission,
    fleet: Fleet,
    halt: threading.Event,
    *,
    at_end: str = "hold",
    journal: Journal | None = None,
    on_event: Callable[[ExecutionEvent], None] | None = None,
    wall: Clock | None = None,
) -> dict[str, str]:
    """Bring all robots home that answer, and wait until they are there, or `halt` is set; then they stay.

    Parameters
    ----------
    mission : Mission
        The mission as its file has it.
    fleet : Fleet
        The robots, opened as for a mission that is under way.
    halt : threading.Event
        Ends it.
    at_end : str
        Of fleets that recover robots themselves: `land` where they are; otherwise they return.
    journal : Journal, optional
        Of the run that has ended: by it starts are those from which robots began, and orders are written to it.
    on_event, wall
        As in `ObservedRun`.

    Returns
    -------
    By robot that does not get home why.
    """
    recover = getattr(fleet, "recover", None)
    if recover is not None:
        recover(at_end, halt.is_set)
        return {}
    fleet.stop()
    state = None if journal is None else journal.state
    starts = {one.id: one for one in mission.robots}
    if state is not None:
        starts |= {name: known.robot for name, known in state.robots.items()}
    said = {name: told for name, port in fleet.ports.items() if (told := port.telemetry()) is not None}
    home = homeward(mission, {name: starts[name] for name in said if name in starts}, said)
    closed = () if state is None else state.doors.closed
    home = replace(home, events=tuple(Event(at_s=0.0, door_closes=door) for door in sorted(closed)))
    if not home.tasks:
        return {}
    return _sent_home(home, fleet, halt, journal, on_event, wall)


def brought_home(mission: Mission, plan: Plan, fleet: Fleet, request: ObservedRun) -> Report:
    """Bring all robots home, as `bring_home`, and return a report of no tasks; remarks say which are not home.

    Parameters
    ----------
    plan : Plan
        The plan of the mission, of which nothing is carried out.
    request : ObservedRun
        With the journal, if there is one, and the settings of the fleet.
    """
    halt, ending = request.halt or threading.Event(), getattr(request.settings, "at_end", "hold")
    how: dict[str, Any] = {"journal": request.journal, "on_event": request.on_event, "wall": request.wall}
    lost = bring_home(mission, fleet, halt, at_end=ending, **how)
    nothing = Live(mission, plan, fleet, request, state=MissionState(mission, request.ignore), wall=request.wall)
    remarks = tuple(f"{robot}: not home: {why}" for robot, why in lost.items())
    return without_tasks(nothing.result(), mission, remarks)


def without_tasks(report: Report, mission: Mission, remarks: tuple[str, ...]) -> Report:
    """Return a report that says that no task was to be done, as robots were brought home."""
    return replace(report, tasks_lost=tuple((task.id, RECOVERED) for task in mission.tasks), remarks=remarks)


def homeward(mission: Mission, starts: Mapping[str, Robot], said: Mapping[str, Telemetry]) -> Mission:
    """Return the mission of robots that go to their starts from where they say that they are.

    Parameters
    ----------
    mission : Mission
        For its map, lanes and rules.
    starts : mapping
        By robot the robot at its start.
    said : mapping
        By robot its last telemetry.
    """
    d = mission.dimensions
    robots = [
        Robot(**{field: getattr(start, field) for field in _BODY}, position=said[name].position[:d])
        for name, start in starts.items()
    ]
    tasks = [task for name, start in starts.items() for task in _way_home(start, said[name].position[:d], d)]
    rules = replace(mission.rules, objective="total+max", usage="distance", return_to_start=False)
    bare: dict[str, Any] = {"starts_at": None, "stations": (), "suitability": None, "landmarks": ()}
    return mission.at_once(name=f"{mission.name}, home", robots=tuple(robots), tasks=tuple(tasks), rules=rules, **bare)


def home_of(robot: str) -> str:
    """Return the id of the task by which a robot comes home."""
    return f"home of {robot}"


def _way_home(start: Robot, here: tuple[float, ...], dimensions: int) -> list[Task]:
    """The tasks by which a robot comes home; none where it is there."""
    if math.dist(here, start.position) <= AWAY_M["ground"]:
        return []
    only = (start.id,)
    home = Task(id=home_of(start.id), position=start.position, only_robots=only)
    if start.kind != "air" or dimensions < 3 or here[2] <= start.position[2] + _UP_M:
        return [home]
    over = Task(id=f"over the {home.id}", position=(*start.position[:2], here[2]), only_robots=only)
    return [over, replace(home, prerequisites=(over.id,))]


def _sent_home(
    home: Mission,
    fleet: Fleet,
    halt: threading.Event,
    journal: Journal | None,
    on_event: Callable[[ExecutionEvent], None] | None,
    wall: Clock | None,
) -> dict[str, str]:
    """Carry the way home out; returns by robot that does not get there why."""
    routes = [Route(one.id, tuple(t.id for t in home.tasks if t.only_robots == (one.id,))) for one in home.robots]
    how: dict[str, Any] = {"halt": halt, "on_event": on_event, "wall": wall}
    before_order = None if journal is None else journal.on_order
    report = carry_out_live(home, Plan(routes=tuple(routes)), fleet, before_order=before_order, **how)
    robots = {home_of(one.id): one.id for one in home.robots}
    return {robots[task]: why for task, why in report.tasks_lost if task in robots and not is_no_loss(why)}
