"""Plan files: what is written is read back, and what is wrong is said at once."""

import json
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples, words

from muster.mission.errors import PlanError
from muster.mission.ignorable_rules import IGNORABLE
from muster.mission.model import OBJECTIVES
from muster.mission.plan import REASONS, Plan, Reason, Route, RouteStop, Unassigned
from muster.mission.reading.plan_reader import read_plan

finite = st.floats(allow_nan=False, allow_infinity=False)
counts = st.integers(0, 10**6)


def optional(strategy):
    return st.none() | strategy


plans = st.builds(
    Plan,
    mission=optional(words),
    allocator=optional(words),
    seed=optional(st.integers(0, 2**63 - 1)),
    ignored=st.lists(st.sampled_from(IGNORABLE), unique=True).map(tuple),
    objective=optional(st.sampled_from(OBJECTIVES)),
    objective_value=optional(finite),
    usage_unit=optional(st.sampled_from(["m", "s"])),
    total_cost=optional(finite),
    max_usage=optional(finite),
    makespan_s=optional(finite),
    equality_index=optional(finite),
    tasks_completed=optional(counts),
    tasks_total=optional(counts),
    weight_completed=optional(finite),
    lower_bound=optional(finite),
    elapsed_s=optional(finite),
    cut_short=st.booleans(),
    routes=st.lists(st.builds(Route, words, st.lists(words, max_size=3).map(tuple), optional(finite)), max_size=3).map(
        tuple
    ),
    unassigned=st.lists(
        st.builds(
            Unassigned,
            words,
            st.lists(st.builds(Reason, words, st.sampled_from(REASONS), words), max_size=2).map(tuple),
        ),
        max_size=2,
    ).map(tuple),
    history=st.lists(st.tuples(finite, finite), max_size=3).map(tuple),
)


@examples(100)
@given(plans)
def test_plans_are_read_back(folder, plan):
    path = folder / "plan.json"
    plan.save(path)
    again = read_plan(path)
    assert again == plan
    assert again.text() == path.read_text(encoding="utf-8")
    data = json.loads(plan.text())
    assert data["schema"] == "muster-plan/1"
    assert data.get("cut_short", "absent") == (plan.cut_short or "absent")


def test_a_plan_from_elsewhere_needs_only_schema_and_routes(tmp_path):
    path = tmp_path / "plan.json"
    path.write_text(
        '{"schema": "muster-plan/1", "author": "by hand", "routes": [{"robot": "r_0", "tasks": [7, "8"], "led": 3}]}',
        encoding="utf-8",
    )
    assert read_plan(path) == Plan(routes=(Route("r_0", ("7", "8")),))


def with_routes(more):
    return f'{{"schema": "muster-plan/1", "routes": [], {more}}}'


def with_route(route):
    return f'{{"schema": "muster-plan/1", "routes": [{route}]}}'


