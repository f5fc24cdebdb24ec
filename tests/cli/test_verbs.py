"""Each verb as a person uses it."""

import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from muster.allocation.registry import ALLOCATORS
from muster.cli.main import run
from muster.library import mission_names, mission_path
from muster.mission.model import IGNORABLE, OBJECTIVES
from muster.mission.plan import read_plan

MUSTER = Path(sysconfig.get_path("scripts")) / "muster"
VERBS = ("missions", "init", "check", "solve", "verify", "explain")

MISSION = """\
schema: muster/1
name: yard
suitability:
  beta: {D: 0.9, E: 0.5}
  tau: {E: 0.8}
robots:
  - {id: r_0, type: beta, position: [0, 0], work_capacity: 30, skills: [camera]}
  - {id: r_1, type: tau, position: [9, 0], work_capacity: 12}
tasks:
  - {id: look, type: D, position: [4, 0], requires: [camera]}
  - {id: open, type: E, position: [8, 2]}
  - {id: enter, type: E, position: [7, 4], prerequisites: [open]}
  - {id: lift, type: D, position: [1, 1], requires: [gripper]}
"""
TASKS = 'index,x,y,type,actuation_cost,prerequisites\n1,4,5,D,0,[]\n2,6,1,E,12,[1]\n3,7,2,D,0,"[1,2]"\n'
ROBOTS = "id,type,x,y,work_capacity\nr_0,beta,0,0,50\nr_1,tau,2,0,inf\n"
TABLE = "robot_type,D,E\nbeta,0.9,0.7\ntau,0.5,0.9\n"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Every test runs in a folder of its own with a mission in it."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("yard.yaml", MISSION), ("t.csv", TASKS), ("r.csv", ROBOTS), ("s.csv", TABLE)):
        Path(name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.fixture
def muster(capsys):
    """Runs the command; gives its exit code, standard output and standard error."""

    def call(*arguments):
        code = run([str(argument) for argument in arguments])
        return (code, *capsys.readouterr())

    return call


@pytest.fixture
def plan(muster):
    """A plan of the yard: `lift` is left out."""
    assert muster("solve", "yard.yaml", "--iterations", 20, "-o", "plan.json")[0] == 0
    return Path("plan.json")


def table_rows(out):
    """The rows of a printed table as lists of words."""
    return [line.split() for line in out.splitlines() if line.strip()]


def comparable(path):
    """A plan's text without what is time."""
    data = json.loads(Path(path).read_text(encoding="utf-8"))
    data["elapsed_s"] = None
    data["history"] = [value for _, value in data["history"]]
    return json.dumps(data)


# --- help ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("flag", ["--help", "-h"])
def test_help_of_a_verb(verb, flag, muster):
    code, out, err = muster(verb, flag)
    assert (code, err) == (0, "")
    assert out.startswith(f"Usage: muster {verb} [OPTIONS]")
    assert all(len(line) <= 80 for line in out.splitlines())


def test_help(muster):
    code, out, err = muster("--help")
    assert (code, err) == (0, "")
    first_words = [row[0] for row in table_rows(out)]
    assert [verb for verb in first_words if verb in VERBS] == list(VERBS)


def test_no_verb_shows_help(muster):
    code, out, err = muster()
    assert (code, out) == (2, "")
    assert err.startswith("Usage: muster [OPTIONS] COMMAND")


def test_version(muster):
    code, out, err = muster("--version")
    assert (code, err) == (0, "")
    assert out.split()[0] == "muster"


def test_unknown_verb(muster):
    code, out, err = muster("sovle", "yard.yaml")
    assert (code, out) == (2, "")
    assert err.splitlines()[-1] == "Error: no verb 'sovle'; did you mean 'solve'?"


@pytest.mark.parametrize("verb", VERBS)
def test_unknown_option(verb, muster):
    code, out, err = muster(verb, "--colour")
    assert (code, out) == (2, "")
    assert "No such option" in err.splitlines()[-1]


# --- missions and init -----------------------------------------------------------------------------------------------


def test_missions(muster):
    code, out, err = muster("missions")
    assert (code, err) == (0, "")
    listed = [row[0] for row in table_rows(out)]
    assert [name for name in listed if name in mission_names()] == mission_names()


def test_missions_in_json(muster):
    code, out, err = muster("missions", "--format", "json")
    data = json.loads(out)
    assert (code, err) == (0, "")
    assert [item["name"] for item in data] == mission_names()
    assert all(set(item) == {"name", "robots", "tasks", "description"} for item in data)
    assert all(item["description"] for item in data)


def test_init(muster):
    assert muster("init")[:2] == (0, "mission.yaml\n")
    assert muster("check", "mission.yaml") == (0, "mission: 2 robots, 4 tasks; no errors\n", "")
    assert muster("solve", "mission.yaml", "--iterations", 20, "--require-complete")[0] == 0


@pytest.mark.parametrize("name", ["rescue", "rescue.yaml", "rescue.yml"])
def test_init_with_a_name(name, muster):
    code, out, err = muster("init", name)
    assert (code, out) == (0, "rescue.yaml\n")
    assert err == "next: muster check rescue.yaml; muster solve rescue.yaml\n"
    assert muster("check", "rescue.yaml")[1].startswith("rescue: ")


@pytest.mark.parametrize(
    "name", ["hall: north", "true", "null", "1.5", "7", "007", "@home", "x #1", "a 'b'", "été", "- a"]
)
def test_init_with_a_name_that_yaml_could_take_for_something_else(name, muster):
    assert muster("init", "--", name)[:2] == (0, f"{name}.yaml\n")
    assert muster("check", "--", f"{name}.yaml") == (0, f"{name}: 2 robots, 4 tasks; no errors\n", "")


@pytest.mark.parametrize("more", [[], ["--from", "31T-6R50"]])
def test_init_leaves_an_existing_file_alone(more, muster):
    Path("mission.yaml").write_text("mine", encoding="utf-8")
    assert muster("init", *more) == (2, "", "mission.yaml: exists; expected the name of a new file\n")
    assert Path("mission.yaml").read_text(encoding="utf-8") == "mine"


def test_init_from_a_shipped_mission(muster):
    assert muster("init", "copy", "--from", "31T-6R50")[:2] == (0, "copy.yaml\n")
    assert Path("copy.yaml").read_bytes() == mission_path("31T-6R50").read_bytes()
    assert muster("init", "--from", "6T-2R", "-o", "other.yaml")[:2] == (0, "other.yaml\n")
    assert muster("check", "other.yaml")[0] == 0


def test_init_from_what_cannot_be_copied(muster):
    assert muster("init", "--from", "31T-6R5") == (
        2,
        "",
        "--from: no shipped mission 31T-6R5; expected one of `muster missions`; did you mean '31T-6R50'?\n",
    )
    code, out, err = muster("init", "--from", "eil51")
    assert (code, out) == (2, "")
    assert err == "--from: eil51 is no YAML; use it as it is: muster solve eil51 --salesmen 3\n"
    assert not Path("mission.yaml").exists()


def test_init_in_a_folder_that_does_not_exist(muster):
    code, out, err = muster("init", "none/mission")
    assert (code, out) == (2, "")
    assert err == "none/mission.yaml: No such file or directory; expected a file that can be read or written\n"


# --- the MISSION -----------------------------------------------------------------------------------------------------


def test_task_list_csv(muster):
    flags = ["t.csv", "--robots", "r.csv", "--suitability", "s.csv"]
    assert muster("check", *flags) == (0, "t: 2 robots, 3 tasks; no errors\n", "")
    code, out, err = muster("solve", *flags, "--iterations", 10, "-o", "p.json", "--require-complete")
    assert (code, err) == (0, "")
    assert out.startswith("t: greedy+genetic, seed 0")
    assert {task for route in read_plan("p.json").routes for task in route.tasks} == {"1", "2", "3"}
    assert muster("verify", *flags, "p.json")[0] == 0
    assert muster("explain", *flags, "p.json", "--task", 2)[0] == 0


def test_task_list_csv_without_suitability(muster):
    assert muster("check", "t.csv", "--robots", "r.csv")[0] == 0


def test_tsplib(muster):
    flags = ["eil51", "--salesmen", 3, "--depot", 7]
    assert muster("check", *flags) == (0, "eil51-3: 3 robots, 50 tasks; no errors\n", "")
    code, _, err = muster("solve", *flags, "--iterations", 2, "-o", "p.json")
    assert (code, err) == (0, "")
    tours = read_plan("p.json").routes
    assert [tour.robot for tour in tours] == ["r_0", "r_1", "r_2"]
    assert sorted((task for tour in tours for task in tour.tasks), key=int) == [str(k) for k in range(1, 52) if k != 7]
    assert muster("verify", *flags, "p.json")[0] == 0
    assert muster("verify", "eil51", "--salesmen", 3, "p.json")[0] == 1  # node 1 is no task there


@pytest.mark.parametrize("verb", ["check", "solve"])
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["t.csv"], "t.csv: --robots missing; expected with a .csv file"),
        (["eil51"], "eil51: --salesmen missing; expected with a .tsp file"),
        (
            ["yard.yaml", "--robots", "r.csv"],
            "yard.yaml: --robots given; expected no --robots with this kind of mission",
        ),
        (
            ["eil51", "--salesmen", "2", "--suitability", "s.csv"],
            "eil51: --suitability given; expected no --suitability",
        ),
        (["yard.yaml", "--depot", "2"], "--depot given; expected it together with --salesmen"),
        (["none.yaml"], "none.yaml: No such file or directory; expected a file to read"),
        (
            ["31T-6R5"],
            "31T-6R5: no such file or mission; expected a file, or the name of a shipped mission; did you mean",
        ),
        (["."], ".: Is a directory; expected a file to read"),
    ],
)
def test_flags_that_do_not_fit(verb, arguments, message, muster):
    code, out, err = muster(verb, *arguments)
    assert (code, out) == (2, "")
    assert err.startswith(message)
    assert len(err.splitlines()) == 1


