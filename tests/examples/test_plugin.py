"""The example package: installed, its allocator and its action are there for every door."""

import asyncio
import json
from pathlib import Path

import pytest
import yaml
from jsonschema import Draft202012Validator

from muster_control.work import Pool

EXAMPLE = Path(__file__).parents[2] / "examples" / "plugin"
MISSION = EXAMPLE / "mission.yaml"
ROUTES = {"r_0": ["statue"], "r_1": ["gate"]}
pytestmark = pytest.mark.xdist_group("plugin")  # the package is installed once


def test_the_package_is_about_forty_lines():
    assert len((EXAMPLE / "muster_example.py").read_text(encoding="utf-8").splitlines()) <= 40


def test_check_knows_the_action(muster):
    answer = json.loads(muster("check", MISSION, "--format", "json").stdout)
    assert (answer["errors"], answer["impossible"]) == ([], [])


@pytest.mark.long
def test_check_refuses_what_the_action_does_not_take(muster, tmp_path):
    wrong = tmp_path / "wrong.yaml"
    for key, expected in {
        "shots: many": 'tasks[0].action.shots: "many"; expected a whole number of at least 1, at most 36',
        "shits: 8": "tasks[0].action.shits: unknown key; expected a known key; did you mean 'shots'?",
    }.items():
        wrong.write_text(MISSION.read_text(encoding="utf-8").replace("shots: 8", key), encoding="utf-8")
        ended = muster("check", wrong)
        assert ended.returncode == 2
        assert ended.stderr.splitlines()[0] == f"{wrong}:7: {expected}"


@pytest.mark.long
def test_solve_knows_the_allocator_and_its_parameter(muster):
    plan = json.loads(muster("solve", MISSION, "--allocator", "nearest", "--format", "json").stdout)
    assert {route["robot"]: route["tasks"] for route in plan["routes"]} == ROUTES
    near = muster("solve", MISSION, "-a", "nearest", "--set", "reach_m=3", "--format", "json")
    assert [route["tasks"] for route in json.loads(near.stdout)["routes"]] == [[], ["gate"]]
    assert "nearest" in muster("solve", "--list-allocators").stdout


@pytest.mark.long
def test_simulate_carries_the_action_out(muster, tmp_path):
    muster("solve", MISSION, "--allocator", "nearest", "-o", tmp_path / "plan.json", "-q")
    report = json.loads(muster("simulate", MISSION, "--plan", tmp_path / "plan.json", "--format", "json").stdout)
    assert sorted(report["tasks_done"]) == ["gate", "statue"]
    usage = {row["robot"]: row["usage_flown"] for row in report["robots"]}
    assert usage["r_0"] == pytest.approx(7 + 14 * 0.3826834, rel=1e-3)  # 7 m to the eight places, 7 chords


def test_the_schema_has_the_action_and_its_key(run):
    validator = Draft202012Validator(json.loads(run("-m", "muster.mission.json_schema").stdout))
    data = yaml.safe_load(MISSION.read_text(encoding="utf-8"))
    assert list(validator.iter_errors(data)) == []
    for wrong in ({"name": "photograph"}, {"name": "photograph", "shots": 0}, {"name": "delivery", "shots": 2}):
        data["tasks"][0]["action"] = wrong
        assert list(validator.iter_errors(data)) != []


def test_missions_with_the_action_are_built_saved_and_read_in_python(run, tmp_path):
    code = f"""
import muster
mission = muster.load({str(MISSION)!r})
assert mission.tasks[0].action == muster.Action(name="photograph", extra={{"shots": 8}})
mission.save({str(tmp_path / "copy.yaml")!r})
assert muster.load({str(tmp_path / "copy.yaml")!r}) == mission
for wrong in ({{"shots": 0}}, {{"shot": 8}}, {{}}):
    try:
        muster.Action(name="photograph", extra=wrong)
    except muster.MissionError as error:
        print(error)
"""
    assert run("-c", code).stdout.splitlines() == [
        "<mission>: shots: 0; expected a whole number of at least 1, at most 36",
        "<mission>: shots: missing; expected a value: photograph needs shots",
        "<mission>: shot: unknown key; expected the keys of photograph: shots",
        "<mission>: shots: missing; expected a value: photograph needs shots",
    ]


def test_a_worker_of_mission_control_knows_both(installed, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(installed))
    mission = {"text": MISSION.read_text(encoding="utf-8"), "name": "photographs", "files": {}}

    async def answers():
        pool = Pool(workers=1, memory_mb=512)
        try:
            known = await pool.run("allocators", {})
            checked = await pool.run("check", {"mission": mission})
            planned = await pool.run("plan", {"mission": mission, "allocator": "nearest"})
        finally:
            await pool.close()
        return known, checked, planned

    known, checked, planned = asyncio.run(answers())
    assert "nearest" in [allocator["name"] for allocator in known["allocators"]]
    assert checked["errors"] == []
    assert checked["mission"]["tasks"][0]["action"] == {"name": "photograph", "shots": 8}
    assert {route["robot"]: route["tasks"] for route in planned["plan"]["routes"]} == ROUTES


def test_a_plan_that_the_judge_rejects_is_the_packages_fault(run, tmp_path):
    poor = tmp_path / "poor.yaml"
    poor.write_text(MISSION.read_text(encoding="utf-8").replace("[20, 0]", "[20, 0], work_capacity: 1"), "utf-8")
    ended = run("-c", f"import muster; muster.solve(muster.load({str(poor)!r}), 'nearest')")
    said = ended.stderr.splitlines()[-1].removeprefix("muster.mission.errors.MusterError: ")
    assert said == "allocator nearest: the judge rejects its plan: capacity usage 2 m, at most 1 m"
