"""Simulated runs of straight legs among closed areas: where robots are at each step, and doors that close and open."""

from dataclasses import replace

import pytest
from tests.closed_missions import closed_mission, depth_m

import muster
from muster import Mission, Robot, Task
from muster.mission.events import Event
from muster.mission.rules import Rules
from muster.mission.site import Map, Zone


class Depths:
    """An observer that keeps how deep robots with tasks were in what is closed to them."""

    def __init__(self, mission, plan):
        busy = {route.robot for route in plan.routes if route.tasks}
        self.robots = [(k, robot) for k, robot in enumerate(mission.robots) if robot.id in busy]
        self.mission, self.deepest_m = mission, -1.0

    def on_step(self, time_s, positions, headings, velocities):
        for k, robot in self.robots:
            self.deepest_m = max(self.deepest_m, depth_m(self.mission, robot, positions[k].tolist()))

    def __getattr__(self, name):
        return lambda *_: None  # of nothing else


@pytest.mark.long
@pytest.mark.parametrize("seeds", [range(12), pytest.param(range(12, 120), marks=pytest.mark.long)])
def test_no_robot_enters_a_closed_area(seeds):
    runs = 0
    for seed in seeds:
        mission = closed_mission(seed)
        plan = muster.solve(mission, "greedy")
        if plan.tasks_completed:
            depths = Depths(mission, plan)
            report = muster.simulate(mission, plan, observers=[depths])
            assert depths.deepest_m < 1e-6, seed
            assert set(dict(report.tasks_lost)) == {item.task for item in plan.unassigned}
            runs += 1
    assert runs > len(seeds) / 2


@pytest.mark.parametrize(("opens_s", "lost"), [(None, {"a", "c"}), (60.0, set())])
def test_a_door_that_closes_stops_straight_legs_too(opens_s, lost):
    gate = Zone(polygon=((15, 0), (17, 0), (17, 30), (15, 30)), id="gate", open=True)
    events = [Event(at_s=8.0, door_closes="gate")] + ([Event(at_s=opens_s, door_opens="gate")] if opens_s else [])
    mission = Mission(
        name="door",
        robots=(Robot(id="r", position=(1, 1)),),
        tasks=(Task(id="a", position=(30, 1)), Task(id="b", position=(5, 5)), Task(id="c", position=(30, 9))),
        map=Map(boundary=((0, 0), (40, 0), (40, 30), (0, 30)), zones=(gate,)),
        rules=Rules(travel="euclidean"),
        events=tuple(events),
    )
    plan = muster.solve(mission, "greedy")
    assert plan.complete
    closed = replace(mission, map=replace(mission.map, zones=(replace(gate, open=False),)))
    depths = Depths(closed, plan)
    report = muster.simulate(mission, plan, observers=[depths])
    assert set(dict(report.tasks_lost)) == lost
    if lost:
        assert depths.deepest_m < 1e-6
        assert all("there is no way to it" in reason for _, reason in report.tasks_lost)
