"""The client takes missions, mission files and ids, and returns plans, verdicts and reports."""

import base64
import dataclasses
from pathlib import Path

import pytest
from tests.muster_control.serving import served

import muster
from muster.mission.errors import ParameterError
from muster_control.client import Client

FLOOR = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAQAAAACCAAAAABawyK/AAAAEklEQVR4nGP8z8DAwMTAwMAAAAkVAQPWmbXHAAAAAElFTkSuQmCC"
)
MAPPED = """
schema: muster/1
name: mapped
map: {image: floors/floor.png, resolution_m: 1}
robots: [{id: r_0, position: [0.5, 0.5]}]
tasks: [{id: a, position: [2.5, 0.5]}]
"""


@pytest.fixture(scope="module")
def control(tmp_path_factory):
    with served(tmp_path_factory.mktemp("server")) as url, Client(url) as control:
        yield control


@pytest.fixture
def mapped(tmp_path, monkeypatch):
    """A mission file whose map lies in a folder beside it."""
    monkeypatch.chdir(tmp_path)
    Path("floors").mkdir()
    Path("floors/floor.png").write_bytes(FLOOR)
    Path("mapped.yaml").write_text(MAPPED, encoding="utf-8")
    return Path("mapped.yaml")


def test_a_name_a_mission_and_a_file_are_planned_alike(control, mapped):
    here = muster.solve(muster.load("6T-2R"), iterations=20, seed=3)
    for given in ("6T-2R", muster.load("6T-2R")):
        plan = control.plan(given, iterations=20, seed=3).wait()
        assert isinstance(plan, muster.Plan)
        assert plan.routes == here.routes
        assert plan.entry.mission == "6T-2R"
    for given in ("mapped.yaml", mapped, muster.load(mapped)):
        plan = control.plan(given, allocator="greedy").wait()
        assert (plan.tasks_completed, plan.entry.mission) == (1, "mapped")
        assert muster.verify(muster.load(mapped), plan).valid


def test_a_plan_of_the_server_is_a_plan(control, tmp_path):
    plan = control.plan("6T-2R", iterations=20).wait()
    assert plan.as_dict() == control.plans.get(plan.id).as_dict()
    plan.save(tmp_path / "plan.json")
    read = muster.read_plan(tmp_path / "plan.json")
    assert (read.routes, read.objective_value) == (plan.routes, plan.objective_value)
    uploaded = control.plans.upload("6T-2R", tmp_path / "plan.json")
    assert (uploaded.routes, uploaded.entry.origin) == (plan.routes, "uploaded")
    assert control.plans.upload("6T-2R", read).routes == plan.routes


def test_plans_can_be_a_start_or_fixed(control):
    mission = muster.load("6T-2R")
    first = muster.solve(mission, "greedy")
    beginnings = dataclasses.replace(
        first, routes=tuple(dataclasses.replace(r, tasks=r.tasks[:1]) for r in first.routes), unassigned=()
    )
    plan = control.plan("6T-2R", iterations=20, start=first, fixed=beginnings, rewire=True).wait()
    here = muster.solve(mission, iterations=20, start=first, fixed=beginnings, rewire=True)
    assert plan.routes == here.routes
    again = control.plan("6T-2R", iterations=0, start=plan).wait()
    assert again.objective_value <= plan.objective_value


def test_a_verdict_is_that_of_the_judge(control):
    plan = control.plan("6T-2R", iterations=20).wait()
    for given in (plan, plan.id):
        assert control.plans.verdict(given) == muster.verify(muster.load("6T-2R"), plan)


@pytest.mark.long
def test_a_report_is_that_of_a_simulation(control):
    plan = control.plan("6T-2R", iterations=20).wait()
    run = control.start(plan, speed=None, seed=1)
    run.wait()
    report = run.report()
    assert isinstance(report, muster.Report)
    here = muster.simulate(muster.load("6T-2R"), plan, seed=1)
    assert report.as_dict() == here.as_dict()
    assert report.tasks_lost == here.tasks_lost


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"tme_limit": 1}, "\"tme_limit\": unknown; expected .*; did you mean 'time_limit'"),
        ({"seed": -1}, "seed: -1; expected a whole number"),
        ({"allocator": lambda problem: None}, "allocator: a function; expected the name"),
    ],
)
def test_options_are_checked_before_anything_is_sent(control, options, message):
    before = len(control.jobs())
    with pytest.raises(ParameterError, match=message):
        control.plan("6T-2R", **options)
    assert len(control.jobs()) == before
