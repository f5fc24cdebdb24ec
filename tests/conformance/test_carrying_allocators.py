"""Every allocator plans goods and energy that the judge accepts, or refuses them by name."""

import re
from dataclasses import replace

import pytest
from tests.carried_missions.missions import carried_mission

import muster
from muster.allocation.capabilities import those_that_can
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.mission.model import Battery, Lag, Station
from muster.model.problem import Problem
from muster.verification import verify

every_allocator = pytest.mark.parametrize("allocator", ALLOCATORS)
RULES = muster.Rules(timing="constant", return_to_start=True)
DOCK = Station(id="dock", position=(5.0, 0.0), services=("charge", "unload"), charge_per_s=1.0)
LOADED = (muster.Task(id="a", position=(9.0, 0.0), load=2), muster.Task(id="b", position=(8.0, 1.0), load=2))
CARRIED = (muster.Task(id="c", position=(2.0, 3.0), load=1), muster.Task(id="d", position=(6.0, 3.0), delivers="c"))


def mission_of(word):
    """A mission in which a robot cannot do all without unloading, or without charging."""
    battery = Battery(capacity=14.0) if word == "battery" else None
    loads = {"load_capacity": 3.0} if word == "load" else {}
    tasks = (*LOADED, *CARRIED) if word == "load" else (muster.Task(id="a", position=(9.0, 2.0)),)
    robot = muster.Robot(id="r_0", position=(0.0, 0.0), battery=battery, **loads)
    return muster.Mission(name=word, rules=RULES, robots=(robot,), tasks=tasks, stations=(DOCK,))


@every_allocator
@pytest.mark.parametrize("word", ["load", "battery"])
def test_goods_and_energy_are_planned_or_refused_by_name(allocator, word):
    mission = mission_of(word)
    assert word in Problem.compile(mission).asked
    if word not in ALLOCATORS[allocator].can:
        with pytest.raises(muster.ParameterError, match=rf"{re.escape(allocator)} cannot do .*\({word}\)"):
            muster.solve(mission, allocator, iterations=1)
        return
    plan = muster.solve(mission, allocator, iterations=50, seed=1)
    assert verify(mission, plan).valid
    assert plan.tasks_completed == len(mission.tasks)
    assert any(stop.is_station for route in plan.routes for stop in route.stops)


@pytest.mark.long(keep=34)
@pytest.mark.parametrize("allocator", those_that_can(["load", "battery"]))
@pytest.mark.parametrize("seed", range(1000, 1015))
def test_plans_of_missions_with_goods_and_energy_are_admissible(allocator, seed):
    mission = carried_mission(seed)
    plan = ALLOCATORS[allocator].solve(Problem.compile(mission).ready(), Stop(iterations=20), seed=seed)
    verdict = verify(mission, plan)
    assert [violation.detail for violation in verdict.violations] == []
    assert plan.objective_value == pytest.approx(verdict.value())


@pytest.mark.parametrize("allocator", those_that_can(["load", "lag"]))
@pytest.mark.parametrize("of", ["c", "e"])
def test_lags_hold_beside_goods(allocator, of):
    lagged = {"prerequisites": (of,), "lags": {of: Lag(after_s=20, within_s=60)}}
    tasks = (CARRIED[0], replace(CARRIED[1], **lagged), muster.Task(id="e", position=(3.0, 0.0)))
    robots = (muster.Robot(id="r_0", position=(0.0, 0.0)), muster.Robot(id="r_1", position=(1.0, 0.0)))
    mission = muster.Mission(rules=RULES, robots=robots, tasks=tasks)
    plan = muster.solve(mission, allocator, iterations=50, seed=1)
    assert verify(mission, plan).valid
    assert plan.tasks_completed == 3
