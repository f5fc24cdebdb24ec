"""Stations that no robot can get to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster.allocation.problem import Problem
from muster.mission.model import Station
from muster.motion.map_world import body_of
from muster.motion.maps.free_points import free
from muster.motion.unreachable_places import why_blocked


@dataclass(frozen=True)
class CutOff:
    """A station to which no robot has a way from where it starts, and why."""

    station: str
    detail: str


def cut_off_stations(problem: Problem) -> tuple[CutOff, ...]:
    """The stations of a problem to which no robot has a way."""
    first = len(problem.tasks) + 2 * len(problem.robots)
    return tuple(
        CutOff(station.id, _why(problem, station))
        for k, station in enumerate(problem.stations)
        if not any(_gets_to(problem, i, first + k) for i in range(len(problem.robots)))
    )


def _gets_to(problem: Problem, i: int, place: int) -> bool:
    return bool(np.isfinite(problem.legs(i, [problem.start(i)], [place])[0, 0]))


def _why(problem: Problem, station: Station) -> str:
    """What is in the way of every body at the station itself; else that there is no way to it."""
    if problem.mission.travel_rule == "map":
        world, point = problem.robot_paths.world, station.position
        reasons = [
            why_blocked(world, point, body)
            for body in dict.fromkeys(map(body_of, problem.robots))
            if not free(world.free_space(body.radius_m, body.kind), np.array([point]))[0]
        ]
        if reasons:
            return "; ".join(dict.fromkeys(reasons))
    return "there is no way to it from where robots start"
