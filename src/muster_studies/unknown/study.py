"""The study: teams that have no map beside the same teams with it, judged by the world's true map."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from muster.mission.model import Mission
from muster.motion.grid import Floats
from muster.motion.map_world import World, body_of
from muster.motion.path import NoPath
from muster.motion.paths.robot_paths import RobotPaths
from muster.planning.solve import solve
from muster.running.simulation import carry_out
from muster.simulation.unknown_obstacles import Parameters, drive
from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.runs import mission_named
from muster_studies.tables import Cell, Table
from muster_studies.unknown.scenes import building, hall, random_space, random_world

WORLDS, SPACES, BUILDINGS, HALLS, TEAM = 50, 20, 5, 3, 5
QUICK = 2
_WAYS = (("market-rescue-arena", "handBot", 25, (2.0, 2.0)), ("floor", "rover1", 20, (40.0, 24.0)))
"""Missions, robots, how many ways, and the corner opposite to (0, 0) of the rectangle from which ends are drawn."""
_RANDOM = {"world": random_world, "space": random_space}
_EXPLORED = {"building": building, "hall": hall}
_LONG = 0.4
"""Share of the width of the rectangle that ways with the map are long at least."""


@dataclass(frozen=True)
class Job:
    """One run: ways on the map of a mission, a mission by its name, a world or a building by its seed."""

    what: str
    name: str = ""
    seed: int = 0
    robots: int = 0


@dataclass(frozen=True)
class Outcome:
    """What became of it.

    Parameters
    ----------
    wanted, done
        Ways that there are, or tasks that can be reached, by the true map; those that were found or done.
    ratios
        Lengths driven, in lengths with the map.
    clearance
        Least distance of a robot's centre from true obstacles, in its radii.
    contacts
        Pairs of robots that touched.
    time_s, explored_m2
        Of missions.
    """

    wanted: int
    done: int
    ratios: tuple[float, ...]
    clearance: float
    contacts: int = 0
    time_s: float = 0.0
    explored_m2: float = 0.0


class _Places:
    """Observer that keeps where robots are in each step."""

    def __init__(self) -> None:
        self.steps: list[Floats] = []

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        self.steps.append(positions.copy())

    def on_event(self, *_: object) -> None: ...

    def on_telemetry(self, *_: object) -> None: ...

    def on_plan(self, *_: object) -> None: ...

    def on_report(self, *_: object) -> None: ...


def outcome_of(job: Job) -> Outcome:
    """Do a job."""
    if job.what == "ways":
        return ways_of(job.name, job.robots)
    if job.what in _EXPLORED:
        return carried_out(_EXPLORED[job.what](job.seed, job.robots), explore=True)
    if job.what in _RANDOM:
        return carried_out(_RANDOM[job.what](job.seed))
    return carried_out(mission_named(job.name))


def ways_of(name: str, count: int, seed: int = 1) -> Outcome:
    """Drive between random places of a mission's map, between which there is a way."""
    _, robot, _, corner = next(one for one in _WAYS if one[0] == name)
    mission, random = mission_named(name), np.random.default_rng(seed)
    world = World.of(mission)
    body = body_of(next(one for one in mission.robots if one.id == robot))
    paths, ratios, least, wanted = RobotPaths(world), list[float](), math.inf, 0
    while wanted < count:
        start, goal = random.uniform((0, 0), corner, (2, 2)).round(2)
        known = paths.path(body, start, goal)
        if isinstance(known, NoPath) or known.length_m < _LONG * corner[0]:
            continue
        wanted += 1
        heading = math.atan2(goal[1] - start[1], goal[0] - start[0])
        found = drive(world, body, (*start.tolist(), heading), tuple(goal.tolist()), Parameters())
        if not isinstance(found, NoPath):
            ratios.append(found.path.length_m / known.length_m)
            places = found.poses[:, :2]
            between = np.concatenate([places, (places[1:] + places[:-1]) / 2])
            least = min(least, float(world.clearance(between, body.kind, body.radius_m).min()))
    return Outcome(wanted, len(ratios), tuple(ratios), least / body.radius_m)


def carried_out(mission: Mission, *, explore: bool = False) -> Outcome:
    """Carry a mission out without a map, and judge it by the true one."""
    world, places = World.of(mission), _Places()
    paths = RobotPaths(world)
    reachable = {
        task.id
        for task in mission.tasks
        if any(_can_do(paths, mission, k, task.id) for k in range(len(mission.robots)))
    }
    report = carry_out(mission, solve(mission, "greedy"), unknown=True, explore=explore, recorder=places)
    ground = report.ground
    assert ground is not None
    assert ground.driven_m is not None
    steps = np.stack(places.steps)
    clearances = [
        float(world.clearance(steps[:, k, : mission.dimensions], robot.kind, robot.radius_m).min()) / robot.radius_m
        for k, robot in enumerate(mission.robots)
    ]
    ratio = (ground.driven_m / ground.with_map_m,) if ground.with_map_m else ()
    done = len(reachable & set(report.tasks_done))
    return Outcome(
        len(reachable), done, ratio, min(clearances), report.contacts or 0, report.mission_time_s, ground.explored_m2
    )


