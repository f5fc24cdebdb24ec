"""A standing fleet with batteries serves orders for long, and charges when it has nothing to do."""

from random import Random

from tests.carry_charge import battery, charger, mission, robot

import muster
from muster.execution import Standing
from muster.mission.model import Event, Task
from muster.running.simulation import Simulation

DURATION_S = 900.0


def orders(seed, until_s):
    """Transports and other tasks, as they come."""
    random, at_s, k = Random(seed), 0.0, 0

    def place():
        return round(random.uniform(-15, 15), 1), round(random.uniform(-15, 15), 1)

    while (at_s := at_s + random.expovariate(1 / 25)) < until_s:
        k += 1
        yield Event(at_s=at_s, new_task=Task(id=f"take {k}", position=place(), load=1, duration_s=1))
        yield Event(at_s=at_s, new_task=Task(id=f"bring {k}", position=place(), delivers=f"take {k}", duration_s=1))


def test_orders_are_done_though_batteries_hold_a_few_of_them_only():
    robots = [robot(f"r_{k}", 2.0 * k, battery=battery(100, reserve=0.15), load_capacity=2) for k in range(3)]
    given = mission(robots, [], [charger(rate=4, slots=2)])
    standing = Standing(until_s=DURATION_S, orders=orders(1, DURATION_S - 150), searches=False)
    simulation = Simulation(given, muster.solve(given, "greedy"), standing=standing)
    kinds, idle_calls = [], 0
    while not simulation.done and simulation.time_s < 3 * DURATION_S:
        kinds += [event.kind for event in simulation.advance(simulation.time_s + 0.5)]
        idle_calls += any(call.planned is False for state in simulation._executor.crew.values() for call in state.calls)
    report = simulation.result()
    assert simulation.done
    assert report.orders.lost == report.orders.refused == 0
    assert report.orders.done == report.orders.taken > 40
    assert "robot_fails" not in kinds
    assert idle_calls > 0
    assert min(row.least_charge for row in report.robots) > 0.14
    assert sum(row.station_visits for row in report.robots) > 5