def test_suffixes_in_capitals(muster):
    Path("t.csv").rename("T.CSV")
    assert muster("check", "T.CSV", "--robots", "r.csv")[0] == 0
    Path("eil51.TSP").write_bytes(mission_path("eil51").read_bytes())
    assert muster("check", "eil51.TSP", "--salesmen", 2)[0] == 0


def test_a_file_comes_before_a_shipped_mission_of_that_name(muster):
    Path("6T-2R").write_text(MISSION, encoding="utf-8")
    assert muster("check", "6T-2R")[1].startswith("yard: ")


# --- solve -----------------------------------------------------------------------------------------------------------


def test_solve_prints_a_table(muster):
    code, out, err = muster("solve", "yard.yaml", "--iterations", 20, "--seed", 3)
    assert (code, err) == (0, "")
    rows = table_rows(out)
    assert rows[0] == ["yard:", "greedy+genetic,", "seed", "3"]
    assert ["r_0", "look", "4.00", "30.00"] in rows
    assert ["tasks", "completed", "3", "of", "4"] in rows
    assert ["left", "out", "lift", "(`muster", "explain`", "says", "why)"] in rows


@pytest.mark.parametrize("allocator", ALLOCATORS)
def test_the_same_seed_gives_the_same_plan(allocator, muster):
    for name in ("one.json", "two.json"):
        flags = ["-a", allocator, "--iterations", 15, "--seed", 7, "-o", name]
        assert muster("solve", "31T-6R50", *flags)[0] == 0
    assert comparable("one.json") == comparable("two.json")
    one, two = (Path(name).read_text(encoding="utf-8").splitlines() for name in ("one.json", "two.json"))
    timed = {k for k, line in enumerate(one) if line.startswith((' "elapsed_s"', ' "history"', "  ["))}
    assert [line for k, line in enumerate(one) if k not in timed] == [
        line for k, line in enumerate(two) if k not in timed
    ]
    assert json.loads("\n".join(one))["seed"] == 7


