"""`muster explain`."""

import json

import pytest
from tests.cli.yard import table_rows

pytestmark = pytest.mark.usefixtures("folder")


def test_explain_what_is_left_out(plan, muster):
    code, out, err = muster("explain", "yard.yaml", plan)
    assert (code, err) == (0, "")
    rows = table_rows(out)
    assert rows[0] == ["1", "task", "left", "out"]
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


def test_explain_without_rules_that_the_caller_ignores(plan, muster):
    code, out, _ = muster("explain", "yard.yaml", plan, "--ignore", "skill")
    assert code == 0
    assert out.startswith("rules ignored: skill\n")
    assert "lacks gripper" not in out
    data = json.loads(muster("explain", "yard.yaml", plan, "--ignore", "skill", "--format", "json")[1])
    assert data["ignored"] == ["skill"]
    text = plan.read_text(encoding="utf-8").replace('"ignored": []', '"ignored": ["skill"]')
    plan.write_text(text, encoding="utf-8")
    code, out, err = muster("explain", "yard.yaml", plan)
    assert "lacks gripper" in out, "a plan's own word has no effect"
    assert "warning: " in err


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
    assert [row[1] for row in table_rows(out) if row[0] in ("r_0", "r_1")] == ["no", "no", "skill", "skill"]


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


SAID = ("mission: the plan is of yard; expected 6T-2R, or no name", "unknown-task: look, no task of the mission")


def test_explain_a_plan_of_another_mission(plan, muster):
    code, out, err = muster("explain", "6T-2R", plan)
    assert (code, out) == (2, "")
    named, unknown = (
        f"plan.json: {said}; expected a plan of this mission (`muster verify` says more)" for said in SAID
    )
    assert err.splitlines()[:2] == [named, unknown]


# --- what would have to change ---------------------------------------------------------------------------------------

SHED = """\
schema: muster/1
name: shed
suitability:
  beta: {D: 0.9, E: 0.5}
  tau: {E: 0.8}
robots:
  - {id: r_0, type: beta, position: [0, 0], work_capacity: 20, skills: [camera]}
  - {id: r_1, type: tau, position: [20, 0], work_capacity: 20}
tasks:
  - {id: a, type: D, position: [5, 0]}
  - {id: b, type: E, position: [15, 0]}
  - {id: c, type: D, position: [0, 15], requires: [camera], only_robots: [r_0]}
  - {id: lift, type: D, position: [1, 0], requires: [gripper]}
  - {id: hang, type: D, position: [2, 0], prerequisites: [lift]}
  - {id: far, type: E, position: [20, 30]}
"""


@pytest.fixture
def shed(folder):
    """A plan from elsewhere, of a mission in `shed.yaml`."""
    (folder / "shed.yaml").write_text(SHED, encoding="utf-8")
    routes = [{"robot": "r_0", "tasks": ["a"]}, {"robot": "r_1", "tasks": ["b"]}]
    (folder / "shed.json").write_text(json.dumps({"schema": "muster-plan/1", "routes": routes}), encoding="utf-8")
    return "shed.yaml", "shed.json"


def needs(out):
    """The lines of the table of what each robot would need, and what follows."""
    lines = [" ".join(line.split()) for line in out.splitlines()]
    at = next(k for k, line in enumerate(lines) if line.startswith("to do "))
    return [line for line in lines[at + 4 :] if line]


def test_the_smallest_change_for_each_task_left_out(shed, muster):
    code, out, err = muster("explain", *shed)
    assert (code, err) == (0, "")
    lines = [" ".join(line.split()) for line in out.splitlines()]
    at = lines.index("smallest changes, the rest as it is")
    assert [line for line in lines[at + 4 :] if line] == [
        "c r_0 capacity 20.82 m, not 20",
        "lift r_0 skill gripper",
        "hang r_0 first lift, left out as well",
        "far r_1 capacity 35.42 m, not 20",
    ]


def test_the_smallest_changes_in_json(shed, muster):
    data = json.loads(muster("explain", *shed, "--format", "json")[1])
    assert list(data) == ["ignored", "shortfalls", "unassigned", "smallest", "cut_short"]
    kinds = {item["task"]: (item["remedy"]["robot"], item["remedy"]["kinds"]) for item in data["smallest"]}
    assert kinds == {
        "c": ("r_0", ["capacity"]),
        "lift": ("r_0", ["skill"]),
        "hang": ("r_0", ["prerequisite"]),
        "far": ("r_1", ["capacity"]),
    }


