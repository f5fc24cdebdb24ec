"""What ways to stations use is looked up once for a robot that stays where it is, and anew when ways change."""

import pytest

from muster.execution import Standing
from muster.execution.stations.energy_watch import EnergyWatch
from muster.mission.model import Event, Map, Mission, Robot, Rules, Station, Task, Zone
from muster.mission.plan import Plan
from muster.mission.stations import Battery
from muster.running.simulation import Simulation

HALL = ((0, 0), (20, 0), (20, 10), (0, 10))


def wall(low, high, **more):
    return Zone(polygon=((9.8, low), (10.2, low), (10.2, high), (9.8, high)), **more)


def fleet():
    battery = Battery(capacity=300, at_start=0.9)
    return Mission(
        map=Map(boundary=HALL, zones=(wall(0, 1), wall(1, 2, id="near", open=True), wall(2, 8))),
        robots=tuple(
            Robot(id=f"r_{k}", position=(4 + 2 * k, 1.5), radius_m=0.2, battery=battery, end_position=end)
            for k, end in enumerate([None, (2.0, 8.0), None])
        ),
        tasks=(),
        stations=(Station(id="dock", position=(18, 1.5), services=("charge",), charge_per_s=2),),
        rules=Rules(objective="lateness"),
    )


def test_what_a_way_uses_is_what_is_found_anew(monkeypatch):
    used, asked = EnergyWatch._usage, []
    found_anew, searched = EnergyWatch._usage_of_way, []

    def compared(watch, state, goal):
        usage = used(watch, state, goal)
        assert usage == found_anew(watch, state, goal)
        asked.append(usage)
        return usage

    def counted(watch, state, goal):
        searched.append(goal)
        return found_anew(watch, state, goal)

    monkeypatch.setattr(EnergyWatch, "_usage", compared)
    monkeypatch.setattr(EnergyWatch, "_usage_of_way", counted)
    events = [
        Event(at_s=5, door_closes="near"),
        Event(at_s=10, new_task=Task(id="far", position=(15, 9), duration_s=1)),
        Event(at_s=40, door_opens="near"),
        Event(at_s=41, new_task=Task(id="by", position=(6, 4), duration_s=1)),
    ]
    standing = Standing(until_s=60, orders=events, searches=False)
    simulation = Simulation(fleet(), Plan(routes=()), standing=standing, traffic="free")
    while not simulation.done:
        simulation.advance(simulation.time_s + 0.5)
    assert simulation.result().orders.done == 2
    assert len({usage for usage in asked if usage == pytest.approx(14)}) == 1  # through the door
    assert any(usage is not None and usage > 16 for usage in asked)  # around the wall
    assert 10 * len(searched) < len(asked)