def test_json_is_what_is_written(muster):
    code, out, err = muster("solve", "yard.yaml", "--iterations", 5, "--format", "json", "-o", "p.json")
    assert (code, err) == (0, "")
    assert out == Path("p.json").read_text(encoding="utf-8")
    assert json.loads(out)["schema"] == "muster-plan/1"
    assert [route["robot"] for route in json.loads(out)["routes"]] == ["r_0", "r_1"]


def test_pictures(muster):
    code, _, err = muster("solve", "yard.yaml", "--iterations", 5, "--plot", "p.png", "--gantt", "g.svg")
    assert (code, err) == (0, "")
    assert Path("p.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    assert "</svg>" in Path("g.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize("flag", ["--plot", "--gantt"])
@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("p.bmp", "p.bmp: suffix '.bmp'; expected one of .png, .svg, .pdf\n"),
        ("p", "p: no suffix; expected one of .png, .svg, .pdf\n"),
        ("none/p.png", "none/p.png: cannot be written; expected a file in a folder that exists\n"),
    ],
)
def test_pictures_that_cannot_be_written(flag, name, message, muster):
    assert muster("solve", "yard.yaml", "--iterations", 5, flag, name) == (2, "", message)


@pytest.mark.parametrize("name", ["none/plan.json", "."])
def test_plan_that_cannot_be_written(name, muster):
    code, out, err = muster("solve", "yard.yaml", "--time-limit", 60, "-o", name)
    assert (code, out) == (2, "")
    assert err == f"{name}: cannot be written; expected a file in a folder that exists\n"


