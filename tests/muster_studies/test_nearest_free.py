"""The rule beside the benches of standing fleets: the nearest free robot takes an order."""

import pytest

from muster.mission.model import Event, Mission, Robot, Station, Task
from muster.mission.stations import Battery
from muster_studies.benches.nearest_free import seconds_until_done
from muster_studies.benches.standing import by_nearest_free, fleet_that_charges, orders


def order(at_s, x, name="o", duration_s=10.0):
    return Event(at_s=at_s, new_task=Task(id=f"{name}{x:g}", position=(x, 0.0), duration_s=duration_s))


def team(*robots, **more):
    return Mission(name="team", robots=robots, tasks=(), **more)


def robot(name, x, **more):
    return Robot(id=name, position=(x, 0.0), speed_mps=2.0, **more)


def test_an_order_goes_to_the_nearest_free_robot_and_else_waits():
    mission = team(robot("near", 10.0), robot("far", 50.0))
    came = [order(0.0, 12.0), order(1.0, 14.0), order(2.0, 40.0)]
    # near: 1 s of way; far: 18 s of way; near, free at 11 s, 14 s to the third, which far would reach after 29 + 13 s
    assert seconds_until_done(mission, came) == pytest.approx([11.0, 28.0, 11.0 - 2.0 + 14.0 + 10.0])


def test_the_robot_that_becomes_free_takes_the_nearest_open_order():
    came = [order(0.0, 0.0), order(1.0, 60.0), order(2.0, 20.0)]
    # free at 10 s at 0: first the one at 20, until 30 s, then the one at 60, until 60 s
    assert seconds_until_done(team(robot("r", 0.0)), came) == pytest.approx([10.0, 59.0, 28.0])


def test_a_robot_whose_battery_does_not_last_charges_first():
    dock = Station(id="dock", position=(0.0, 0.0), services=("charge",), charge_per_s=5.0)
    weak = robot("r", 10.0, battery=Battery(capacity=100.0, at_start=0.5, reserve=0.1))
    # 50 m left: 30 m to the order and 40 m back are too far. 10 m to the dock, 60 m at 5 a second, 40 m, the work
    mission = team(weak, stations=(dock,))
    assert seconds_until_done(mission, [order(0.0, 40.0)]) == pytest.approx([5.0 + 12.0 + 20.0 + 10.0])


def test_all_orders_of_the_benches_are_done():
    came = list(orders(3, 200.0))
    took_s = seconds_until_done(fleet_that_charges(3), came)
    assert len(took_s) == len(came)
    assert min(took_s) >= 10.0
    rows = by_nearest_free(1)
    assert len(rows) == 9
    assert all(row.median > 0 for row in rows)
