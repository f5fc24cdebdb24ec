"""Planned beside flown, as the page of a record has it."""

import json

import muster
from muster import Event
from muster_control.pages.records.figures import (
    ROBOT_HEADS,
    TASK_HEADS,
    cancelled_rows,
    lost_rows,
    objective,
    robot_rows,
    task_rows,
)


def report_of(events=()):
    mission = muster.load("6T-2R")
    simulation = muster.Simulation(mission, muster.solve(mission, "greedy"))
    for event in events:
        simulation.report(event)
    while not simulation.done:
        simulation.advance(3600)
    return json.loads(json.dumps(simulation.result().as_dict()))


def test_every_robot_and_task_has_a_row():
    report = report_of()
    assert [row[0] for row in robot_rows(report)] == [robot.id for robot in muster.load("6T-2R").robots]
    assert [row[0] for row in task_rows(report)] == report["tasks_done"]
    assert {len(row) for row in robot_rows(report)} == {len(ROBOT_HEADS)}
    assert {len(row) for row in task_rows(report)} == {len(TASK_HEADS)}
    assert lost_rows(report) == []


def test_differences_are_those_of_the_report():
    report = report_of()
    for robot, row in zip(report["robots"], robot_rows(report), strict=True):
        assert row[3] == f"{robot['usage_flown'] - robot['usage_planned']:+.2f}"
    planned, flown = report["objective"]["planned"], report["objective"]["flown"]
    assert objective(report) == f"{planned:.1f} planned, {flown:.1f} flown"
    unknown = {"objective": {"name": "total", "planned": None, "flown": 2.0}}
    assert objective(unknown) == "not told planned, 2.0 flown"


def test_what_is_lost_has_its_reason_and_what_was_cancelled_is_not_lost():
    report = report_of([Event(at_s=0, cancel_task="3"), *(Event(at_s=1, robot_fails=f"r_{k}") for k in range(2))])
    assert cancelled_rows(report) == [("3", "cancelled at 0 s")]
    lost = dict(lost_rows(report))
    assert len(lost) + len(report["tasks_done"]) == 5
    assert all("no robot takes part any more" in why for why in lost.values())
