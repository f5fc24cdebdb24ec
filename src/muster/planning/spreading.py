"""Plans for robots that share passages for one: routes that spread, chosen by a forecast of their traffic.

Several plans are made, one after the other. The traffic of each is forecast; what robots lose at each passage is
learned from all forecasts so far, and is a cost of ways into that passage for the next plan. Of the plans that complete
the greatest weight the one that costs least with its traffic is varied step by step, each step judged by its traffic.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from muster.allocation.allocator import Allocator, Outcome, Routes, Variations, finished_plan, scheduled
from muster.allocation.stop import Progress, Stop
from muster.mission.plan import Plan, Route
from muster.planning.congestion import SharedPassages, saying
from muster.traffic.journeys.forecast import Forecast
from muster.traffic.journeys.passage_delays import PassageDelays

if TYPE_CHECKING:
    from muster.model.problem import Problem

Allocate = Callable[["Problem", Stop, Routes | None], Outcome]
OnProgress = Callable[[Progress], None]

FIRST_SHARE = 4
"""The first plan has one part of so many of the time or iterations."""
PLANS, PLANS_BY_ITERATIONS = 40, 8
"""Plans that are made at most; where iterations are limited fewer, as forecasts take time too."""
SHARE_OF_PLANS = 0.4
"""Of the time that is had for making plans, where the best can be varied afterwards."""
VARIATIONS_BY_ITERATIONS = 40
"""Variations that are made where iterations are limited."""
CONFIRMED = 3
"""The best variations, of which the traffic is forecast from the beginning, as it is when they are carried out."""
_TOLERANCE = 0.05
"""By how much more than the plan before a variation may cost at first, as a share; in the end nothing."""


def spread(
    problem: Problem,
    shared: SharedPassages,
    allocate: Allocate,
    stop: Stop,
    *,
    allocator: Allocator,
    seed: int,
    on_progress: OnProgress | None = None,
) -> Plan:
    """The best of several plans, whose routes spread over the passages that robots share.

    The first has a quarter of the time or iterations. Where its robots are not in each other's way a second one goes on
    from it with the rest. Else each of the others is searched for at least as long as a forecast takes, and goes on
    from the best so far, or begins anew after one that brought nothing new; then the best is varied, if the allocator
    can.

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
    spreading.make_plans(1.0 if allocator.variations is None else SHARE_OF_PLANS)
    if allocator.variations is not None and spreading.delays:
        spreading.vary(allocator.variations, seed)
    best = spreading.best
    assert best is not None
    stop.improved(best.weight, best.objective)
    plan = finished_plan(problem, stop, best.outcome, allocator=allocator.name, seed=seed)
    return plan if best.told is None else saying(plan, best.told)


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
        return self.outcome.routes