LIMITED = (
    "import os, resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (9, 9)); os.execv(sys.argv[1], sys.argv[1:])"
)


def test_a_disk_that_is_full():
    """Of a file that fails in the middle the system names no file; the user must still get a line."""
    command = [sys.executable, "-c", LIMITED, MUSTER, "solve", "yard.yaml", "--iterations", "5", "-o", "plan.json"]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
    message = "plan.json: File too large; expected a file that can be read or written\n"
    assert (done.returncode, done.stderr) == (2, message)


def test_ignored_rules_are_in_the_plan_and_obeyed(muster):
    flags = ["--iterations", 20, "-o", "p.json", "--require-complete"]
    assert muster("solve", "yard.yaml", *flags)[0] == 3
    code, out, _ = muster("solve", "yard.yaml", *flags, "--ignore", "skills, prerequisites")
    assert code == 0
    assert table_rows(out)[-1] == ["ignored", "prerequisites,", "skills"]
    assert read_plan("p.json").ignored == ("prerequisites", "skills")
    assert muster("verify", "yard.yaml", "p.json")[0] == 0
    text = Path("p.json").read_text(encoding="utf-8")
    assert '"ignored": ["prerequisites", "skills"]' in text
    Path("p.json").write_text(text.replace('["prerequisites", "skills"]', "[]"), encoding="utf-8")
    assert muster("verify", "yard.yaml", "p.json")[0] == 1


@pytest.mark.parametrize("verb", ["check", "solve"])
def test_unknown_rule_to_ignore(verb, muster):
    code, out, err = muster(verb, "yard.yaml", "--ignore", "capacity,skill")
    assert (code, out) == (2, "")
    assert f"'skill' is not one of {', '.join(IGNORABLE)}; did you mean 'skills'?" in err


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_objective(objective, muster):
    assert muster("solve", "11T-2R", "--iterations", 5, "--objective", objective, "-o", "p.json")[0] == 0
    plan = read_plan("p.json")
    assert plan.objective == objective
    code, out, _ = muster("verify", "11T-2R", "p.json", "--format", "json")
    assert code == 0
    assert json.loads(out)["objective_name"] == objective
    assert json.loads(out)["objective"] == pytest.approx(plan.objective_value)


