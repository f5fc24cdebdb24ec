"""The runs: the market's plan carried out with noise while all three robots scan; and their results."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from muster.mission.model import Mission
from muster.motion.grid import Floats
from muster.perception.clusters import by_density
from muster.perception.matching import ErrorTable, error_table
from muster.perception.points_of_interest import PointOfInterest, points_of_interest
from muster.running.simulation import Simulation
from muster.running.worlds import WORLDS
from muster_studies.effort import Effort
from muster_studies.market_5.arena import LANDMARKS, STEERED_NOISE, SURVIVORS
from muster_studies.market_5.localisation import CylinderSighting, RobotLocalisation, raw_estimates
from muster_studies.market_rescue.scenario import market_case
from muster_studies.rescue.flights import FlightResult, Log, repetitions
from muster_studies.rescue.teams import ARENA, mission_of, plan_of
from muster_studies.rescue.tracking import Tracking, tracking

LANDMARKED, BELIEVED, ALONE = "landmarks", "believed", "odometry alone"
PLACES = (LANDMARKED, BELIEVED, ALONE)
"""Where a robot was that steered by odometry with landmarks; where it took itself to be; and where it was that steered
by odometry alone, in another run."""


STEP_S, SCAN_S = 0.1, 0.5
APART_M, LEAST = 0.06, 5
"""Sightings so near to each other are of one thing, which is there when it was seen so often."""
TOGETHER_S = 2.0
"""Within which sightings of one robot count as one: they share where it takes itself to be."""
FARTHEST_M = 0.1
"""From a survivor, what is found is none."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SearchResult:
    """One search.

    Parameters
    ----------
    flown
        by place, with the positions that are meant; times and all else are the same.
    off
        by robot and way of steering, LANDMARKED or ALONE, (t,) metres that it was off where it took itself to be.
    surprise
        the same, (t,): squared error of x and y in units of its covariance; 2 in the mean of one that knows its errors.
    seen
        all sightings of what is no landmark, in order of time.
    hits
        by robot what its last scan hit, (k, 2) in the map, from where it took itself to be.
    """

    flown: Mapping[str, FlightResult]
    off: Mapping[tuple[str, str], Floats]
    surprise: Mapping[tuple[str, str], Floats]
    seen: tuple[CylinderSighting, ...]
    hits: Mapping[str, Floats]

    def tracking(self, robot: str, place: str) -> Tracking:
        return tracking(ARENA, self.flown[place], robot)

    def found(self, robots: Sequence[str] = ()) -> ErrorTable:
        """The survivors that these robots (by default all) found together."""
        places = [point.position for point in self.points(robots)]
        return error_table(places, SURVIVORS, FARTHEST_M)

    def points(self, robots: Sequence[str] = ()) -> tuple[PointOfInterest, ...]:
        """The places at which these robots found something."""
        raw = raw_estimates([one for one in self.seen if not robots or one.robot in robots])
        return points_of_interest(raw, by_density(raw.positions, APART_M, LEAST), independent_after_s=TOGETHER_S)

    def sightings(self, survivor: str, robot: str | None = None) -> list[CylinderSighting]:
        """Those that are within `FARTHEST_M` of it."""
        there = SURVIVORS[survivor]
        by = [one for one in self.seen if robot is None or one.robot == robot]
        return [one for one in by if math.dist(one.place.mean, there) <= FARTHEST_M]


@dataclass(frozen=True, kw_only=True)
class Search:
    """One run: the plan carried out in one of the worlds; `seed` is of all errors, `iterations` of the market's."""

    world: str
    iterations: int
    seed: int

    def perform(self) -> SearchResult:
        mission = replace(mission_of(ARENA), landmarks=LANDMARKS)
        first = self._steered(mission, ("odometry", "lasers"))
        alone = self._steered(mission, ("odometry",))
        flown = {
            LANDMARKED: first.flown,
            BELIEVED: replace(first.flown, positions=first.states[:, :, :2]),
            ALONE: alone.flown,
        }
        runs = {LANDMARKED: first, ALONE: alone}
        off = {(robot, way): one.off(number) for way, one in runs.items() for number, robot in enumerate(one.robots)}
        surprise = {
            (robot, way): one.surprise(number) for way, one in runs.items() for number, robot in enumerate(one.robots)
        }
        return SearchResult(flown=flown, off=off, surprise=surprise, seen=first.seen, hits=first.hits)

    def _steered(self, mission: Mission, localise: tuple[str, ...]) -> _Steered:
        """One run in which robots steer by these sensors."""
        log = Log(mission)
        how: dict[str, Any] = {
            "world": self.world,
            "avoidance": "orca",
            "seed": self.seed,
            "noise": STEERED_NOISE,
            "localise": localise,
            "recorder": log,
        }
        with closing(Simulation(mission, plan_of(ARENA, self.iterations), **how)) as simulation:
            eyes = [RobotLocalisation(simulation, robot.id, self.seed) for robot in mission.robots]
            states, seen = [_states(eyes)], list[CylinderSighting]()
            while not simulation.done:
                simulation.advance(simulation.time_s + STEP_S)
                if len(states) % round(SCAN_S / STEP_S) == 0:
                    for one in eyes:
                        seen += one.look([other.pose.mean[:2] for other in eyes if other is not one])
                states.append(_states(eyes))
        hits = {one.robot: one.hits for one in eyes}
        return _Steered(log.flown(simulation.result()), np.array(states), tuple(seen), hits)


@dataclass(frozen=True, eq=False)
class _Steered:
    """One run; `states` (t, n, 6) as `_states` gives them, at the times of the flight."""

    flown: FlightResult
    states: Floats
    seen: tuple[CylinderSighting, ...]
    hits: Mapping[str, Floats]

    @property
    def robots(self) -> list[str]:
        return list(self.flown.visits)

    def off(self, number: int) -> Floats:
        """Metres that a robot was off where it took itself to be, (t,)."""
        return np.asarray(np.linalg.norm(self._apart[:, number], axis=1))

    def surprise(self, number: int) -> Floats:
        """The squares of that in units of the filter's covariance, (t,)."""
        spread = self.states[:, number, 2:].reshape(-1, 2, 2)
        apart = self._apart[:, number]
        return np.asarray(np.einsum("ti,tij,tj->t", apart, np.linalg.inv(spread), apart))

    @property
    def _apart(self) -> Floats:
        return np.asarray(self.states[:, :, :2] - self.flown.positions)


@cache
def performed(search: Search) -> SearchResult:
    """The result of a search, computed once for tables and pictures."""
    return search.perform()


def searches(effort: Effort, worlds: Sequence[str] = WORLDS.shipped) -> list[Search]:
    """In each world the repetitions."""
    iterations = market_case(effort).iterations or 0
    seeds = range(repetitions(effort))
    return [Search(world=world, iterations=iterations, seed=seed) for world in worlds for seed in seeds]


def found_by_world(effort: Effort, results: Mapping[Any, Any]) -> Iterator[tuple[str, list[SearchResult]]]:
    """Each world, and what its searches found."""
    for world in WORLDS.shipped:
        yield world, [results[job] for job in searches(effort, [world])]


def _states(eyes: Sequence[RobotLocalisation]) -> list[Floats]:
    """Of each robot where it takes itself to be: x, y and their covariance, (6,)."""
    poses = [one.pose for one in eyes]
    return [np.concatenate([pose.mean[:2], pose.covariance[:2, :2].ravel()]) for pose in poses]
