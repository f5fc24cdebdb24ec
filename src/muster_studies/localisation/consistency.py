"""Table `consistency`: whether robots know how unsure they are of their poses, and of the places of what they find."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass
from functools import cache
from statistics import fmean
from typing import Any

import numpy as np

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.solve import solve
from muster.running.simulation import Simulation
from muster.running.state_estimation import LocalisedPort
from muster.simulation import Noise
from muster_studies.effort import Effort
from muster_studies.runs import mission_named
from muster_studies.tables import Cell, Table

MISSION = "16T-3R-tags"
ITERATIONS = 500
UNTIL_S = 120.0
"""How long robots search."""
LOOK_S, FIRST_S = 2.0, 10.0
"""How often poses are compared with the truth, from when on: at the beginning there is no error to speak of."""
SURE = 3.0
"""In standard deviations along the worst direction: an error that is larger is rare, and counted."""

RADIUS = 1.96
"""Standard deviations that the radius which holds 95 % has at least."""

SETTINGS: Mapping[str, tuple[tuple[str, ...] | None, Noise]] = {
    "odometry 2 %": (None, Noise(odometry=0.02)),
    "odometry 5 %": (None, Noise(odometry=0.05)),
    "slip up to 10 %": (None, Noise(slip=0.1)),
    "odometry and gyro": (
        ("odometry", "inertial"),
        Noise(odometry=0.05, slip=0.05, gyro_radps=0.01, gyro_bias_radps=0.005),
    ),
    "poses that are told": (
        None,
        Noise(odometry=0.02, slip=0.05, position_m=0.1, heading_rad=0.05, attitude_rad=math.radians(1)),
    ),
}
"""By name: sensors, and the noise of the world."""


@dataclass(frozen=True)
class Consistency:
    """One run: squared errors in units of their covariance, by degree of freedom.

    Parameters
    ----------
    poses
        mean over robots and time.
    places
        of each place that was found, at the end.
    off, sure_m
        by place metres from the tag, and the standard deviation along the worst direction.
    found
        how many places each tag has that was found.
    """

    poses: float
    places: tuple[float, ...]
    off_m: tuple[float, ...]
    sure_m: tuple[float, ...]
    found: tuple[int, ...]


@cache
def _planned() -> tuple[Mission, Plan]:
    mission = mission_named(MISSION)
    return mission, solve(mission, iterations=ITERATIONS, seed=0)


def consistency(setting: str, seed: int) -> Consistency:
    """Carry the mission out for a while in one setting, and compare what robots know with the truth."""
    localise, noise = SETTINGS[setting]
    mission, plan = _planned()
    how: dict[str, Any] = {"noise": noise, "localise": localise, "seed": seed, "pose": "estimate"}
    poses: list[float] = []
    with closing(Simulation(mission, plan, **how)) as simulation:
        while simulation.time_s < UNTIL_S:
            simulation.advance(simulation.time_s + LOOK_S)
            if simulation.time_s >= FIRST_S:
                poses += _of_poses(simulation)
        return Consistency(fmean(poses), *_of_places(simulation, mission))


def _of_poses(simulation: Simulation) -> Iterator[float]:
    world = simulation.world
    for number, port in enumerate(simulation.robots.ports.values()):
        assert isinstance(port, LocalisedPort)
        pose = [*world.positions[number, :2], world.headings[number]]
        error, covariance = port.estimate.looking().error_of(pose)
        yield _squared(error, covariance)


def _of_places(simulation: Simulation, mission: Mission) -> tuple[Any, ...]:
    assert simulation.camera_search is not None  # the mission has tags
    finds = simulation.camera_search.search.finds
    truth = {tag.id: np.array(tag.position[:2]) for tag in mission.tags}
    off = [find.point.position - truth[find.tag] for find in finds]
    squared = tuple(_squared(each, find.point.covariance) for each, find in zip(off, finds, strict=True))
    sure = tuple(float(np.sqrt(np.linalg.eigvalsh(find.point.covariance)[-1])) for find in finds)
    found = tuple(Counter(find.tag for find in finds).values())
    return squared, tuple(float(np.linalg.norm(each)) for each in off), sure, found


def _squared(error: Any, covariance: Any) -> float:
    return float(error @ np.linalg.solve(covariance, error)) / len(error)


@dataclass(frozen=True)
class ConsistencyJob:
    """One run in one setting."""

    setting: str
    seed: int

    def perform(self) -> Consistency:
        return consistency(self.setting, self.seed)


@dataclass(frozen=True)
class Consistencies:
    """A row for each setting."""

    number: str = "consistency"

    def jobs(self, effort: Effort) -> Iterator[ConsistencyJob]:
        return (ConsistencyJob(setting, seed) for setting in SETTINGS for seed in range(effort.seed_count))

    def table(self, effort: Effort, found: Mapping[Any, Any]) -> Table:
        rows = []
        for setting in SETTINGS:
            runs = [found[job] for job in self.jobs(effort) if job.setting == setting]
            rows.append({"setting": setting, "runs": len(runs), **_cells(runs)})
        notes = (
            f"Mission {MISSION} in the kinematic world: three drones search for thirty tags for {UNTIL_S:g} s, and "
            "steer by their estimates. "
            "poses, places: squared error in units of the covariance by degree of freedom, mean of all runs: 1 of an "
            "estimate that knows its errors, more of one that is too sure. Poses: x, y and heading, as errors of a "
            "turn and a shift of the map.",
            f"beyond {SURE:g} sigma: share of places that are farther off than {SURE:g} standard deviations along the "
            "worst direction; a Gaussian has 0.3 % along one direction, 1.1 % where all are alike. thrice: places "
            "that are farther off than three times the radius that holds 95 %. twice: tags at more than one place.",
        )
        return Table.of_cells(self.number, "Do robots know how unsure they are?", rows, notes, decimals=3)


def _cells(runs: list[Consistency]) -> dict[str, Cell]:
    places = [value for run in runs for value in run.places]
    off = [value for run in runs for value in run.off_m]
    sure = [value for run in runs for value in run.sure_m]
    beyond = sum(error > SURE * deviation for error, deviation in zip(off, sure, strict=True))
    return {
        "poses": fmean(run.poses for run in runs),
        "places": fmean(places),
        "found": len(places),
        "off m": fmean(off),
        "sure to m": fmean(sure),
        f"beyond {SURE:g} sigma": f"{100 * beyond / len(off):.2f} %",
        "thrice": sum(error > 3 * RADIUS * deviation for error, deviation in zip(off, sure, strict=True)),
        "twice": sum(count > 1 for run in runs for count in run.found),
    }
