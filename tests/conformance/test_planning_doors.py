"""One planning request, three doors: Python, the command and a worker of the server give the same plan or error."""

import asyncio
import base64
import json
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path

import pytest

import muster
from muster.cli.main import run
from muster.library import mission_path
from muster.mission.errors import MusterError
from muster.mission.plan import PLAN_SCHEMA
from muster.mission.reading.plan_reader import plan_from
from muster.planning.options import BOUNDS, OPTIONS
from muster.planning.request import Request
from muster_control.api.plans import PlanToMake
from muster_control.work import Pool

GOOD = {"r_0": ["2"], "r_1": ["3"]}


@dataclass(frozen=True)
class Case:
    """A request: a shipped mission, options by the names of Python, and plans by the tasks of their robots.

    `error` is what every door says; without it every door gives a plan.
    """

    name: str
    mission: str = "31T-6R50"
    options: dict = field(default_factory=dict)
    parameters: dict = field(default_factory=dict)
    start: dict | None = None
    fixed: dict | None = None
    error: str = ""

    def plans(self):
        """The plans of the request, as their files hold them."""
        given = {"start": self.start, "fixed": self.fixed}
        return {name: plan_of(routes) for name, routes in given.items() if routes is not None}


def plan_of(routes):
    return {"schema": PLAN_SCHEMA, "routes": [{"robot": robot, "tasks": tasks} for robot, tasks in routes.items()]}


def searching(**more):
    return {"iterations": 60, **more}


VALID = [
    Case("greedy", options={"allocator": "greedy"}),
    Case("greedy with a time limit of none", options={"allocator": "greedy", "time_limit": 0.0}),
    Case("search", options=searching(seed=3)),
    Case("search for the least maximum", options=searching(objective="max")),
    Case("search for the least total", options=searching(objective="total", seed=2**63)),
    Case("search for the least makespan, rewired", options=searching(objective="makespan", rewire=True)),
    Case("genetic", options=searching(allocator="genetic", seed=7), parameters={"population_size": 10}),
    Case("hill climbing", options=searching(allocator="hill-climbing")),
    Case("greedy and genetic", options=searching(allocator="greedy+genetic", seed=5)),
    Case("auction", options={"allocator": "auction"}, parameters={"bid": "max", "placement": "append"}),
    Case("market", options={"allocator": "market", "iterations": 5}),
    Case("consensus-based bundles", options={"allocator": "consensus-bundle"}),
    Case("rules ignored", options=searching(ignore=["capacity", "prerequisite"])),
    Case("suitability ignored", options=searching(ignore=["suitability"], objective="average")),
    Case("from a start", options=searching(), start=GOOD, mission="eil51-5"),
    Case("fixed beginnings", options=searching(bound="quick"), fixed=GOOD, mission="eil51-5"),
    Case("a start with fixed beginnings", options=searching(), start=GOOD, fixed={"r_0": ["2"]}, mission="eil51-5"),
    Case("a quick bound", options=searching(bound="quick"), mission="eil51-5"),
    Case("rewired and bounded", options=searching(rewire=True, bound="quick")),
    Case("an exact bound", options=searching(bound="exact"), mission="6T-2R"),
    Case("traffic told", options=searching(traffic="reserve")),
    Case("free traffic", options=searching(traffic="free"), mission="market-rescue-arena"),
]
INVALID = [
    Case("no such allocator", options={"allocator": "gredy"}, error="allocator: gredy; expected greedy, "),
    Case("no such objective", options={"objective": "best"}, error='objective: "best"; expected total+max or total'),
    Case("a time limit below 0", options={"time_limit": -1}, error="time_limit: -1; expected seconds, at least 0"),
    Case("iterations below 0", options={"iterations": -2}, error="iterations: -2; expected a whole number"),
    Case("a seed below 0", options={"seed": -1}, error="seed: -1; expected a whole number from 0 to 2**64 - 1"),
    Case("a seed of too many bits", options={"seed": 2**64}, error="seed: 18446744073709551616; expected a whole"),
    Case("no such rule", options={"ignore": ["capacity", "skils"]}, error='ignore: "skils"; expected prerequisite or'),
    Case(
        "an exact bound of too many tasks",
        options=searching(bound="exact"),
        mission="eil51-5",
        error="bound: exact, of 50 tasks; expected at most 40",
    ),
    Case("no such traffic", options={"traffic": "fast"}, error='traffic: "fast"; expected auto or free or reserve'),
    Case("no such parameter", parameters={"population": 3}, error="search has no parameter population"),
    Case(
        "a parameter out of range",
        options={"allocator": "genetic"},
        parameters={"population_size": 0},
        error="population_size: 0; expected a whole number of at least 1",
    ),
    Case(
        "a parameter of another kind",
        options={"allocator": "genetic"},
        parameters={"population_size": "many"},
        error='population_size: "many"; expected a number',
    ),
    Case("a start with an unknown robot", start={"r_99": ["1"]}, error="start: robot r_99 is not in the mission"),
    Case("a start with an unknown task", start={"r_0": ["x"]}, error="start: task x is not in the mission"),
    Case("a fixed plan with an unknown task", fixed={"r_0": ["x"]}, error="fixed: task x is not in the mission"),
    Case(
        "an allocator that would move fixed tasks",
        options={"allocator": "genetic", "iterations": 5},
        fixed=GOOD,
        mission="eil51-5",
        error="fixed: with genetic, which would move tasks; expected search, greedy or auction",
    ),
    Case(
        "a start that does not begin with the fixed tasks",
        options=searching(),
        start=GOOD,
        fixed={"r_0": ["4"]},
        mission="eil51-5",
        error="start: robot r_0 does not begin with the fixed tasks 4",
    ),
]