def test_a_change_of_each_kind(shed, muster):
    assert needs(muster("explain", *shed, "--task", "c")[1]) == [
        "r_0 capacity: needs at least 20.81 m (proven), 20.82 m is enough (a plan was found); it has 20",
        "capacity with the rest of the plan as it is: 20.82 m",
        "r_1 skill camera",
        "suitability 0.65: tau scores 0 for D",
        "a place in the lock: only r_0 may do it",
        "capacity: needs at least 26.21 m (proven), 26.22 m is enough (a plan was found); it has 20",
        "capacity with the rest of the plan as it is: 26.22 m",
        "smallest change: r_0: capacity 20.82 m, not 20",
    ]


def test_a_prerequisite_that_can_never_be_done(shed, muster):
    assert needs(muster("explain", *shed, "--task", "hang")[1]) == [
        "r_0 first lift, left out as well",
        "but lift can never be done: --task lift says more",
        "r_1 suitability 0.65: tau scores 0 for D",
        "first lift, left out as well",
        "but lift can never be done: --task lift says more",
    ]


def test_a_task_that_another_robot_does(shed, muster):
    assert needs(muster("explain", *shed, "--task", "a")[1]) == [
        "r_0 (now) nothing: it fits into the plan as it is",
        "r_1 suitability 0.65: tau scores 0 for D",
        "nothing else: it fits into the plan as it is",
    ]


def test_tasks_that_can_be_moved(shed, folder, muster):
    """Where r_1 may do a as well, r_0 has room for c."""
    text = SHED.replace("tau: {E: 0.8}", "tau: {D: 0.7, E: 0.8}")
    (folder / "shed.yaml").write_text(text, encoding="utf-8")
    lines = needs(muster("explain", *shed, "--task", "c")[1])
    assert lines[0] == "r_0 nothing: a plan was found in which other tasks are moved"
    assert lines[-1] == "no change is needed: r_0 can do it beside all else"


def test_the_reserve_is_mentioned(shed, folder, muster):
    (folder / "shed.yaml").write_text(SHED + "rules: {capacity_reserve: 0.2}\n", encoding="utf-8")
    lines = needs(muster("explain", *shed, "--task", "far")[1])
    assert lines[-1] == "capacities are work_capacity, the reserve of 0.2 included"
    assert "44.27 m is enough" in lines[-4]


def test_lines_are_not_too_long(shed, muster):
    for task in ("a", "c", "lift", "hang", "far"):
        assert max(map(len, muster("explain", *shed, "--task", task)[1].splitlines())) <= 100


def test_remedies_in_json(shed, muster):
    data = json.loads(muster("explain", *shed, "--task", "far", "--format", "json")[1])
    first, second = data["remedies"]
    assert list(data) == ["task", "robot", "team", "ignored", "objective", "alternatives", "remedies", "cut_short"]
    assert (first["suitability"]["score"], first["suitability"]["needed"]) == (0.5, 0.65)
    assert second["capacity"]["now"] == 20
    assert second["kinds"] == ["capacity"]
    assert second["enough"] is True


def test_a_plan_from_elsewhere_that_lacks_a_way(muster, folder):
    (folder / "m.yaml").write_text(
        "schema: muster/1\nrules: {travel: matrix}\ntravel: {x: x.csv}\n"
        "robots: [{id: r_0, type: x, position: [0, 0]}, {id: r_1, type: x, position: [0, 0]}]\n"
        "tasks: [{id: a, position: [1, 0]}, {id: b, position: [2, 0]}]\n",
        encoding="utf-8",
    )
    (folder / "x.csv").write_text("to,r_0,r_1,a,b\nr_0,0,0,inf,2\nr_1,0,0,inf,2\na,0,0,0,0\nb,0,0,0,0\n")
    routes = '{"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["a"]}]}'
    (folder / "p.json").write_text(routes, encoding="utf-8")
    code, out, err = muster("explain", "m.yaml", "p.json", "--task", "b")
    assert (code, err) == (0, "")
    assert "best as number 1; another route has no way" in out
    out = muster("explain", "m.yaml", "p.json", "--task", "b", "--format", "json")[1]
    assert "Infinity" not in out
    assert json.loads(out)["alternatives"][1] == {"robot": "r_1", "number": 1, "objective": None, "reason": None}