def _can_do(paths: RobotPaths, mission: Mission, k: int, task: str) -> bool:
    robot = mission.robots[k]
    place = next(one.entry or one.position for one in mission.tasks if one.id == task)
    return not isinstance(paths.path(body_of(robot), robot.position, place), NoPath)


@dataclass(frozen=True)
class Ways:
    """A row for each map on which ways are sought."""

    number: str = "ways"

    def jobs(self, effort: Effort) -> Iterator[Job]:
        for name, _, count, _ in _WAYS:
            yield Job("ways", name, robots=QUICK if effort.quick else count)

    def table(self, effort: Effort, found: Mapping[Job, Outcome]) -> Table:
        cells = [{"map": job.name, **_figures([found[job]])} for job in self.jobs(effort)]
        return Table.of_cells(self.number, "One robot, between random places", cells, _NOTES)


@dataclass(frozen=True)
class Missions:
    """A row for each mission, and one for all random worlds."""

    number: str = "missions"

    def jobs(self, effort: Effort) -> Iterator[Job]:
        yield Job("mission", "market-rescue-arena")
        if not effort.quick:
            yield from (Job("mission", name) for name in ("floor", "yard", "depot"))
        yield from self._worlds(effort)
        yield from self._spaces(effort)

    def _worlds(self, effort: Effort) -> list[Job]:
        return [Job("world", seed=seed) for seed in range(QUICK if effort.quick else effort.seeds or WORLDS)]

    def _spaces(self, effort: Effort) -> list[Job]:
        return [Job("space", seed=seed) for seed in range(1 if effort.quick else effort.seeds or SPACES)]

    def table(self, effort: Effort, found: Mapping[Job, Outcome]) -> Table:
        cells: list[dict[str, Cell]] = [
            {"mission": job.name, **_figures([found[job]])} for job in self.jobs(effort) if job.name
        ]
        worlds = [found[job] for job in self._worlds(effort)]
        cells.append({"mission": f"{len(worlds)} random worlds", **_figures(worlds)})
        spaces = [found[job] for job in self._spaces(effort)]
        cells.append({"mission": f"{len(spaces)} random worlds in space", **_figures(spaces)})
        return Table.of_cells(self.number, "Missions carried out", cells, _NOTES)


@dataclass(frozen=True)
class Exploration:
    """A row for each building, explored by one robot and by five: on the ground, or in the air under a ceiling."""

    number: str = "exploration"
    what: str = "building"
    title: str = "Buildings of 24 rooms explored on the ground"
    count: int = BUILDINGS

    def jobs(self, effort: Effort) -> Iterator[Job]:
        for seed in self._seeds(effort):
            yield from (Job(self.what, seed=seed, robots=robots) for robots in (1, TEAM))

    def _seeds(self, effort: Effort) -> range:
        return range(1 if effort.quick else self.count)

    def table(self, effort: Effort, found: Mapping[Job, Outcome]) -> Table:
        cells: list[dict[str, Cell]] = []
        for seed in self._seeds(effort):
            one, team = (found[Job(self.what, seed=seed, robots=robots)] for robots in (1, TEAM))
            cells.append(
                {
                    "building": seed,
                    "explored by one m2": one.explored_m2,
                    f"by {TEAM} m2": team.explored_m2,
                    "by one s": one.time_s,
                    f"by {TEAM} s": team.time_s,
                    "share": team.time_s / one.time_s,
                }
            )
        mean = sum(float(str(cell["share"])) for cell in cells) / len(cells)
        cells.append({"building": "mean", "share": mean})
        return Table.of_cells(self.number, self.title, cells)


_NOTES = (
    "of: ways that there are, or tasks that can be reached, by the true map; ratio: lengths driven in lengths with the "
    "map; clearance: least distance from true obstacles, in radii; touched: pairs of robots.",
)


def _figures(outcomes: list[Outcome]) -> dict[str, Cell]:
    ratios = [ratio for one in outcomes for ratio in one.ratios]
    return {
        "found or done": sum(one.done for one in outcomes),
        "of": sum(one.wanted for one in outcomes),
        "mean ratio": sum(ratios) / len(ratios),
        "worst ratio": max(ratios),
        "clearance": min(one.clearance for one in outcomes),
        "touched": sum(one.contacts for one in outcomes),
    }


_IN_THE_AIR = Exploration("air", "hall", "Halls of 12 rooms under a ceiling explored in the air", HALLS)
_TABLES: tuple[Reproduction[Job, Outcome], ...] = (Ways(), Missions(), Exploration(), _IN_THE_AIR)

UNKNOWN = Repetition(
    **description("unknown"),
    reproductions=_TABLES,
    perform=one_by_one(outcome_of),
    seeds=lambda effort: None,
    extras=("map",),
)
