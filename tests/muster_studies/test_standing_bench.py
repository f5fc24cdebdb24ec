"""The bench of standing fleets, on a short time on duty."""

from dataclasses import replace

import pytest

from muster_studies.benches import standing

SEED, UNTIL_S = 3, 20.0


@pytest.fixture(scope="module")
def shift():
    """Twenty seconds of a fleet of which three robots begin nearly empty, so that they charge meanwhile."""
    mission = standing.fleet_that_charges(SEED)
    low = [replace(robot, battery=replace(robot.battery, at_start=0.25)) for robot in mission.robots[:3]]
    return standing.on_duty(mission.at_once(robots=(*low, *mission.robots[3:])), SEED, UNTIL_S)


@pytest.mark.long
def test_a_fleet_that_charges_does_every_order_and_is_never_empty(shift):
    came = list(standing.orders(SEED, UNTIL_S))
    assert (shift.orders.taken, shift.orders.done, shift.lost) == (len(came), len(came), 0)
    assert sum(row.station_visits for row in shift.report.robots) > 0
    assert min(row.least_charge for row in shift.report.robots) > 0


@pytest.mark.long
def test_orders_come_more_often_in_a_burst():
    came = [event.at_s for event in standing.orders(SEED, 6 * standing.BURST_EVERY_S)]
    in_burst = [at for at in came if 0 <= at % standing.BURST_EVERY_S - standing.BURST_AT_S < standing.BURST_S]
    assert len(in_burst) / (6 * standing.BURST_S) == pytest.approx(standing.BURST_RATE, rel=0.1)
    others_s = 6 * (standing.BURST_EVERY_S - standing.BURST_S)
    assert (len(came) - len(in_burst)) / others_s == pytest.approx(standing.RATE, rel=0.1)


def test_charging_and_the_time_of_the_last_order_bound_what_any_fleet_does():
    mission = standing.fleet_that_charges(SEED)
    come = list(standing.orders(SEED, standing.HOUR_S))
    most = standing.charging_per_hour(mission, come)
    assert most == pytest.approx(3600 * len(come) / (come[-1].at_s + standing.WORK_S))
    at_once = [replace(event, at_s=0.0) for event in come]
    full, without = standing.charging_per_hour(mission, at_once), standing.most_per_hour(len(come))
    empty = [replace(robot, battery=replace(robot.battery, at_start=0.1)) for robot in mission.robots]
    assert most < standing.charging_per_hour(mission.at_once(robots=tuple(empty)), at_once) < full == without
