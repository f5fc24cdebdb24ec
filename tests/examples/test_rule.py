"""The example package of a rule: installed, every door keeps it, and every plan of small missions says the same."""

import asyncio
import json
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from jsonschema import Draft202012Validator

from muster_control.work import Pool

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "rule"
MISSION = EXAMPLE / "mission.yaml"
TEXT = MISSION.read_text(encoding="utf-8")
KEEPING = ("search", "greedy", "genetic", "auction")
pytestmark = pytest.mark.xdist_group("rule")  # the package is installed once


def written(folder, text):
    path = folder / "mission.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_package_is_about_ninety_lines():
    files = (EXAMPLE / "muster_max_tasks").glob("*.py")
    assert sum(len(path.read_text(encoding="utf-8").splitlines()) for path in files) <= 95


def test_without_the_package_the_mission_is_refused_by_name():
    ended = subprocess.run(
        [sys.executable, "-m", "muster.cli", "check", MISSION], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 2
    assert "robots[0].max_tasks: unknown key" in ended.stderr


def test_wrong_values_are_named_with_their_line(muster, tmp_path):
    expected = {
        "max_tasks: 0": "robots[0].max_tasks: 0; expected a whole number of at least 1",
        "max_tasks: many": 'robots[1].max_tasks: "many"; expected a whole number of at least 1',
        "max_task: 2": "robots[2].max_task: unknown key; expected a known key; did you mean 'max_tasks'?",
    }
    robots = "".join(f"  - {{id: r{k}, position: [0, 0], {key}}}\n" for k, key in enumerate(expected))
    wrong = written(tmp_path, f"schema: muster/1\nrobots:\n{robots}tasks: []\n")
    ended = muster("check", wrong)
    assert ended.returncode == 2
    assert ended.stderr.splitlines()[:3] == [f"{wrong}:{3 + k}: {said}" for k, said in enumerate(expected.values())]


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("allocator", KEEPING)
def test_allocators_keep_it_and_the_judge_agrees(muster, tmp_path, allocator):
    plan = tmp_path / "plan.json"
    ended = muster("solve", MISSION, "-a", allocator, "--iterations", "200", "-q", "-o", plan)
    assert ended.returncode == 0
    routes = {route["robot"]: route["tasks"] for route in json.loads(plan.read_text(encoding="utf-8"))["routes"]}
    assert (len(routes["r_0"]), len(routes["r_1"])) == (2, 1)
    assert muster("verify", MISSION, plan).returncode == 0
    assert muster("verify", MISSION, plan, "--ignore", "max-tasks").returncode == 1  # its reasons are none any more
    without = written(tmp_path, TEXT.replace("max_tasks: 2", "max_tasks: 1"))
    assert "2 in its route, at most 1" in muster("verify", without, plan).stdout


def test_an_allocator_that_cannot_keep_it_refuses_by_name(muster):
    ended = muster("solve", MISSION, "-a", "market", "-q")
    assert ended.returncode == 2
    assert ended.stderr.startswith("allocator: market cannot do robot r_0: max_tasks (load); expected greedy")
    ended = muster("simulate", MISSION, "--negotiate")
    assert ended.returncode == 2
    assert "robots without a centre cannot agree on robot r_0: max_tasks (load)" in ended.stderr


def test_it_is_ignored_by_its_word(muster):
    told = json.loads(
        muster("solve", MISSION, "--iterations", "50", "--ignore", "max-tasks", "--format", "json").stdout
    )
    assert (told["ignored"], told["unassigned"]) == (["max-tasks"], [])


@pytest.mark.long
def test_the_bound_is_that_of_the_best_plan(muster):
    pytest.importorskip("ortools", reason="needs the extra exact")
    limits = ("--iterations", "100", "--time-limit", "60")
    told = json.loads(muster("solve", MISSION, "--bound", "exact", "--format", "json", *limits).stdout)
    assert told["lower_bound"] == pytest.approx(told["objective"]["value"]) == pytest.approx(76)


@pytest.mark.long
def test_explain_names_it_and_what_would_lift_it(muster, tmp_path):
    muster("solve", MISSION, "--iterations", "200", "-q", "-o", tmp_path / "plan.json")
    told = muster("explain", MISSION, tmp_path / "plan.json").stdout
    assert "with it r_0 would have 3 tasks, and has room for 2" in told
    assert "max_tasks 3 instead of 2" in told


@pytest.mark.long
def test_robots_that_take_over_keep_it_with_what_they_have_done(muster, tmp_path):
    """When r_0 fails r_1 has done one task of the two that it may do: one more, and not two."""
    near = TEXT.replace("[40, 0], max_tasks: 1}", "[9, 0], max_tasks: 2}")
    failing = written(tmp_path, near + "events:\n  - {at_s: 1.5, robot_fails: r_0}\n")
    plan = tmp_path / "plan.json"
    routes = [{"robot": "r_0", "tasks": ["gate", "pump"]}, {"robot": "r_1", "tasks": ["barn", "well"]}]
    plan.write_text(json.dumps({"schema": "muster-plan/1", "routes": routes}), encoding="utf-8")
    told = json.loads(muster("simulate", failing, "--plan", plan, "--format", "json").stdout)
    assert (len(told["tasks_done"]), "barn" in told["tasks_done"], told["reallocations"]) == (2, True, 1)
    assert all(lost["reason"].startswith("max-tasks: with it r_1 would have 3 tasks") for lost in told["tasks_lost"])


def test_the_schema_has_the_key(run):
    validator = Draft202012Validator(json.loads(run("-m", "muster.mission.json_schema").stdout))
    data = yaml.safe_load(TEXT)
    assert list(validator.iter_errors(data)) == []
    data["robots"][0]["max_tasks"] = 0
    assert list(validator.iter_errors(data)) != []


def test_missions_with_it_are_built_saved_and_read_in_python(run, tmp_path):
    code = f"""
import muster
from muster_max_tasks import RobotKeys
mission = muster.load({str(MISSION)!r})
robot = mission.robots[0]
assert robot == muster.Robot(id="r_0", position=(0, 0), extra={{"max_tasks": 2}})
assert robot.keys_of(RobotKeys).max_tasks == 2
assert muster.Robot(id="r_0", position=(0, 0)).keys_of(RobotKeys).max_tasks is None
mission.save({str(tmp_path / "copy.yaml")!r})
assert muster.load({str(tmp_path / "copy.yaml")!r}) == mission
for wrong in ({{"max_tasks": 0}}, {{"max_task": 8}}):
    try:
        muster.Robot(id="r", position=(0, 0), extra=wrong)
    except muster.MissionError as error:
        print(error)
"""
    ended = run("-c", code)
    assert ended.stdout.splitlines() == [
        "<mission>: max_tasks: 0; expected a whole number of at least 1",
        "<mission>: max_task: 8; expected a key of a rule: max_tasks",
    ], ended.stderr


def test_a_worker_of_mission_control_keeps_it(installed, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(installed))
    mission = {"text": TEXT, "name": "rounds", "files": {}}

    async def answers():
        pool = Pool(workers=1, memory_mb=512)
        try:
            checked = await pool.run("check", {"mission": mission})
            planned = await pool.run("plan", {"mission": mission, "allocator": "greedy"})
        finally:
            await pool.close()
        return checked, planned

    checked, planned = asyncio.run(answers())
    assert checked["errors"] == []
    assert [robot["max_tasks"] for robot in checked["mission"]["robots"]] == [2, 1]
    assert sorted(len(route["tasks"]) for route in planned["plan"]["routes"]) == [1, 2]


def test_the_form_of_missions_has_a_column_for_it(run):
    code = "from muster_control.pages.editing.form import _COLUMNS; print(_COLUMNS['max_tasks'].kind)"
    assert run("-c", code).stdout == "number\n"


@pytest.mark.long
@pytest.mark.parametrize(("first", "missions", "more_than"), [(0, 3, 0), *((first, 12, 10) for first in (0, 12, 24))])
def test_every_plan_of_small_missions_says_the_same(run, first, missions, more_than):
    told = json.loads(run("-m", "tests.examples.max_tasks_trials", first, missions).stdout)
    assert told["failures"] == {}
    assert told["counts"]["reason max-tasks"] > more_than
    assert told["counts"]["remedies: a plan was found"] > more_than
