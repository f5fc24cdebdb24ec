"""Missions carried out by nobody: robots go straight along a plan at their speed, and an observer is told of it."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np

from muster import load, verify


def shipped(name):
    """A shipped mission; the slow robots of 31T-6R at 1 m/s, so that its record is short."""
    mission = load(name)
    if name != "31T-6R":
        return mission
    return replace(mission, robots=tuple(replace(robot, speed_mps=1.0) for robot in mission.robots))


def carry_out(mission, plan, observer, *, dt=0.1, until=math.inf, more=()):
    """Tell an observer of a mission in which all goes as the judge's schedule says.

    `more` are further events (time, kind, data); `until` is when all breaks off, without a report.
    """
    verdict = verify(mission, plan)
    events = sorted([*_events(verdict), *more], key=lambda event: event[0])
    ways = [_way(mission, robot, route) for robot, route in zip(mission.robots, verdict.routes, strict=True)]
    end = min(verdict.makespan_s, until)
    observer.on_plan(0.0, plan)
    before = np.array([position(way, 0.0) for way in ways])
    for step in range(math.floor(end / dt + 1e-9) + 1):
        now = step * dt
        while events and events[0][0] <= now + 1e-9:
            observer.on_event(*events.pop(0))
        positions = np.array([position(way, now) for way in ways])
        velocities = (positions - before) / dt
        observer.on_step(now, positions, np.arctan2(velocities[:, 1], velocities[:, 0]), velocities)
        before = positions
    if until < verdict.makespan_s:
        return verdict
    for event in events:
        observer.on_event(*event)
    observer.on_report(report(verdict))
    return verdict


def position(way, now):
    """Where a robot is on its way: (time, place) pairs."""
    for (start, here), (end, there) in pairwise(way):
        if now <= end:
            share = 1.0 if end == start else (now - start) / (end - start)
            return here + min(max(share, 0.0), 1.0) * (there - here)
    return way[-1][1]


def _way(mission, robot, route):
    places = {task.id: task.position for task in mission.tasks}
    here = _in_space(robot.position)
    way = [(route.leaves_s, here)]
    for visit in route.visits:
        here = _in_space(places[visit.task])
        way += [(visit.arrives_s, here), (visit.ends_s, here)]
    return way


def _in_space(place):
    return np.array((*place, 0.0)[:3], dtype=float)


def _events(verdict):
    for route in verdict.routes:
        leaves = route.leaves_s
        for visit in route.visits:
            of = {"robot": route.robot, "task": visit.task}
            times = (leaves, visit.arrives_s, visit.starts_s, visit.ends_s)
            yield from zip(times, ("sets_out", "arrives", "starts", "ends"), [of] * 4, strict=True)
            leaves = visit.ends_s


def report(verdict):
    """A report as `muster simulate` prints it."""
    visits = sorted((visit for route in verdict.routes for visit in route.visits), key=lambda visit: visit.ends_s)
    return {
        "mission_time_s": verdict.makespan_s,
        "tasks_done": [visit.task for visit in visits],
        "tasks_lost": [],
        "contacts": 0,
        "min_distance_m": 0.5,
        "waiting_s": sum(visit.starts_s - visit.arrives_s for visit in visits),
        "reallocations": 0,
        "robots": [
            {"robot": route.robot, "usage_planned": route.usage, "usage_flown": route.usage} for route in verdict.routes
        ],
        "starts_s": {visit.task: visit.starts_s for visit in visits},
        "ends_s": {visit.task: visit.ends_s for visit in visits},
    }
