"""The passages for one that robots of a mission share: the traffic of plans there, and what it adds to travel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.mission.values.arrays import Floats
from muster.model.waiting import Waiting
from muster.traffic.journeys.forecast import Forecast, Forecaster, is_forecast
from muster.traffic.journeys.passage_delays import PassageDelays
from muster.traffic.managers import shared_roadmap
from muster.traffic.names import drives

if TYPE_CHECKING:
    from muster.model.problem import Problem
    from muster.traffic.mission_roadmap import MissionRoadmap


@dataclass(frozen=True)
class SharedPassages:
    """The passages for one that the robots of a mission share.

    Parameters
    ----------
    mission
        whose robots share them.
    made
        its roadmap.
    forecaster
        of their traffic.
    """

    mission: Mission
    made: MissionRoadmap
    forecaster: Forecaster

    @classmethod
    def of(cls, mission: Mission, traffic: str) -> SharedPassages | None:
        """Those of a mission; None where its robots pass each other as they meet, or are too many for a forecast.

        Raises
        ------
        ParameterError, MissionError, MissingExtraError
            as `shared_roadmap`.
        """
        made = shared_roadmap(traffic, mission)
        if made is None or not is_forecast(mission, made.roadmap):
            return None
        return cls(mission, made, Forecaster(mission, made.plan()))

    def forecast(self, routes: Sequence[Route]) -> Forecast:
        """The traffic of routes that have their stops."""
        return self.forecaster.of({route.robot: route.stops for route in routes})

    def changed(self, routes: Sequence[Route]) -> Forecast:
        """The same of routes most of which are as those of the last forecast: see `Forecaster`."""
        return self.forecaster.changed({route.robot: route.stops for route in routes})

    def undo(self) -> None:
        """Take the last change back: the next one is of the routes before it."""
        self.forecaster.undo()

    def told(self, plan: Plan) -> Plan:
        """The plan with its times with and without traffic; without them where it has no schedule."""
        if any(len(route.stops) != len(route.tasks) for route in plan.routes):
            return plan
        return saying(plan, self.forecast(plan.routes))

    def expected(self, problem: Problem, delays: PassageDelays) -> Problem:
        """The problem with the delays that its robots can expect."""
        if not delays:
            return problem
        robots = np.array([drives(robot) for robot in problem.robots], dtype=np.bool_)
        layers = [self.made.roadmap.layer_for(robot.radius_m) for robot in filter(drives, problem.robots)]
        sizes, counts = np.unique(layers, return_counts=True)
        by_size = [self._delays(problem, delays, int(layer)) for layer in sizes]
        # The mean over robots; of one size exactly its own, so that equal costs stay equal.
        seconds = by_size[0] if len(sizes) == 1 else np.average(by_size, axis=0, weights=counts)
        waiting = Waiting(seconds, robots)
        return replace(_counting_ways_home(problem), known=problem.measured, waiting=waiting).ready()

    def _delays(self, problem: Problem, delays: PassageDelays, layer: int) -> Floats:
        """Seconds from exits to entries of tasks, on a layer; 0 where robots of that size have nothing to do."""
        points = self.made.point_of[layer]
        at = [points.get((x, y), -1) for x, y, _ in problem.all_places.tolist()]
        entries, exits = at[: len(at) // 2], at[len(at) // 2 :]
        return delays.between(exits, entries)


def _counting_ways_home(problem: Problem) -> Problem:
    """The problem whose makespan includes ways to ends, as a time with traffic does."""
    rules = replace(problem.mission.rules, makespan_includes_return=True)
    return replace(problem, mission=replace(problem.mission, rules=rules))


def saying(plan: Plan, told: Forecast) -> Plan:
    """The plan with its times with and without traffic."""
    return replace(plan, time_with_traffic_s=told.with_traffic_s, time_without_traffic_s=told.alone_s)
