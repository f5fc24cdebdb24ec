"""A mission with clock times and a team over HTTP: planned, judged, explained, carried out, and changed under way."""

import pytest
from tests.muster_control.serving import served

import muster
from muster_control.client import Client

TIMED = """
schema: muster/1
name: timed
starts_at: 2027-03-01T09:59:40+01:00
rules: {objective: lateness}
robots:
  - {id: r_1, position: [0, 0], speed_mps: 2, abilities: {lift_kg: 20}, shift: [null, "12:00"]}
  - {id: r_2, position: [0, 10], speed_mps: 2, abilities: {lift_kg: 20}}
tasks:
  - {id: slab, position: [20, 0], duration_s: 10, needs: {lift_kg: 30}, window: ["10:00", "10:30"], due: "10:00:05"}
  - {id: scan, position: [20, 10], prerequisites: [{task: slab, after_s: 5, within_s: 60}], deadline: "10:05"}
  - {id: early, position: [90, 0], deadline: "09:59:50"}
"""
LATE = {"id": "late", "position": [10, 0], "window": ["10:01", "10:02"], "robots_needed": 2}


@pytest.fixture(scope="module")
def control(tmp_path_factory):
    with served(tmp_path_factory.mktemp("server")) as url, Client(url) as control:
        yield control


@pytest.fixture(scope="module")
def mission(tmp_path_factory):
    file = tmp_path_factory.mktemp("timed") / "timed.yaml"
    file.write_text(TIMED, encoding="utf-8")
    return muster.load(file)


@pytest.fixture(scope="module")
def plan(control, mission):
    return control.plan(mission, iterations=100, seed=1).wait()


def test_the_plan_is_that_of_here_with_its_stops(plan, mission):
    here = muster.solve(mission, iterations=100, seed=1)
    assert plan.routes == here.routes
    (slab, _) = [stop for route in plan.routes for stop in route.stops if stop.name == "slab"]
    assert (slab.begin_s, slab.end_s) == (20, 30)


def test_the_verdict_is_that_of_here(control, plan, mission):
    verdict, here = control.plans.verdict(plan.id), muster.verify(mission, plan)
    assert verdict.value("lateness") == here.value("lateness") == 5
    assert verdict.waiting_s == pytest.approx(here.waiting_s)


def test_the_explanation_names_the_deadline(control, plan):
    assert "deadline" in str(control.plans.explain(plan.id))


@pytest.mark.long
def test_a_run_takes_a_task_with_clock_times_for_two_robots(control, plan):
    run = control.start(plan, speed=25)
    run.act("event", new_task=LATE)
    run.wait()
    assert {"slab", "scan", "late"} <= set(run.report().tasks_done)
    (begun,) = [entry for entry in run.events() if entry.kind == "starts" and entry.data["task"] == "late"]
    assert sorted(begun.data["team"]) == ["r_1", "r_2"]
    assert begun.time_s >= 80  # 10:01 is 80 s after the start


@pytest.mark.long
def test_clock_times_without_a_start_are_refused(control):
    run = control.start(control.plan("6T-2R", iterations=20).wait(), speed=1)
    run.act("event", new_task=LATE)
    run.act("cancel")
    run.wait()
    outcomes = [entry.data["outcome"] for entry in run.events() if entry.kind == "command"]
    assert outcomes[0].startswith("new_task.window: ")
    assert "expected starts_at in the mission" in outcomes[0]
    assert outcomes[-1] == "done"