def test_unknown_objective(muster):
    code, out, err = muster("solve", "yard.yaml", "--objective", "best")
    assert (code, out) == (2, "")
    assert "'best' is not one of 'total+max', 'total', 'max', 'average', 'makespan'" in err


def test_allocators(muster):
    code, out, err = muster("solve", "--list-allocators")
    assert (code, err) == (0, "")
    first_words = [row[0] for row in table_rows(out)]
    assert [name for name in first_words if name in ALLOCATORS] == list(ALLOCATORS)


def test_unknown_allocator(muster):
    code, out, err = muster("solve", "yard.yaml", "-a", "gredy")
    assert (code, out) == (2, "")
    assert err == f"allocator: gredy; expected {', '.join(ALLOCATORS)}; did you mean 'greedy'?\n"


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("population_size", "--set: population_size; expected NAME=NUMBER\n"),
        ("population_size=", "--set: population_size=; expected NAME=NUMBER\n"),
        ("population_size=many", "--set: population_size=many; expected NAME=NUMBER\n"),
        ("=3", "--set: =3; expected NAME=NUMBER\n"),
        ("population=3", "greedy+genetic has no parameter population; did you mean 'population_size'?\n"),
        ("population_size=0", "population_size: 0; expected a whole number of at least 1\n"),
        ("population_size=2.5", "population_size: 2.5; expected a whole number\n"),
        ("population_size=1e3", "population_size: 1000.0; expected a whole number\n"),
        ("population_size=99999999999999999999", "population_size: 99999999999999999999; expected at most 1000000\n"),
        ("start_mutants=-1", "start_mutants: -1; expected a whole number of at least 0\n"),
        ("mutation_probability=1.1", "mutation_probability: 1.1; expected a number from 0 to 1\n"),
        ("mutation_probability=nan", "mutation_probability: nan; expected a number from 0 to 1\n"),
    ],
)
def test_bad_setting(setting, message, muster):
    assert muster("solve", "yard.yaml", "--iterations", 5, "--set", setting) == (2, "", message)


def test_settings(muster):
    flags = ["--iterations", 5, "--set", "population_size=3", "--set", " mutation_probability = .5"]
    assert muster("solve", "yard.yaml", *flags)[0] == 0


@pytest.mark.parametrize("flag", [["--iterations", "-1"], ["--time-limit", "-1"], ["--seed", "-1"], ["--seed", "x"]])
def test_bad_number(flag, muster):
    code, out, err = muster("solve", "yard.yaml", *flag)
    assert (code, out) == (2, "")
    assert f"Invalid value for '{flag[0]}'" in err


def test_a_time_limit_that_is_no_number(muster):
    assert muster("solve", "yard.yaml", "--time-limit", "nan") == (
        2,
        "",
        "time_limit: nan; expected seconds, at least 0\n",
    )


