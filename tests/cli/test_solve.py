"""`muster solve`."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from tests.cli.yard import MUSTER, comparable, table_rows

from muster.allocation.registry import ALLOCATORS
from muster.mission.ignorable_rules import IGNORABLE
from muster.mission.model import OBJECTIVES
from muster.mission.reading.plan_reader import read_plan

pytestmark = pytest.mark.usefixtures("folder")


def test_solve_prints_a_table(muster):
    code, out, err = muster("solve", "yard.yaml", "--iterations", 20, "--seed", 3)
    assert (code, err) == (0, "")
    rows = table_rows(out)
    assert rows[0] == ["yard:", "search,", "seed", "3"]
    assert ["r_0", "look", "4.00", "30.00"] in rows
    assert ["tasks", "completed", "3", "of", "4"] in rows
    assert ["left", "out", "lift", "(`muster", "explain`", "says", "why)"] in rows


@pytest.mark.long(keep=7)
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


@pytest.mark.long
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
    assert table_rows(out)[-1] == ["ignored", "prerequisite,", "skill"]
    assert read_plan("p.json").ignored == ("prerequisite", "skill")
    code, out, err = muster("verify", "yard.yaml", "p.json", "--ignore", "skill,prerequisite")
    assert (code, err) == (0, "")
    assert ["ignored", "prerequisite,", "skill"] in table_rows(out)
    text = Path("p.json").read_text(encoding="utf-8")
    assert '"ignored": ["prerequisite", "skill"]' in text
    code, _, err = muster("verify", "yard.yaml", "p.json")
    assert code == 1, "a plan does not excuse itself"
    assert "p.json: ignored: prerequisite, skill; expected --ignore prerequisite,skill, or these rules hold" in err
    Path("p.json").write_text(text.replace('["prerequisite", "skill"]', "[]"), encoding="utf-8")
    assert muster("verify", "yard.yaml", "p.json")[0] == 1


@pytest.mark.parametrize("verb", ["check", "solve"])
def test_unknown_rule_to_ignore(verb, muster):
    code, out, err = muster(verb, "yard.yaml", "--ignore", "capacity,skils")
    assert (code, out) == (2, "")
    assert f"'skils'; expected {' or '.join(IGNORABLE)}; did you mean 'skill'?" in err.replace('"', "'")


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_objective(objective, muster):
    assert muster("solve", "11T-2R", "--iterations", 5, "--objective", objective, "-o", "p.json")[0] == 0
    plan = read_plan("p.json")
    assert plan.objective == objective
    code, out, _ = muster("verify", "11T-2R", "p.json", "--objective", objective, "--format", "json")
    assert code == 0
    assert json.loads(out)["objective_name"] == objective
    assert json.loads(out)["objective"] == pytest.approx(plan.objective_value)
    assert muster("verify", "11T-2R", "p.json")[0] == (0 if objective == "total+max" else 1)


def test_unknown_objective(muster):
    code, out, err = muster("solve", "yard.yaml", "--objective", "best")
    assert (code, out) == (2, "")
    assert err == 'objective: "best"; expected total+max or total or max or average or makespan or lateness\n'


def test_allocators(muster):
    code, out, err = muster("solve", "--list-allocators")
    assert (code, err) == (0, "")
    first_words = [line.split()[0] for line in out.splitlines() if line[1:2].strip()]
    assert [name for name in first_words if name in ALLOCATORS] == list(ALLOCATORS)


def test_unknown_allocator(muster):
    code, out, err = muster("solve", "yard.yaml", "-a", "gredy")
    assert (code, out) == (2, "")
    assert err == f"allocator: gredy; expected {', '.join(ALLOCATORS)}; did you mean 'greedy'?\n"


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("population_size", "--set: population_size; expected NAME=VALUE\n"),
        ("population_size=", "--set: population_size=; expected NAME=VALUE\n"),
        ("population_size=yes", "population_size: true; expected a number\n"),
        ("population_size=many", 'population_size: "many"; expected a number\n'),
        ("=3", "--set: =3; expected NAME=VALUE\n"),
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
    flags = ["-a", "greedy+genetic", "--iterations", 5, "--set", setting]
    assert muster("solve", "yard.yaml", *flags) == (2, "", message)


def test_settings(muster):
    flags = ["-a", "greedy+genetic", "--iterations", 5]
    flags += ["--set", "population_size=3", "--set", " mutation_probability = .5"]
    assert muster("solve", "yard.yaml", *flags)[0] == 0


@pytest.mark.parametrize(
    ("flag", "message"),
    [
        (["--iterations", "-1"], "iterations: -1; expected a whole number of at least 0\n"),
        (["--time-limit", "-1"], "time_limit: -1; expected seconds, at least 0\n"),
        (["--seed", "-1"], "seed: -1; expected a whole number from 0 to 2**64 - 1\n"),
        (["--seed", "x"], "Error: Invalid value for '--seed': 'x' is not a valid integer.\n"),
    ],
)
def test_bad_number(flag, message, muster):
    code, out, err = muster("solve", "yard.yaml", *flag)
    assert (code, out) == (2, "")
    assert err.endswith(message)


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


@pytest.mark.long
def test_a_mission_without_tasks(muster):
    Path("idle.yaml").write_text("{schema: muster/1, robots: [{id: r_0, position: [0, 0]}], tasks: []}", "utf-8")
    for allocator in ALLOCATORS:
        flags = ["-a", allocator, "--iterations", 3, "-o", "p.json", "--require-complete"]
        assert muster("solve", "idle.yaml", *flags)[0] == 0
        assert muster("verify", "idle.yaml", "p.json")[0] == 0
        assert muster("explain", "idle.yaml", "p.json")[0] == 0
    pictures = ["--plot", "p.png", "--gantt", "g.png"]
    assert muster("solve", "idle.yaml", "--start", "p.json", "--iterations", 3, *pictures)[0] == 0


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


def test_a_mission_after_bound_alone_gets_a_hint(muster):
    code, out, err = muster("solve", "--bound", "6T-2R")
    assert (code, out) == (2, "")
    hint = "--bound alone stands after the mission, or as --bound=quick"
    assert err == f'bound: "6T-2R"; expected quick or exact; {hint}\n'
    assert "lower bound" in muster("solve", "--bound=quick", "6T-2R", "--iterations", 5)[1]


def test_rewired_robots_wait_less(muster):
    waits = []
    for more in ((), ("--rewire",)):
        code, out, err = muster("solve", "31T-6R50", "--iterations", "2000", *more, "-q")
        assert (code, err) == (0, "")
        assert "tasks completed   31 of 31" in out
        waits.append(float(re.search(r"waiting +([0-9.]+) s", out).group(1)))
    assert waits[1] < waits[0]
