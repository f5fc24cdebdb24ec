"""One plan carried out by drones with cameras: usages, sightings and points of interest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from muster.execution.record import NoObserver
from muster.execution.reports.report import Report
from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.motion.grid import Floats
from muster.perception.estimates import RawEstimates
from muster.perception.matching import ErrorTable, error_table
from muster.perception.points_of_interest import PointOfInterest
from muster.running.simulation import Simulation
from muster.simulation import NO_NOISE, Noise
from muster.simulation.cameras import Look
from muster.verification import Verdict
from muster_studies.runs import accepted, mission_named

Routes = tuple[tuple[str, tuple[str, ...]], ...]
"""Robots and their tasks in order."""


@dataclass(frozen=True, kw_only=True)
class Flight:
    """A plan to carry out, and the conditions.

    Parameters
    ----------
    mission
        a shipped mission with tags.
    routes, ignored
        the plan, and the rules that do not hold.
    world, noise, seed
        see `Simulation`.
    rate_hz
        pictures a second of each camera, instead of the mission's.
    """

    mission: str
    routes: Routes
    ignored: tuple[str, ...] = ()
    world: str = "physics"
    noise: Noise = NO_NOISE
    seed: int = 0
    rate_hz: float | None = None


@dataclass(frozen=True, eq=False)
class FlightResult:
    """The result of a flight.

    Attributes
    ----------
    planned
        the verdict on the plan, with the paths of its tasks.
    report
        the report of execution.
    ways
        (steps, robots, 2) where bodies were in the plane, metres.
    raw, points
        raw estimates, and the points of interest found.
    looks, best
        how often cameras looked, and the first look with the most tags.
    """

    planned: Verdict
    report: Report
    ways: Floats
    raw: RawEstimates
    points: tuple[PointOfInterest, ...]
    looks: int
    best: Look | None

    @property
    def usages(self) -> tuple[float, ...]:
        """What each robot used, by its odometry."""
        return tuple(robot.usage_flown for robot in self.report.robots)

    @property
    def in_plane_m(self) -> tuple[float, ...]:
        """How far each robot's body went, heights not counted."""
        return tuple(np.linalg.norm(np.diff(self.ways, axis=0), axis=2).sum(axis=0).tolist())

    def errors(self, truth: Mapping[str, tuple[float, float]]) -> ErrorTable:
        """The points of interest matched with true positions."""
        return error_table([point.position for point in self.points], truth)


@lru_cache(maxsize=64)
def fly(flight: Flight) -> FlightResult:
    """Carry a plan out; computed once for tables and pictures.

    Raises
    ------
    MusterError
        if the judge rejects the plan.
    MissingExtraError
        if the extra `physics` is not installed.
    """
    mission = _mission(flight)
    routes = tuple(Route(robot, tasks) for robot, tasks in flight.routes)
    plan = Plan(routes=routes, ignored=flight.ignored, objective="total+max")
    planned = accepted(mission, plan, flight.mission, flight.ignored, "total+max")
    ways, witness = _Ways(), _LookCounter()
    how: dict[str, Any] = {"world": flight.world, "noise": flight.noise, "seed": flight.seed, "pose": "true"}
    how["avoidance"] = "orca"
    how["ignore"] = flight.ignored
    with closing(Simulation(mission, plan, recorder=ways, on_look=witness.take, **how)) as simulation:
        while not simulation.done:
            simulation.advance(math.inf)
        camera_search = simulation.camera_search
        assert camera_search is not None  # the mission has tags
        search = camera_search.search
        points = tuple(find.point for find in search.finds)
        report, places = simulation.result(), np.array(ways.places)
        return FlightResult(planned, report, places, search.raw, points, witness.looks, witness.best)


def _mission(flight: Flight) -> Mission:
    mission = mission_named(flight.mission)
    if flight.rate_hz is None:
        return mission
    cameras = [robot.camera and replace(robot.camera, rate_hz=flight.rate_hz) for robot in mission.robots]
    robots = (replace(robot, camera=camera) for robot, camera in zip(mission.robots, cameras, strict=True))
    return replace(mission, robots=tuple(robots))


class _LookCounter:
    """Counts camera images, and keeps the one with most tags."""

    def __init__(self) -> None:
        self.looks = 0
        self.best: Look | None = None

    def take(self, look: Look) -> None:
        self.looks += 1
        if self.best is None or len(look.observation.sightings.all) > len(self.best.observation.sightings.all):
            self.best = look


class _Ways(NoObserver):
    """Where bodies are in the plane, ten times a second."""

    def __init__(self) -> None:
        self.places: list[Floats] = []

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        self.places.append(positions[:, :2].copy())
