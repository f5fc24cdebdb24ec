"""`muster explain`."""

import json

import pytest
from tests.cli.yard import table_rows

pytestmark = pytest.mark.usefixtures("folder")


def test_explain_what_is_left_out(plan, muster):
    code, out, err = muster("explain", "yard.yaml", plan)
    assert (code, err) == (0, "")
    rows = table_rows(out)
    assert rows[0] == ["1", "tasks", "left", "out"]
    assert ["lift", "r_0", "skill", "lacks", "gripper"] in rows
    assert ["lift", "r_1", "skill", "lacks", "gripper"] in rows


def test_explain_what_is_left_out_in_json(plan, muster):
    code, out, err = muster("explain", "yard.yaml", plan, "--format", "json")
    assert (code, err) == (0, "")
    assert json.loads(out)["unassigned"] == json.loads(plan.read_text(encoding="utf-8"))["unassigned"]


def test_explain_when_nothing_is_left_out(muster):
    assert muster("solve", "6T-2R", "--iterations", 5, "-o", "p.json")[0] == 0
    expected = "no task is left out; --task T explains a task that is done\n"
    assert muster("explain", "6T-2R", "p.json") == (0, expected, "")


def test_explain_a_task_that_is_done(plan, muster):
    code, out, err = muster("explain", "yard.yaml", plan, "--task", "enter")
    assert (code, err) == (0, "")
    assert out.splitlines()[0] == "task enter is done by r_1, as number 2 of 2"
    rows = table_rows(out)
    assert any(row[:2] == ["r_0", "no"] and "suitability:" in row for row in rows)
    assert any(row[:3] == ["r_1", "(now)", "yes"] for row in rows)


def test_explain_a_task_that_is_left_out(plan, muster):
    code, out, err = muster("explain", "yard.yaml", plan, "--task", "lift")
    assert (code, err) == (0, "")
    assert out.splitlines()[0] == "task lift is left out"
    assert [row[1] for row in table_rows(out) if row[0] in ("r_0", "r_1")] == ["no", "no"]


def test_explain_a_task_in_json(plan, muster):
    code, out, err = muster("explain", "yard.yaml", plan, "--task", "look", "--format", "json")
    assert (code, err) == (0, "")
    data = json.loads(out)
    assert (data["task"], data["robot"]) == ("look", "r_0")
    assert [item["robot"] for item in data["alternatives"]] == ["r_0", "r_1"]


def test_explain_a_task_that_does_not_exist(plan, muster):
    code, out, err = muster("explain", "yard.yaml", plan, "--task", "lok")
    assert (code, out) == (2, "")
    assert err == "--task: lok; expected the id of a task of this mission; did you mean 'look'?\n"


def test_explain_a_plan_of_another_mission(plan, muster):
    code, out, err = muster("explain", "6T-2R", plan)
    assert (code, out) == (2, "")
    first = "plan.json: unknown-task: look, no task of the mission; expected a plan of this mission"
    assert err.splitlines()[0] == f"{first} (`muster verify` says more)"
