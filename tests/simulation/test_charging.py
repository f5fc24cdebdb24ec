"""Batteries of the mission in simulated worlds: usage drains them, stations charge and swap them, empty robots stop."""

import pytest
from tests.carry_charge import battery, charger, mission, robot, swapper, task

from muster.mission.errors import ParameterError
from muster.motion.port import Waypoint
from muster.simulation import KinematicWorld


def world_of(*stations, cls=KinematicWorld, rules=(), **how):
    given = mission([robot(battery=battery(20, 0.5))], [task("a", 1)], stations, **dict(rules))
    return cls(given, **how)


def charge(world):
    return world.ports["r"].telemetry().charge


def worlds():
    return [KinematicWorld, pytest.importorskip("muster_physics").PhysicsWorld]


@pytest.mark.parametrize("which", [0, 1])
def test_usage_drains_and_a_factor_drains_more(which):
    for factor in (1.0, 1.5):
        world = world_of(cls=worlds()[which], drain={"all": factor})
        world.ports["r"].send([Waypoint((4.0, 0.0, 0.0), hold_s=3.0, uses=2.0)])
        while not world.idle("r"):
            world.advance(world.time_s + 1.0)
        assert charge(world) == pytest.approx(0.5 - factor * 6.0 / 20.0, abs=0.01)


@pytest.mark.parametrize("which", [0, 1])
def test_a_robot_is_charged_while_it_stands_there_and_is_served(which):
    world = world_of(charger(x=2, rate=0.5), cls=worlds()[which])
    world.ports["r"].send([Waypoint((2.0, 0.0, 0.0), hold_s=4.0, uses=0.0)])
    world.advance(8.0)
    world.advance(8.0)
    assert charge(world) == pytest.approx(0.4, abs=0.01)  # it only stands there
    world.ports["r"].send([Waypoint((2.0, 0.0, 0.0), hold_s=6.0, uses=0.0, service="dock")])
    world.advance(world.time_s + 3.0)
    assert 0.42 < charge(world) < 0.5
    while not world.idle("r"):
        world.advance(world.time_s + 1.0)
    assert charge(world) == pytest.approx(0.4 + 3.0 / 20.0, abs=0.01)


def test_who_is_served_elsewhere_gets_nothing():
    world = world_of(charger(x=9, rate=5))
    world.ports["r"].send([Waypoint((0.0, 0.0, 0.0), hold_s=6.0, uses=0.0, service="dock")])
    world.advance(8.0)
    world.advance(8.0)
    assert charge(world) == 0.5


def test_a_swap_fills_when_it_is_over():
    world = world_of(swapper(swap_s=5))
    world.ports["r"].send([Waypoint((0.0, 0.0, 0.0), hold_s=5.0, uses=0.0, service="rack")])
    world.advance(4.0)
    assert charge(world) == 0.5
    world.advance(6.0)
    assert charge(world) == 1.0


def test_who_is_empty_stops_and_has_a_full_battery_when_it_recovers():
    world = world_of()
    world.ports["r"].send([Waypoint((15.0, 0.0, 0.0))])
    world.advance(30.0)
    assert charge(world) == 0.0
    assert world.positions[0, 0] == pytest.approx(10, abs=0.7)
    world.recover("r")
    assert charge(world) == 1.0


def test_by_time_what_is_under_way_drains():
    world = world_of(rules={"usage": "time"})
    world.ports["r"].send([Waypoint((3.0, 0.0, 0.0), hold_s=2.0)])
    while not world.idle("r"):
        world.advance(world.time_s + 1.0)
    world.advance(world.time_s + 5.0)
    assert charge(world) == pytest.approx(0.5 - 5.0 / 20.0, abs=0.02)


@pytest.mark.parametrize(("drain", "why"), [({"x": 1.2}, "robot x"), ({"r": 0.0}, "above 0")])
def test_wrong_factors_are_refused(drain, why):
    with pytest.raises(ParameterError, match=why):
        world_of(drain=drain)