HUGE = "9" * 400
BAD_PLANS = {
    "empty": ("", ":1: Expecting value; expected a plan in JSON"),
    "not JSON": ("schema: muster-plan/1\nroutes: []\n", ":1: Expecting value; expected a plan in JSON"),
    "cut off": (
        '{"schema": "muster-plan/1",\n "routes": [',
        ":2: Expecting value; expected a plan in JSON",
    ),
    "trailing comma": (
        '{"schema": "muster-plan/1",\n "routes": [],\n}',
        ":3: Expecting property name enclosed in double quotes; expected a plan in JSON",
    ),
    "cut short": (with_routes('"cut_short": 1'), ": cut_short: 1; expected true or false"),
    "list": ("[]", ": []; expected a mapping with schema: muster-plan/1 and routes"),
    "number": ("12", ": 12; expected a mapping with schema: muster-plan/1 and routes"),
    "null": ("null", ": null; expected a mapping with schema: muster-plan/1 and routes"),
    "missing schema": ('{"routes": []}', ": schema: missing; expected muster-plan/1"),
    "wrong schema": ('{"schema": "muster/1", "routes": []}', ': schema: "muster/1"; expected muster-plan/1'),
    "missing routes": ('{"schema": "muster-plan/1"}', ": routes: missing; expected a list of routes"),
    "routes null": ('{"schema": "muster-plan/1", "routes": null}', ": routes: null; expected a list of routes"),
    "routes mapping": (
        '{"schema": "muster-plan/1", "routes": {"r_0": ["1"]}}',
        ': routes: {"r_0": ["1"]}; expected a list',
    ),
    "route list": (with_route('["1", "2"]'), ': routes[0]: ["1", "2"]; expected a mapping with robot and tasks'),
    "route without robot": (
        with_route('{"tasks": ["1"]}'),
        ': routes[0]: {"tasks": ["1"]}; expected a mapping with robot and tasks',
    ),
    "robot true": (
        with_route('{"robot": true, "tasks": []}'),
        ': routes[0]: {"robot": true, "tasks": []}; expected a mapping with robot and tasks',
    ),
    "route without tasks": (with_route('{"robot": "r_0"}'), ": routes[0].tasks: missing; expected a list of ids"),
    "tasks text": (with_route('{"robot": "r_0", "tasks": "1"}'), ': routes[0].tasks: "1"; expected a list of ids'),
    "task fraction": (
        with_route('{"robot": "r_0", "tasks": [1.5]}'),
        ": routes[0].tasks: [1.5]; expected a list of ids",
    ),
    "task true": (with_route('{"robot": "r_0", "tasks": [true]}'), ": routes[0].tasks: [true]; expected a list of ids"),
    "task null": (with_route('{"robot": "r_0", "tasks": [null]}'), ": routes[0].tasks: [null]; expected a list of ids"),
    "usage text": (
        with_route('{"robot": "r_0", "tasks": [], "usage": "3 m"}'),
        ': routes[0].usage: "3 m"; expected a finite number',
    ),
    "NaN": (with_routes('"total_cost": NaN'), ": total_cost: nan; expected a finite number"),
    "Infinity": (with_routes('"makespan_s": -Infinity'), ": makespan_s: -inf; expected a finite number"),
    "huge number": (with_routes(f'"max_usage": {HUGE}'), ': max_usage: "huge"; expected a finite number'),
    "huge exponent": (with_routes('"max_usage": 1e999'), ": max_usage: inf; expected a finite number"),
    "figure true": (with_routes('"total_cost": true'), ": total_cost: true; expected a finite number"),
    "usage of a route NaN": (
        with_route('{"robot": "r_0", "tasks": [], "usage": NaN}'),
        ": routes[0].usage: nan; expected a finite number",
    ),
    "count with point": (with_routes('"tasks_total": 3.0'), ": tasks_total: 3.0; expected a whole number"),
    "seed text": (with_routes('"seed": "1"'), ': seed: "1"; expected a whole number'),
    "mission list": (with_routes('"mission": ["a"]'), ': mission: ["a"]; expected a text'),
    "objective text": (with_routes('"objective": "total"'), ': objective: "total"; expected a mapping'),
    "objective unknown": (
        with_routes('"objective": {"name": "best"}'),
        f': objective.name: "best"; expected {" or ".join(OBJECTIVES)}',
    ),
    "objective NaN": (
        with_routes('"objective": {"name": "max", "value": NaN}'),
        ": objective.value: nan; expected a finite number",
    ),
    "objective list": (
        with_routes('"objective": {"name": ["max"]}'),
        f': objective.name: ["max"]; expected {" or ".join(OBJECTIVES)}',
    ),
    "ignored unknown": (with_routes('"ignored": ["locks"]'), f': ignored: "locks"; expected {" or ".join(IGNORABLE)}'),
    "ignored text": (
        with_routes('"ignored": "skills"'),
        f': ignored: "skills"; expected a list of {", ".join(IGNORABLE)}',
    ),
    "unassigned text": (
        with_routes('"unassigned": ["5"]'),
        ': unassigned[0]: "5"; expected a mapping with task and reasons',
    ),
    "unassigned mapping": (with_routes('"unassigned": {"5": []}'), ': unassigned: {"5": []}; expected a list'),
    "reasons text": (
        with_routes('"unassigned": [{"task": "5", "reasons": "skill"}]'),
        ': unassigned[0].reasons: "skill"; expected a list of mappings with robot, reason and detail',
    ),
    "reason without detail": (
        with_routes('"unassigned": [{"task": "5", "reasons": [{"robot": "r_0", "reason": "skill"}]}]'),
        ': unassigned[0].reasons: [{"robot": "r_0", "reason": "skill"}]; expected a list of mappings with robot, '
        "reason and detail",
    ),
    "history of texts": (
        with_routes('"history": ["1 s"]'),
        ': history: ["1 s"]; expected a list of [seconds, objective]',
    ),
    "history of three": (
        with_routes('"history": [[1, 2, 3]]'),
        ": history: [[1, 2, 3]]; expected a list of [seconds, objective]",
    ),
    "history NaN": (
        with_routes('"history": [[NaN, 2]]'),
        ": history: [[NaN, 2]]; expected a list of [seconds, objective]",
    ),
    "history true": (
        with_routes('"history": [[1, true]]'),
        ": history: [[1, true]]; expected a list of [seconds, objective]",
    ),
    "history huge": (
        with_routes(f'"history": [[{HUGE}, 1]]'),
        ': history: [["huge", 1]]; expected a list of [seconds, objective]',
    ),
    "half a character": (
        with_route('{"robot": "r_\\ud800", "tasks": []}'),
        r": \ud800 alone in a text; expected whole characters",
    ),
}


