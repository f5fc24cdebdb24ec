"""Plans for robots that share passages for one: routes that spread, chosen by a forecast of their traffic.

Several plans are made, one after the other. The traffic of each is forecast; what robots lose at each passage is
learned from all forecasts so far, and is a cost of ways into that passage for the next plan. Of the plans that complete
the greatest weight the one that costs least with its traffic is kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from muster.allocation.allocator import Outcome, Routes, finished_plan, scheduled
from muster.allocation.stop import Progress, Stop
from muster.allocation.waiting import Waiting
from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.traffic.forecast import Forecast, forecast
from muster.traffic.managers import shared_roadmap
from muster.traffic.names import drives
from muster.traffic.passage_delays import PassageDelays

if TYPE_CHECKING:
    from muster.allocation.problem import Problem
    from muster.traffic.mission_roadmap import MissionRoadmap
    from muster.traffic.roadmap_plan import RoadmapPlan

Allocate = Callable[["Problem", Stop, Routes | None], Outcome]
OnProgress = Callable[[Progress], None]

FIRST_SHARE = 4
"""The first plan has one part of so many of the time or iterations."""
PLANS, PLANS_BY_ITERATIONS = 40, 8
"""Plans that are made at most, of which one is kept; where iterations are limited fewer, as forecasts take time too."""
_MOST = 3_000_000
"""Robots and tasks times edges of the roadmap up to which traffic is forecast: for more that takes some seconds."""


@dataclass(frozen=True)
class SharedPassages:
    """The passages for one that the robots of a mission share.

    Parameters
    ----------
    mission
        whose robots share them.
    made
        its roadmap.
    """

    mission: Mission
    made: MissionRoadmap
    _roads: RoadmapPlan

    @classmethod
    def of(cls, mission: Mission, traffic: str) -> SharedPassages | None:
        """Those of a mission; None where its robots pass each other as they meet, or are too many for a forecast.

        Raises
        ------
        ParameterError, MissionError, MissingExtraError
            as `shared_roadmap`.
        """
        made = shared_roadmap(traffic, mission)
        if made is None or (len(mission.robots) + len(mission.tasks)) * len(made.roadmap.edges) > _MOST:
            return None
        return cls(mission, made, made.plan())

    def forecast(self, routes: Sequence[Route]) -> Forecast:
        """The traffic of routes that have their stops."""
        return forecast(self.mission, {route.robot: route.stops for route in routes}, self._roads)

    def told(self, plan: Plan) -> Plan:
        """The plan with its times with and without traffic; without them where it has no schedule."""
        if any(len(route.stops) != len(route.tasks) for route in plan.routes):
            return plan
        return _saying(plan, self.forecast(plan.routes))

    def expected(self, problem: Problem, delays: PassageDelays) -> Problem:
        """The problem with the delays that its robots can expect."""
        if not delays:
            return problem
        at = [self.made.point_of.get((x, y), -1) for x, y, _ in problem.all_places.tolist()]
        entries, exits = at[: len(at) // 2], at[len(at) // 2 :]
        robots = np.array([drives(robot) for robot in problem.robots], dtype=np.bool_)
        return replace(problem, known=problem.measured, waiting=Waiting(delays.between(exits, entries), robots)).ready()


def spread(
    problem: Problem,
    shared: SharedPassages,
    allocate: Allocate,
    stop: Stop,
    *,
    allocator: str,
    seed: int,
    on_progress: OnProgress | None = None,
) -> Plan:
    """The best of several plans, whose routes spread over the passages that robots share.

    The first has a quarter of the time or iterations. Where its robots are not in each other's way a second one goes on
    from it with the rest; else the others share what is left, and each is searched for at least as long as a forecast
    takes. Each goes on from the best so far, or begins anew after one that brought nothing new.

    Parameters
    ----------
    allocate
        makes routes for a problem, from first ones where there are any.
    stop
        ends all of it; a forecast that has begun is ended.
    allocator, seed
        of the plan.
    """
    spreading = _Spreading(problem, shared, allocate, stop, on_progress)
    spreading.make(FIRST_SHARE)
    left = (PLANS if stop.iterations_left is None else PLANS_BY_ITERATIONS) - 1
    while left > 0 and spreading.has_time:
        left = left if spreading.delays else 1
        spreading.make(left)
        left -= 1
    best = spreading.best
    assert best is not None
    stop.improved(best.weight, best.objective)
    plan = finished_plan(problem, stop, best.outcome, allocator=allocator, seed=seed)
    return plan if best.told is None else _saying(plan, best.told)


def _saying(plan: Plan, told: Forecast) -> Plan:
    return replace(plan, time_with_traffic_s=told.with_traffic_s, time_without_traffic_s=told.alone_s)


@dataclass(frozen=True)
class _Candidate:
    """Routes that may be kept, and what they come to."""

    outcome: Outcome
    weight: float
    objective: float
    cost: tuple[float, float] = (math.inf, math.inf)
    told: Forecast | None = None

    @property
    def rank(self) -> tuple[float, float, float]:
        """The lower, the better."""
        return -self.weight, *self.cost

    @property
    def routes(self) -> Routes:
        return [list(route) for route in self.outcome.routes]


class _Spreading:
    """Makes plans one after the other, keeps the best, and learns from the traffic of each."""

    def __init__(
        self, problem: Problem, shared: SharedPassages, allocate: Allocate, stop: Stop, on_progress: OnProgress | None
    ) -> None:
        self._problem, self._shared, self._allocate = problem, shared, allocate
        self._stop, self._on_progress = stop, on_progress
        speeds = [robot.speed_mps for robot in problem.robots]
        self.delays = PassageDelays(shared.made.roadmap, float(np.median(speeds)))
        self.best: _Candidate | None = None
        self._made, self._forecast_s = 0, 0.0
        self._seen: set[tuple[tuple[int, ...], ...]] = set()  # the routes of which the traffic has been forecast
        self._begins_anew = False

    @property
    def has_time(self) -> bool:
        """Whether there is time for another plan and its forecast."""
        left_s = self._stop.time_left_s
        return not self._stop.due() and (left_s is None or left_s > self._forecast_s)

    def make(self, left: int) -> None:
        """Make a plan with one part of so many of what is left of time or iterations."""
        expected = self._shared.expected(self._problem, self.delays)
        part = self._part(left)
        outcome = self._allocate(expected, part, None if self._begins_anew or self.best is None else self.best.routes)
        self._stop.iterations_done += part.iterations_done
        self._made += 1
        routes = tuple(map(tuple, outcome.routes))
        self._begins_anew = routes in self._seen  # the next one, as this one was known
        if self._begins_anew:
            return
        self._seen.add(routes)
        candidate = self._candidate(outcome)
        if self.best is None or candidate.rank < self.best.rank:
            self.best = candidate

    def _part(self, left: int) -> Stop:
        time_left_s, iterations_left = self._stop.time_left_s, self._stop.iterations_left
        return self._stop.part(
            time_limit=None if time_left_s is None else min(time_left_s, max(time_left_s / left, self._forecast_s)),
            iterations=None if iterations_left is None else iterations_left // left,
            on_progress=self._report,
        )

    def _report(self, progress: Progress) -> None:
        """Tell the progress of the whole, with the figures of the best plan so far."""
        if self._on_progress is None:
            return
        best = progress if self.best is None else self.best
        done = self._stop.iterations_done + progress.iterations
        share = (self._made + (progress.share or 0.0)) / PLANS
        self._on_progress(Progress(self._stop.elapsed_s, done, best.weight, best.objective, share=share))

    def _candidate(self, outcome: Outcome) -> _Candidate:
        """What routes come to with their traffic; nothing is forecast for who is in a hurry."""
        candidate = _Candidate(outcome, *self._problem.value(outcome.routes))
        if self._stop.interrupted:
            return candidate
        began_s = self._stop.elapsed_s
        routes = scheduled(self._problem, candidate.routes)
        told = self._shared.forecast(routes)
        self.delays.learn(told)
        self._forecast_s = self._stop.elapsed_s - began_s
        return replace(candidate, cost=_cost(self._problem, candidate.objective, routes, told), told=told)


def _cost(problem: Problem, objective: float, routes: Sequence[Route], told: Forecast) -> tuple[float, float]:
    """The objective with what robots are delayed as usage, or as time; then the time with traffic."""
    delay_s = {one.robot: one.delay_s for one in told.robots}
    delays = [delay_s.get(robot.id, 0.0) * (1.0 if problem.in_time else robot.speed_mps) for robot in problem.robots]
    usages = [(route.usage or 0.0) + delay for route, delay in zip(routes, delays, strict=True)]
    time_s = math.inf if told.with_traffic_s is None else told.with_traffic_s
    match problem.objective:
        case "total":
            return sum(usages), time_s
        case "max":
            return max(usages), time_s
        case "total+max":
            return sum(usages) + max(usages), time_s
        case "average":
            return objective + sum(delays) / len(delays), time_s
        case "makespan":
            return time_s, objective
        case _:
            return objective, time_s
