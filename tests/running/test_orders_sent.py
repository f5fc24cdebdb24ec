"""Robots of a fleet get an order where something changes for them, and never the same one again."""

import pytest
from tests.running.test_live import WorldAsFleet, mission

import muster
from muster.generation import narrow
from muster.mission.model import Event, Task
from muster.motion.port import TranslatedPort


class CountedPort(TranslatedPort):
    """Notes each order, and whether it is what is left of the last one."""

    def __init__(self, port, orders):
        super().__init__(port, lambda said: said)
        self.orders, self._last = orders, None

    def send(self, waypoints):
        self._note(tuple(waypoints))
        return super().send(waypoints)

    def cancel(self):
        self._note(())
        return super().cancel()

    def _note(self, waypoints):
        said, last = self.telemetry(), self._last
        left = () if last is None else last[said.passed :] or last[-1:]
        self.orders.append((said.time_s, self.robot, last is not None and waypoints == left))
        self._last = waypoints


class CountingFleet(WorldAsFleet):
    """A bridge to a world that counts orders."""

    simulated_time = True

    def __init__(self, there, events=()):
        super().__init__(there, events)
        self.orders = []
        self._counted = {name: CountedPort(port, self.orders) for name, port in self.world.ports.items()}

    @property
    def ports(self):
        return self._counted

    @property
    def repeated(self):
        return [(time_s, robot) for time_s, robot, again in self.orders if again]


def test_a_robot_that_meets_nobody_gets_one_order_a_task():
    there = mission()
    fleet = CountingFleet(there)
    assert len(muster.carry_out(there, muster.solve(there, "greedy"), fleet, traffic="free").tasks_done) == 4
    assert (len(fleet.orders), fleet.repeated) == (4, [])


def test_a_fleet_on_duty_without_tasks_gets_no_orders():
    there = mission()
    plan = muster.solve(there, "greedy")
    late = Event(at_s=60.0, new_task=Task(id="late", position=(4.0, 4.0)))
    fleet = CountingFleet(there)
    report = muster.carry_out(there, plan, fleet, stay=True, until_s=120.0, orders=[late])
    assert "late" in report.tasks_done
    assert (len(fleet.orders), fleet.repeated) == (5, [])


@pytest.mark.long
@pytest.mark.parametrize(("scene", "count"), [("corridor", 4), ("one_way_door", 8), ("two_way_door", 6), ("aisles", 4)])
def test_where_traffic_is_reserved_robots_are_sent_on_sparingly(scene, count):
    there = getattr(narrow, scene)("differential-drive", 1, count)
    fleet = CountingFleet(there)
    report = muster.carry_out(there, muster.solve(there, "greedy"), fleet, traffic="reserve")
    assert len(report.tasks_done) == len(there.tasks)
    assert not fleet.world.contacts
    assert not fleet.repeated
    assert len(fleet.orders) <= count * report.mission_time_s / 2  # it was four times as many


def test_a_robot_that_waits_for_another_is_not_sent_again_to_where_it_stands():
    there = muster.load("11T-2R")
    fleet = CountingFleet(there)
    report = muster.carry_out(there, muster.solve(there, iterations=300), fleet, traffic="reserve")
    assert len(report.tasks_done) == len(there.tasks)
    assert not fleet.repeated
