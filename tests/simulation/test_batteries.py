"""Batteries in the kinematic world: they fall with usage."""

from dataclasses import replace

import pytest
from tests.simulation.scenes import mission, robot, until_idle

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Rules
from muster.motion.port import Waypoint
from muster.simulation import KinematicWorld


def test_charge_falls_with_the_way_and_with_stops():
    world = KinematicWorld(mission(robot(work_capacity=20.0, speed_mps=0.5)), batteries={"r": 0.9})
    port = world.ports["r"]
    assert port.telemetry().charge == 0.9
    port.send([Waypoint((3.0, 0.0, 0.0)), Waypoint((3.0, 2.0, 0.0), hold_s=4.0)])
    until_idle(world, 60.0)
    assert port.telemetry().charge == pytest.approx(0.9 - (5.0 + 0.5 * 4.0) / 20.0, abs=1e-3)
    port.send([Waypoint((3.0, 3.0, 0.0))])  # what an earlier order took is not forgotten
    until_idle(world, 60.0)
    assert port.telemetry().charge == pytest.approx(0.9 - (6.0 + 0.5 * 4.0) / 20.0, abs=1e-3)


def test_with_usage_in_time_it_falls_with_seconds():
    team = mission(robot(work_capacity=40.0, speed_mps=0.5), rules=Rules(usage="time"))
    world = KinematicWorld(team, batteries={"all": 1.0})
    world.ports["r"].send([Waypoint((5.0, 0.0, 0.0), hold_s=4.0)])
    until_idle(world, 60.0)
    assert world.ports["r"].telemetry().charge == pytest.approx(1 - (10.0 + 4.0) / 40.0, abs=0.01)


def test_only_who_is_named_reports():
    team = mission(robot("a", work_capacity=9.0), robot("b", (0.0, 3.0), work_capacity=9.0))
    one, every = KinematicWorld(team, batteries={"a": 0.5}), KinematicWorld(team, batteries={"all": 1.0, "a": 0.5})
    assert [world.ports[name].telemetry().charge for world in (one, every) for name in "ab"] == [0.5, None, 0.5, 1.0]


@pytest.mark.parametrize(
    ("charges", "why"), [({"x": 1.0}, "robot x"), ({"a": 1.5}, "from 0 to 1"), ({"b": 1.0}, "no work_capacity")]
)
def test_wrong_batteries_are_refused(charges, why):
    with pytest.raises(ParameterError, match=why):
        KinematicWorld(mission(robot("a", work_capacity=9.0), robot("b", (0.0, 3.0))), batteries=charges)


def test_the_report_has_what_is_left():
    team = muster.load("6T-2R")
    team = replace(team, robots=tuple(replace(one, work_capacity=60.0) for one in team.robots))
    plan = muster.solve(team, seed=1, iterations=50)
    report = muster.simulate(team, plan, batteries={"all": 1.0})
    assert max(row.usage_flown for row in report.robots) > 5
    for row in report.robots:
        assert row.charge == pytest.approx(1 - row.usage_flown / 60.0, abs=0.01)