def by_python(case):
    plans = {name: plan_from(data, name) for name, data in case.plans().items()}
    try:
        return muster.solve(muster.load(case.mission), **case.options, **plans, **case.parameters).as_dict()
    except MusterError as error:
        return str(error)


def by_command(case, capsys):
    flags = []
    for name, value in case.options.items():
        flag = f"--{name.replace('_', '-')}"
        if value is True:
            flags.append(flag)
        else:
            flags.append(f"{flag}={','.join(value) if isinstance(value, list) else value}")
    for name, value in case.parameters.items():
        flags += ["--set", f"{name}={value}"]
    for name, data in case.plans().items():
        Path(f"{name}.json").write_text(json.dumps(data), encoding="utf-8")
        flags.append(f"--{name}={name}.json")
    code = run(["solve", case.mission, *flags, "--format", "json", "-q"])
    out, err = capsys.readouterr()
    if code == 0:
        return json.loads(out)
    assert (code, out) == (2, "")
    return err.rstrip("\n")


@pytest.fixture(scope="module")
def worker():
    """Gives a worker process of the server a request; its plan, or what is wrong."""
    with asyncio.Runner() as runner:
        pool = Pool(workers=1, memory_mb=1024)

        def ask(case):
            path = mission_path(case.mission)
            files = {file.name: base64.b64encode(file.read_bytes()).decode() for file in path.parent.glob("*.csv")}
            mission = {"text": path.read_text(encoding="utf-8"), "name": case.mission, "files": files}
            plain = json.loads(json.dumps({**case.options, "parameters": case.parameters, **case.plans()}))
            try:
                return runner.run(pool.run("plan", {"mission": mission, **plain}, limit_s=60))["plan"]
            except MusterError as error:
                return str(error)

        yield ask
        runner.run(pool.close())


def figures(answer):
    """A plan without times."""
    if isinstance(answer, str):
        return answer
    plain = json.loads(json.dumps(answer))
    plain["history"] = [objective for _, objective in plain["history"]]
    return {name: value for name, value in plain.items() if name != "elapsed_s"}


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("case", [pytest.param(case, id=case.name.replace(" ", "-")) for case in (*VALID, *INVALID)])
def test_the_doors_answer_alike(case, worker, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if case.options.get("bound") == "exact" and find_spec("ortools") is None:
        pytest.skip("needs the extra exact")
    python, command, server = figures(by_python(case)), figures(by_command(case, capsys)), figures(worker(case))
    assert python == command
    assert python == server
    if case.error:
        assert isinstance(python, str)
        assert python.startswith(case.error)
    else:
        assert python["tasks_completed"] > 0
        judged = muster.verify(
            muster.load(case.mission), plan_from(python | {"history": []}, "plan"), case.options.get("ignore", ()),
            python["objective"]["name"],
        )  # fmt: skip
        assert judged.valid, judged.violations


def test_there_are_requests_enough_and_all_options_occur():
    cases = [*VALID, *INVALID]
    assert len(cases) >= 30
    named = {name for case in cases for name in case.options} | {"parameters"}
    assert named == set(OPTIONS)
    assert any(case.start for case in VALID)
    assert any(case.fixed for case in VALID)


def test_the_body_of_the_api_has_the_fields_of_the_request():
    assert set(PlanToMake.model_fields) == {*OPTIONS, "start", "fixed", "version"}
    assert set(Request.__dataclass_fields__) == {*OPTIONS, "mission", "start", "fixed"}


@pytest.mark.long
def test_the_bounds_are_those_that_can_be_proven():
    from muster.allocation.exact.proofs import PROOFS

    assert BOUNDS == PROOFS
