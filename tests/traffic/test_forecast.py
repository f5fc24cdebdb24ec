"""The forecast of how long a plan takes in traffic, beside what a run takes."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from muster import Simulation, solve
from muster.generation import narrow
from muster.traffic.journeys.forecast import Forecast, RobotForecast, forecast
from muster.traffic.mission_roadmap import MissionRoadmap


def forecast_of(mission, plan):
    shared = MissionRoadmap.of(mission)
    return forecast(mission, {route.robot: route.stops for route in plan.routes}, shared.plan())


@pytest.mark.long
@pytest.mark.parametrize("scene", [narrow.aisles, narrow.dead_ends])
def test_runs_take_as_long_as_forecast(scene):
    mission = scene("differential-drive", 1, 6)
    plan = solve(mission, "greedy")
    told = forecast_of(mission, plan)
    assert all(0.0 < one.alone_s <= one.with_traffic_s + 1e-9 < math.inf for one in told.robots)
    assert any(one.with_traffic_s > one.alone_s + 1.0 for one in told.robots)
    simulation = Simulation(mission, plan, traffic="reserve")
    while not simulation.done:
        simulation.advance(simulation.time_s + 10.0)
    assert max(one.with_traffic_s for one in told.robots) == pytest.approx(simulation.time_s, rel=0.15)


@pytest.mark.long
def test_robots_without_tasks_stay_where_they_do_not_hinder():
    mission = narrow.one_way_door("holonomic", 0, 4)
    plan = solve(mission, "greedy")
    idle = replace(plan, routes=tuple(replace(route, tasks=(), stops=()) for route in plan.routes))
    assert [one.with_traffic_s for one in forecast_of(mission, idle).robots] == [0.0] * 4


def test_who_finds_no_way_among_the_others_is_delayed_for_ever():
    late = RobotForecast("a", None, 4.0)
    told = Forecast((late, RobotForecast("b", 5.0, 3.0)), (), ())
    assert (late.delay_s, told.with_traffic_s, told.alone_s) == (math.inf, None, 4.0)
