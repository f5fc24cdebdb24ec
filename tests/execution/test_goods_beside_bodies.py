"""Goods in the body of a robot that failed are fetched beside it."""

from dataclasses import replace
from pathlib import Path

import pytest

import muster
from muster import load
from muster.mission.events import Event
from muster.mission.site import Map, Zone

CASE = Path(__file__).parents[1] / "data" / "cases" / "team" / "lies0.3.yaml"


def carried_out(mission, **how):
    events = []
    plan = muster.solve(mission, iterations=200, seed=1)
    report = muster.simulate(mission, plan, on_event=events.append, seed=1, **how)
    lies = [event.data["position"] for event in events if event.kind == "load_lies"]
    return report, lies


def test_the_case_of_a_body_of_0_3_m():
    report, ((x, y),) = carried_out(load(CASE))
    assert report.tasks_lost == ()
    assert 0.6 < ((x - 23) ** 2 + y**2) ** 0.5 < 1.0


@pytest.mark.parametrize("radii", [(0.3, 0.0), (0.0, 0.3), (1.0, 0.2), (0.2, 1.0), (0.5, 0.5)])
@pytest.mark.parametrize("at_s", [13.0, 20.0, 30.0])
def test_bodies_of_any_size_at_any_place(radii, at_s):
    mission = load(CASE)
    robots = tuple(replace(robot, radius_m=radius) for robot, radius in zip(mission.robots, radii, strict=True))
    mission = replace(mission, robots=robots, events=(Event(at_s=at_s, robot_fails="r_0"),))
    report, lies = carried_out(mission)
    assert len(lies) == 1
    assert report.tasks_lost == ()
    assert not report.contacts or 0.0 in radii  # who has no body drives through others


@pytest.mark.long
def test_the_place_is_one_that_is_free_on_the_map():
    """The robot fails in a dead end of a corridor: beside it are walls, and behind it is the way out."""
    mission = load(CASE)
    walls = (
        Zone(polygon=((12, 0.8), (60, 0.8), (60, 2), (12, 2))),
        Zone(polygon=((12, -2), (60, -2), (60, -0.8), (12, -0.8))),
    )
    tasks = (mission.tasks[0], replace(mission.tasks[1], position=(5.0, 10.0)))
    tasks = (replace(tasks[0], position=(30.0, 0.0)), tasks[1])
    area = Map(boundary=((-5, -10), (60, -10), (60, 30), (-5, 30)), zones=walls)
    mission = replace(mission, map=area, tasks=tasks, events=(Event(at_s=34.0, robot_fails="r_0"),))
    report, ((_, y),) = carried_out(mission)
    assert abs(y) <= 0.5
    assert report.tasks_lost == ()


def test_windows_of_the_work_hold_when_it_is_done_again():
    mission = load(CASE)
    tasks = (replace(mission.tasks[0], window_s=((0.0, 12.0), (80.0, 90.0))), mission.tasks[1])
    plan = muster.solve(replace(mission, tasks=tasks), iterations=50)
    events = []
    report = muster.simulate(replace(mission, tasks=tasks), plan, on_event=events.append)
    begins = [event.time_s for event in events if event.kind == "starts" and event.data["task"] == "pick"]
    assert report.tasks_lost == ()
    assert [80.0 <= begin <= 90.0 for begin in begins] == [False, True]
