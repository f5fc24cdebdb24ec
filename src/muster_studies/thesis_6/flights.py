"""One plan, published or own, judged and carried out in a world."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from typing import Any

from muster.execution import Recorder
from muster.execution.record import NoObserver
from muster.execution.reports.report import Report
from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.motion.laws import PROFILE
from muster.planning.solve import solve
from muster.running.simulation import carry_out
from muster.simulation import NO_NOISE, Noise
from muster.verification import Verdict
from muster_studies.runs import accepted, mission_named

Routes = tuple[tuple[str, tuple[str, ...]], ...]
"""Robots and their tasks in order."""

ALLOCATOR = "search"


@dataclass(frozen=True)
class Marker:
    """The markers of one robot, misaligned: how far to the left of its origin, and by which angle to the left."""

    robot: str
    left_m: float
    turn_deg: float


@dataclass(frozen=True, kw_only=True)
class Flight:
    """A plan to carry out, and the conditions.

    Parameters
    ----------
    mission
        a shipped mission.
    routes
        the plan; None: that of `search` with so many `iterations` and the seed.
    ignored
        rules that do not hold.
    reserve
        of capacities, `rules.capacity_reserve`.
    seed
        of search, and of the world.
    world
        `kinematic` or `physics`.
    avoidance, noise, law
        of the world; without avoidance robots drive through each other.
    marker
        robots steer by motion capture, and one has these markers; None: they steer by their true poses.
    """

    mission: str
    routes: Routes | None = None
    iterations: int | None = None
    ignored: tuple[str, ...] = ()
    reserve: float = 0.0
    seed: int = 0
    world: str = "kinematic"
    avoidance: str = "orca"
    noise: Noise = NO_NOISE
    law: str = PROFILE
    marker: Marker | None = None


@dataclass(frozen=True)
class FlightResult:
    """The result of a flight: the verdict on its plan, the report, and the processor time of planning.

    `capacities` are whole, without the reserve; None where there is none, or it is ignored. `moved` counts tasks that
    went from one robot to another on the way.
    """

    planned: Verdict
    report: Report
    capacities: tuple[float | None, ...]
    moved: int
    planning_s: float

    @property
    def usages(self) -> tuple[float, ...]:
        """What each robot used, by its odometry."""
        return tuple(robot.usage_flown for robot in self.report.robots)

    @property
    def lost(self) -> int:
        """Tasks that were planned and are not done."""
        planned = {task for route in self.planned.routes for task in route.tasks}
        return len(planned.difference(self.report.tasks_done))

    @property
    def over(self) -> int:
        """Robots that used more than their capacity, any reserve put in."""
        return sum(
            capacity is not None and used > capacity
            for used, capacity in zip(self.usages, self.capacities, strict=True)
        )


def fly(flight: Flight) -> FlightResult:
    """Carry a plan out.

    Raises
    ------
    MusterError
        if the judge rejects the plan.
    """
    changes = _Changes()
    report = carried_out(flight, changes)
    _, verdict, planning_s = _planned(_on_paper(flight))
    free = "capacity" in flight.ignored
    capacities = tuple(None if free else robot.work_capacity for robot in mission_named(flight.mission).robots)
    return FlightResult(verdict, report, capacities, changes.moved, planning_s)


def carried_out(flight: Flight, recorder: Recorder) -> Report:
    """Carry a plan out, with a record.

    Raises
    ------
    MusterError
        if the judge rejects the plan.
    """
    mission, (plan, _, _) = mission_with(flight), _planned(_on_paper(flight))
    how: dict[str, Any] = {
        "world": flight.world,
        "seed": flight.seed,
        "avoidance": flight.avoidance,
        "noise": flight.noise,
        "law": flight.law,
        "ignore": flight.ignored,
        "pose": "true" if flight.marker is None else "estimate",
        "localise": None if flight.marker is None else {"motion-capture": asdict(flight.marker)},
    }
    return carry_out(mission, plan, recorder=recorder, **how)


def mission_with(flight: Flight) -> Mission:
    """The mission of a flight, with its reserve."""
    mission = mission_named(flight.mission)
    return replace(mission, rules=replace(mission.rules, capacity_reserve=flight.reserve))


def _on_paper(flight: Flight) -> Flight:
    """A flight without what makes no difference to its plan."""
    return replace(flight, world="kinematic", avoidance="none", noise=NO_NOISE, marker=None, law=PROFILE)


@lru_cache(maxsize=1000)
def _planned(flight: Flight) -> tuple[Plan, Verdict, float]:
    """The plan of a flight, its verdict, and the processor time of planning; computed once."""
    mission, begin = mission_with(flight), time.process_time()
    if flight.routes is None:
        plan = solve(mission, ALLOCATOR, seed=flight.seed, iterations=flight.iterations, ignore=flight.ignored)
    else:
        routes = tuple(Route(robot, tasks) for robot, tasks in flight.routes)
        plan = Plan(routes=routes, ignored=flight.ignored, objective="total+max")
    planning_s = time.process_time() - begin
    return plan, accepted(mission, plan, flight.mission, flight.ignored, "total+max"), planning_s


class _Changes(NoObserver):
    """Counts the tasks that move from one robot to another."""

    def __init__(self) -> None:
        self.moved = 0

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        if kind == "replanned":
            self.moved += len(data["moved"])