@pytest.mark.parametrize("name", BAD_PLANS)
def test_broken_plans(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text, message = BAD_PLANS[name]
    Path("plan.json").write_text(text, encoding="utf-8")
    with pytest.raises(PlanError) as caught:
        read_plan("plan.json")
    assert str(caught.value) == f"plan.json{message}"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b'{"schema": "caf\xe9"}', "plan.json:1: byte 15 is not UTF-8; expected a text in UTF-8"),
        (b"[" * 100_000, "expected a plan in JSON"),
        (b'{"schema": "muster-plan/1", "routes": [], "seed": ' + b"9" * 5000 + b"}", "expected a plan in JSON"),
    ],
)
def test_plans_that_are_no_text_or_too_much(data, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("plan.json").write_bytes(data)
    with pytest.raises(PlanError, match=re.escape(message)):
        read_plan("plan.json")


def test_a_plan_that_is_not_there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(PlanError, match=r"^none\.json: No such file or directory; expected a file to read$"):
        read_plan("none.json")


def test_all_that_is_wrong_with_a_plan_is_said_at_once(tmp_path):
    path = tmp_path / "plan.json"
    path.write_text('{"schema": 1, "total_cost": "a lot", "routes": [{"robot": "r_0", "tasks": 3}, 4]}', "utf-8")
    with pytest.raises(PlanError) as caught:
        read_plan(path)
    assert [finding.field for finding in caught.value.findings] == [
        "schema",
        "routes[0].tasks",
        "routes[1]",
        "total_cost",
    ]


def test_stops_are_written_and_read_back(tmp_path):
    stops = (RouteStop("7", 1.5, 60.0, 90.0), RouteStop("8", 95.0, 95.0, 96.0))
    plan = Plan(routes=(Route("r_0", ("7", "8"), 3.0, stops), Route("r_1", (), 0.0)))
    plan.save(tmp_path / "plan.json")
    assert read_plan(tmp_path / "plan.json") == plan
    assert '"stops": [{"task": "7", "arrive_s": 1.5, "begin_s": 60.0, "end_s": 90.0}' in plan.text()
    assert plan.text().count("stops") == 1  # a route without stops has no such key


@pytest.mark.parametrize(
    ("stops", "message"),
    [
        ("[]", None),
        ("7", "routes[0].stops: 7; expected a list of stops, one for each of its tasks"),
        ("[1, 2]", "routes[0].stops[0]: 1; expected a mapping with task"),
        ('[{"task": "7", "arrive_s": 0, "begin_s": 0}]', "stops[0].end_s: null; expected a finite number, in seconds"),
    ],
)
def test_wrong_stops_are_named(stops, message, tmp_path):
    file = tmp_path / "plan.json"
    file.write_text(f'{{"schema": "muster-plan/1", "routes": [{{"robot": "r_0", "tasks": ["7"], "stops": {stops}}}]}}')
    if message is None:
        assert read_plan(file).routes[0].stops == ()
    else:
        with pytest.raises(PlanError) as error:
            read_plan(file)
        assert message in str(error.value)