class _Spreading:
    """Makes plans one after the other, keeps the best, learns from the traffic of each, and varies the best."""

    def __init__(
        self, problem: Problem, shared: SharedPassages, allocate: Allocate, stop: Stop, on_progress: OnProgress | None
    ) -> None:
        self._problem, self._shared, self._allocate = problem, shared, allocate
        self._stop, self._on_progress = stop, on_progress
        speeds = [robot.speed_mps for robot in problem.robots]
        self.delays = PassageDelays(shared.made.roadmap, float(np.median(speeds)))
        self.best: _Candidate | None = None
        self._forecast_s = 0.0
        self._seen: set[tuple[tuple[int, ...], ...]] = set()  # the routes of which the traffic has been forecast
        self._begins_anew = False

    def make_plans(self, share: float) -> None:
        """Make plans in this share of the time, where robots are in each other's way."""
        self._make(FIRST_SHARE)
        for left in range((PLANS if self._stop.iterations_left is None else PLANS_BY_ITERATIONS) - 1, 0, -1):
            if not self._has_time or (self.delays and self._stop.share_of_time >= share):
                return
            self._make(left if self.delays else 1)

    def vary(self, variations: Callable[[Problem, Routes, int], Variations], seed: int) -> None:
        """Go on from variations of the best plan that cost little more than the plan before, less and less more."""
        now = self.best
        if now is None or now.told is None or not self._has_time:
            return
        better = [now]
        self._shared.forecast(scheduled(self._problem, now.routes))
        varied = variations(self._shared.expected(self._problem, self.delays), now.routes, seed)
        routes = now.routes
        until = self._until_confirmed()
        until.improved(now.weight, now.objective)  # so that there is something to report
        for _ in until.iterations():
            routes = varied.of(routes)
            if not self._is_new(routes):
                continue  # a step further
            other = self._candidate(Outcome(routes), self._shared.changed)
            if other.weight >= now.weight and other.cost[0] <= now.cost[0] * (1 + _TOLERANCE * (1 - until.share)):
                now = other
            else:
                self._shared.undo()
            if other.rank < better[-1].rank:
                better.append(other)
            routes = now.routes
        for other in better[1:][-CONFIRMED:]:  # the first is forecast already
            self._keep(self._candidate(other.outcome, self._shared.forecast))

    def _until_confirmed(self) -> Stop:
        """Until there is just the time left to confirm the best."""
        left_s = self._stop.time_left_s
        return self._stop.part(
            time_limit=None if left_s is None else max(0.0, left_s - CONFIRMED * self._forecast_s),
            iterations=None if self._stop.iterations_left is None else VARIATIONS_BY_ITERATIONS,
            on_progress=lambda progress: self._report(replace(progress, iterations=0)),
        )

    @property
    def _has_time(self) -> bool:
        """Whether there is time for another plan and its forecast."""
        left_s = self._stop.time_left_s
        return not self._stop.due() and (left_s is None or left_s > self._forecast_s)

    def _make(self, left: int) -> None:
        """Make a plan with one part of so many of what is left of time or iterations."""
        expected = self._shared.expected(self._problem, self.delays)
        part = self._part(left)
        outcome = self._allocate(expected, part, None if self._begins_anew or self.best is None else self.best.routes)
        self._stop.iterations_done += part.iterations_done
        self._begins_anew = not self._is_new(outcome.routes)  # the next one, as this one was known
        if self._begins_anew:
            return
        began_s = self._stop.elapsed_s
        candidate = self._candidate(outcome, self._shared.forecast)
        if candidate.told is not None:
            self.delays.learn(candidate.told)
            self._forecast_s = self._stop.elapsed_s - began_s
        self._keep(candidate)

    def _is_new(self, routes: Routes) -> bool:
        known = len(self._seen)
        self._seen.add(tuple(map(tuple, routes)))
        return len(self._seen) > known

    def _candidate(self, outcome: Outcome, forecast: Callable[[Sequence[Route]], Forecast]) -> _Candidate:
        """What routes come to with their traffic; nothing is forecast for who is in a hurry."""
        candidate = _Candidate(outcome, *self._problem.value(outcome.routes))
        if self._stop.interrupted:
            return candidate
        routes = scheduled(self._problem, outcome.routes)
        told = forecast(routes)
        return replace(candidate, cost=_cost(self._problem, candidate.objective, routes, told), told=told)

    def _keep(self, candidate: _Candidate) -> None:
        if self.best is None or candidate.rank < self.best.rank:
            self.best = candidate

    def _part(self, left: int) -> Stop:
        left_s, iterations_left = self._stop.time_left_s, self._stop.iterations_left
        return self._stop.part(
            time_limit=None if left_s is None else min(left_s, max(left_s / left, self._forecast_s)),
            iterations=None if iterations_left is None else iterations_left // left,
            on_progress=self._report,
        )

    def _report(self, progress: Progress) -> None:
        """Tell the progress of the whole, with the figures of the best plan so far."""
        if self._on_progress is None:
            return
        best = progress if self.best is None else self.best
        done, left = self._stop.iterations_done + progress.iterations, self._stop.iterations_left
        of_iterations = done / (self._stop.iterations_done + left) if left else 0.0
        share = min(1.0, max(self._stop.share_of_time, of_iterations))
        self._on_progress(Progress(self._stop.elapsed_s, done, best.weight, best.objective, share=share))


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