def test_start(muster):
    assert muster("solve", "31T-6R50", "--iterations", 200, "-o", "first.json")[0] == 0
    first = read_plan("first.json")
    for allocator in ("greedy", "greedy+genetic", "genetic", "hill-climbing"):
        flags = ["--start", "first.json", "--iterations", 0, "-a", allocator, "-o", "second.json"]
        assert muster("solve", "31T-6R50", *flags)[0] == 0
        second = read_plan("second.json")
        assert (second.tasks_completed, -second.objective_value) >= (
            first.tasks_completed,
            -first.objective_value - 1e-9,
        )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "start.json: No such file or directory; expected a file to read\n"),
        ('{"routes": []}', "start.json: schema: missing; expected muster-plan/1\n"),
        (
            '{"schema": "muster-plan/1", "routes": [{"robot": "r_9", "tasks": []}]}',
            "start: robot r_9 is not in the mission\n",
        ),
        (
            '{"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["x"]}]}',
            "start: task x is not in the mission\n",
        ),
        (
            '{"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["lift"]}]}',
            "start: r_0 may not do lift\n",
        ),
        (
            '{"schema": "muster-plan/1", "routes": [{"robot": "r_1", "tasks": ["enter"]}]}',
            "start: the plan is not admissible\n",
        ),
    ],
)
def test_start_that_does_not_fit(text, message, muster):
    if text is not None:
        Path("start.json").write_text(text, encoding="utf-8")
    assert muster("solve", "yard.yaml", "--iterations", 5, "--start", "start.json") == (2, "", message)


@pytest.mark.parametrize("routes", [[["look", "look"]], [["look"], ["look"]]])
def test_start_that_does_a_task_twice(routes, muster):
    data = [{"robot": f"r_{k}", "tasks": tasks} for k, tasks in enumerate(routes)]
    Path("start.json").write_text(json.dumps({"schema": "muster-plan/1", "routes": data}), encoding="utf-8")
    code, out, err = muster("solve", "yard.yaml", "--iterations", 5, "--start", "start.json")
    assert (code, out) == (2, "")
    assert err.startswith("start: ")


def test_a_mission_without_tasks(muster):
    Path("idle.yaml").write_text("{schema: muster/1, robots: [{id: r_0, position: [0, 0]}], tasks: []}", "utf-8")
    for allocator in ALLOCATORS:
        flags = ["-a", allocator, "--iterations", 3, "-o", "p.json", "--plot", "p.png", "--gantt", "g.png"]
        assert muster("solve", "idle.yaml", *flags, "--require-complete")[0] == 0
        assert muster("verify", "idle.yaml", "p.json")[0] == 0
        assert muster("explain", "idle.yaml", "p.json")[0] == 0


# --- verify ----------------------------------------------------------------------------------------------------------


def test_verify(plan, muster):
    code, out, err = muster("verify", "yard.yaml", plan)
    assert (code, err) == (0, "")
    assert table_rows(out)[-1] == ["valid", "yes"]


def test_verify_in_json(plan, muster):
    code, out, err = muster("verify", "yard.yaml", plan, "--format", "json")
    assert (code, err) == (0, "")
    data = json.loads(out)
    assert (data["valid"], data["violations"]) == (True, [])
    assert {"objective", "total_cost", "max_usage", "makespan_s"} <= set(data)


