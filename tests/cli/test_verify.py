"""`muster verify`."""

import json
from pathlib import Path

import pytest
from tests.cli.yard import table_rows

pytestmark = pytest.mark.usefixtures("folder")


def test_verify(plan, muster):
    code, out, err = muster("verify", "yard.yaml", plan)
    assert (code, err) == (0, "")
    assert table_rows(out)[-1] == ["valid", "yes"]


def test_verify_compares_the_bound_that_a_plan_states(muster):
    assert muster("solve", "16T-3R", "--iterations", 500, "--bound", "-o", "p.json")[0] == 0
    stated = json.loads(Path("p.json").read_text(encoding="utf-8"))
    gap = 100 * (1 - stated["lower_bound"] / stated["objective"]["value"])
    out = muster("verify", "16T-3R", "p.json")[1]
    assert f"lower bound       {stated['lower_bound']:.2f} m  (gap {gap:.2f} %; stated in the plan)" in out.splitlines()


def test_verify_in_json(plan, muster):
    code, out, err = muster("verify", "yard.yaml", plan, "--format", "json")
    assert (code, err) == (0, "")
    data = json.loads(out)
    assert (data["valid"], data["violations"]) == (True, [])
    assert {"objective", "total_cost", "max_usage", "makespan_s"} <= set(data)


def test_verify_shows_weight_and_ignored_rules(plan, muster):
    out = muster("verify", "yard.yaml", plan, "--ignore", "lock, skills")[1]
    assert ["weight", "completed", "3"] in table_rows(out)
    assert ["ignored", "skill,", "lock"] in table_rows(out)
    data = json.loads(muster("verify", "yard.yaml", plan, "--ignore", "lock", "--format", "json")[1])
    assert (data["weight_completed"], data["ignored"]) == (3, ["lock"])


@pytest.mark.parametrize(
    ("old", "new", "kind"),
    [
        ('"reason": "skill"', '"reason": "lock"', "reason"),
        ('"reason": "skill"', '"reason": "not-chosen"', "reason"),
        ('"name": "total+max"', '"name": "max"', "objective"),
        ('"history": [', '"history": [[1e9, 300.0], ', "history"),
        ('"tasks": ["look"]', '"tasks": ["look", "lift"]', "skill"),
        ('"tasks": ["look"]', '"tasks": []', "figure"),
        ('"tasks": ["open", "enter"]', '"tasks": ["enter", "open"]', "deadlock"),
        ('"tasks": ["open", "enter"]', '"tasks": ["enter"]', "prerequisite"),
        ('"tasks": ["open", "enter"]', '"tasks": ["open", "enter", "open"]', "repeated-task"),
        ('"robot": "r_1", "tasks"', '"robot": "r_7", "tasks"', "unknown-robot"),
        ('"tasks_completed": 3', '"tasks_completed": 4', "figure"),
        ('"total_cost": ', '"total_cost": 1', "figure"),
    ],
)
def test_verify_rejects_a_tampered_plan(old, new, kind, plan, muster):
    text = plan.read_text(encoding="utf-8")
    assert old in text
    plan.write_text(text.replace(old, new), encoding="utf-8")
    code, out, err = muster("verify", "yard.yaml", plan)
    assert (code, err) == (1, "")
    assert any(row[0] == kind for row in table_rows(out))
    assert "valid             no: " in out
    code, out, err = muster("verify", "yard.yaml", plan, "--format", "json")
    assert (code, err) == (1, "")
    assert json.loads(out)["valid"] is False
    assert kind in [violation["kind"] for violation in json.loads(out)["violations"]]


def test_verify_a_plan_that_cannot_be_read(muster):
    Path("plan.json").write_text('{"schema": "muster-plan/1",\n "routes": [}', encoding="utf-8")
    assert muster("verify", "yard.yaml", "plan.json") == (
        2,
        "",
        "plan.json:2: Expecting value; expected a plan in JSON\n",
    )


def test_verify_rejects_a_bound_above_the_objective(plan, muster):
    text = plan.read_text(encoding="utf-8")
    assert '"lower_bound": null' in text
    plan.write_text(text.replace('"lower_bound": null', '"lower_bound": 1e6'), encoding="utf-8")
    code, out, _ = muster("verify", "yard.yaml", plan)
    assert code == 1
    assert "lower bound       1000000.00 m  (above the objective; stated in the plan)" in out.splitlines()
