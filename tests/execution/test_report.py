"""The report of a mission that was carried out."""

import json

import pytest
from tests.execution.world import World, carry_out

from muster import Mission, Plan, Robot, Route, Task
from muster.execution.executor import Executor
from muster.execution.reports.report import report_of
from muster.mission.model import OBJECTIVES, Event


def reported(events=(), objective=None, **numbers):
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(0, 5))),
        tasks=(
            Task(id="x", position=(6, 0), actuation_cost=2),
            Task(id="y", position=(3, 5), prerequisites=("x",)),
            Task(id="z", position=(0, 9)),
        ),
        events=events,
    )
    plan = Plan(objective=objective, routes=(Route("a", ("x",)), Route("b", ("y",))))
    world = World(mission)
    executor = carry_out(Executor(mission, plan, world.ports), world, step=0.01)
    return report_of(executor.account, **({"contacts": 0, "min_distance_m": 3.2} | numbers))


def test_it_prints_what_the_command_promises():
    data = json.loads(json.dumps(reported(contacts=2).as_dict()))
    assert list(data) == [
        "mission_time_s",
        "tasks_done",
        "tasks_lost",
        "contacts",
        "min_distance_m",
        "waiting_s",
        "reallocations",
        "robots",
        "starts_s",
        "ends_s",
        "objective",
        "tasks",
        "done_twice",
        "found",
        "waiting_by_cause_s",
        "lateness_s",
        "missed",
        "deadlines_missed_s",
        "within_exceeded_s",
        "shifts_exceeded_s",
        "traffic",
        "orders",
        "tasks_forgotten",
        "ground",
        "team",
        "remarks",
    ]
    assert (data["done_twice"], data["found"], data["remarks"]) == ({}, [], [])
    assert data["tasks_done"] == ["x", "y"]
    assert data["tasks_lost"] == [{"task": "z", "reason": "left out by the plan"}]
    assert (data["contacts"], data["min_distance_m"], data["reallocations"]) == (2, 3.2, 0)
    at_stations = {"least_charge": None, "charged": 0.0, "station_visits": 0, "slot_wait_s": 0.0}
    assert data["robots"] == [
        {"robot": "a", "usage_planned": 8, "usage_flown": pytest.approx(8), "charge": None} | at_stations,
        {"robot": "b", "usage_planned": 3, "usage_flown": pytest.approx(3), "charge": None} | at_stations,
    ]
    assert data["starts_s"] == {"x": pytest.approx(6, abs=0.02), "y": pytest.approx(8, abs=0.02)}
    assert data["ends_s"] == {"x": pytest.approx(8, abs=0.02), "y": pytest.approx(8, abs=0.04)}
    assert data["mission_time_s"] == pytest.approx(8, abs=0.04)
    assert data["waiting_s"] == pytest.approx(5, abs=0.03)
    assert data["objective"] == {"name": "total+max", "planned": None, "flown": pytest.approx(8 + 3 + 8)}
    assert data["tasks"] == [
        {
            "task": "x",
            "robot": "a",
            "usage_planned": 8,
            "usage_flown": pytest.approx(8),
            "waiting_s": 0,
            "team": [],
            "lateness_s": 0,
            "done_m_off": None,
            "within_m": None,
        },
        {
            "task": "y",
            "robot": "b",
            "usage_planned": 3,
            "usage_flown": pytest.approx(3),
            "waiting_s": pytest.approx(5, abs=0.03),
            "team": [],
            "lateness_s": 0,
            "done_m_off": None,
            "within_m": None,
        },
    ]


def test_the_objective_as_it_was_flown():
    """By state: a comes to x with 6, b to y with 3; a has used 8 in the end, b 3, and both are done after 8 s."""
    flown = {name: reported(objective=name).objective for name in OBJECTIVES}
    assert {name: objective.name for name, objective in flown.items()} == {name: name for name in OBJECTIVES}
    assert flown["total+max"].flown == pytest.approx(19)
    assert flown["total"].flown == pytest.approx(11)
    assert flown["max"].flown == pytest.approx(8)
    assert flown["average"].flown == pytest.approx(4.5, abs=0.03)
    assert flown["makespan"].flown == pytest.approx(8, abs=0.04)


def test_one_robot_has_no_distance():
    assert reported(min_distance_m=None).as_dict()["min_distance_m"] is None


def test_usage_of_each_task_planned_and_flown():
    tasks = {task.task: task for task in reported().tasks}
    assert tasks["x"].usage_planned == tasks["x"].usage_flown == pytest.approx(8)
    assert tasks["y"].usage_planned == tasks["y"].usage_flown == pytest.approx(3)


def test_usage_of_a_task_whose_plan_changed_on_the_way():
    """At 2 s robot a has gone 2 m; what is planned for its task is that, and what is left."""
    report = reported(events=[Event(at_s=2, new_task=Task(id="w", position=(60, 0)))])
    tasks = {task.task: task for task in report.tasks}
    assert report.reallocations == 1
    assert tasks["w"].usage_planned == pytest.approx(tasks["w"].usage_flown, abs=0.02)
    assert sum(task.usage_flown for task in report.tasks) == pytest.approx(sum(r.usage_flown for r in report.robots))