@pytest.mark.parametrize(
    ("old", "new", "kind"),
    [
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


# --- explain ---------------------------------------------------------------------------------------------------------


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


# --- standard output is pure -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "arguments",
    [
        ["missions"],
        ["check", "yard.yaml"],
        ["check", "yard.yaml", "--ignore", "skills"],
        ["solve", "yard.yaml", "--iterations", "5"],
        ["solve", "yard.yaml", "--iterations", "5", "-v", "-o", "p.json", "--plot", "p.svg"],
        ["solve", "yard.yaml", "--time-limit", "0.05", "-q"],
        ["verify", "yard.yaml", "plan.json"],
        ["explain", "yard.yaml", "plan.json"],
        ["explain", "yard.yaml", "plan.json", "--task", "open"],
    ],
)
def test_json_on_standard_output_is_pure(arguments, plan):
    done = subprocess.run([MUSTER, *arguments, "--format", "json"], capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0
    json.loads(done.stdout)
    assert done.stderr == "" or "-v" in arguments


def test_a_reader_that_stops_reading():
    """`muster missions | head -1`: no traceback."""
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run([MUSTER, "missions"], stdout=write, stderr=subprocess.PIPE, encoding="utf-8", check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


# --- progress and Ctrl-C ---------------------------------------------------------------------------------------------


class OnTerminal:
    """The command with its standard error on a terminal."""

    def __init__(self, *arguments):
        self._terminal, side = pty.openpty()
        environment = os.environ | {"TERM": "xterm", "COLUMNS": "100"}
        command = [MUSTER, *map(str, arguments)]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=side, env=environment)
        os.close(side)
        self.shown = b""

    def wait_for(self, word, most_s=60):
        """Read until the word is shown."""
        while word not in self.shown:
            assert self._read(most_s), f"{word!r} was not shown: {self.shown!r}"

    def _read(self, most_s):
        if not select.select([self._terminal], [], [], most_s)[0]:
            return False
        try:
            more = os.read(self._terminal, 65536)
        except OSError:  # Linux says so where the other side is closed
            more = b""
        self.shown += more
        return bool(more)

    def finish(self):
        """Exit code, standard output, and all that the terminal got."""
        while self._read(60):
            pass
        out = self.process.stdout.read()
        self.process.stdout.close()
        code = self.process.wait(60)
        os.close(self._terminal)
        return code, out.decode(), self.shown.decode()


def test_progress_is_shown_on_a_terminal():
    run_ = OnTerminal("solve", "eil51-5", "--time-limit", 1.5)
    code, out, shown = run_.finish()
    assert code == 0
    assert "planning" in shown
    assert "best" in shown
    assert "planning" not in out


def test_progress_is_not_shown_when_asked_for_quiet():
    code, _, shown = OnTerminal("solve", "eil51-5", "--time-limit", 1, "-q").finish()
    assert (code, shown) == (0, "")


def test_progress_is_not_shown_where_there_is_no_terminal():
    done = subprocess.run(
        [MUSTER, "solve", "eil51-5", "--time-limit", "1"], capture_output=True, encoding="utf-8", check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "planning" not in done.stdout


@pytest.mark.parametrize("form", ["table", "json"])
def test_ctrl_c_keeps_the_best_plan_so_far(form, muster):
    run_ = OnTerminal("solve", "eil51-5", "--time-limit", 600, "-o", "plan.json", "--format", form)
    run_.wait_for(b"planning")
    run_.process.send_signal(signal.SIGINT)
    code, out, shown = run_.finish()
    assert code == 130
    assert "interrupted: this is the best plan so far" in shown
    assert "Traceback" not in shown
    assert (out == Path("plan.json").read_text(encoding="utf-8")) == (form == "json")
    assert muster("verify", "eil51-5", "plan.json")[0] == 0
    assert read_plan("plan.json").tasks_completed == 50


def test_outputs_never_replace_inputs_or_each_other(muster):
    text = Path("yard.yaml").read_text()
    code, out, err = muster("solve", "yard.yaml", "-a", "greedy", "-o", "./yard.yaml")
    assert (code, out) == (2, "")
    assert err.startswith("yard.yaml: given twice")
    assert Path("yard.yaml").read_text() == text
    code, _, err = muster("solve", "yard.yaml", "-a", "greedy", "--plot", "x.png", "--gantt", "x.png")
    assert code == 2
    assert err.startswith("x.png: given twice")


def test_names_are_text_and_not_markup(muster):
    text = Path("yard.yaml").read_text()
    Path("odd.yaml").write_text(
        re.sub(r"name: .*", 'name: "x [/x] [m]"', text) if "name:" in text else f'name: "x [/x] [m]"\n{text}'
    )
    code, out, _ = muster("solve", "odd.yaml", "-a", "greedy")
    assert code == 0
    assert "x [/x] [m]: greedy" in out
    assert "usage [m]" in out


def test_a_time_limit_does_not_cut_greedy_short(muster):
    code, out, _ = muster("solve", "eil51-5", "--time-limit", "0", "--format", "json")
    assert code == 0
    assert json.loads(out)["tasks_completed"] == 50
