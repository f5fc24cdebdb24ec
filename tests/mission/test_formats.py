"""Files of missions and plans: what is written is read back, and what cannot be written is refused."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator
from tests.mission.strategies import examples, missions, plain_missions, salesmen, tiny_missions, words

import muster
from muster.library import mission_names, mission_path
from muster.mission import json_schema
from muster.mission.errors import MissionError, PlanError
from muster.mission.model import (
    IGNORABLE,
    OBJECTIVES,
    Action,
    Event,
    Map,
    Mission,
    Robot,
    Rules,
    Task,
)
from muster.mission.plan import REASONS, Plan, Reason, Route, Unassigned, read_plan
from muster.mission.thesis_csv import read_csv, write_csv
from muster.mission.tsplib import read_tsplib, write_tsplib
from muster.mission.yaml_reader import parse_yaml, read_yaml
from muster.mission.yaml_writer import yaml_text

FILE = Path("mission.yaml")
BROKEN = Path(__file__).parent / "broken"
SHIPPED = [name for name in mission_names() if mission_path(name).suffix == ".yaml"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """One folder for all examples of a property; each writes its files anew."""
    return tmp_path_factory.mktemp("formats")


# --- YAML ------------------------------------------------------------------------------------------------------------


@examples(120)
@given(missions())
def test_yaml_is_read_back(mission):
    text = yaml_text(mission)
    again = parse_yaml(text, FILE)
    assert again == mission
    assert yaml_text(again) == text


@examples(40)
@given(tiny_missions(tabled=True))
def test_yaml_with_travel_tables_is_read_back(folder, mission):
    for kind, table in mission.travel_tables.items():
        lines = [["from", *table.places]]
        lines += [[place, *map(repr, row)] for place, row in zip(table.places, table.metres, strict=True)]
        (folder / f"{kind}.csv").write_text("".join(",".join(line) + "\n" for line in lines), encoding="utf-8")
    (folder / "mission.yaml").write_text(yaml_text(mission), encoding="utf-8")
    assert read_yaml(folder / "mission.yaml") == mission


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_missions_are_read_back(name):
    mission = muster.load(name)
    assert parse_yaml(yaml_text(mission), FILE) == mission


def test_a_byte_order_mark_and_line_ends_of_windows(tmp_path):
    path = mission_path("6T-2R")
    copy = tmp_path / "windows.yaml"
    copy.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    assert read_yaml(copy) == read_yaml(path)


def test_aliases():
    text = """
    schema: muster/1
    robots:
      - {id: r_0, position: &depot [0, 0], skills: &skills [camera]}
      - {id: r_1, position: *depot, end_position: *depot, skills: *skills}
    tasks: []
    """
    mission = parse_yaml(text, FILE)
    assert mission.robots[1] == Robot(id="r_1", position=(0, 0), end_position=(0, 0), skills=("camera",))


ONE = "{{schema: muster/1, robots: [{{id: {id}, position: [0, 0], work_capacity: {number}}}], tasks: []}}"


@pytest.mark.parametrize(
    ("written", "read"),
    [
        *[
            (word, word)
            for word in ("no", "No", "off", "on", "y", "yes", "1:30", "1_000", "2026-10-07", "0b11", "1e", "=")
        ],
        *[("7", "7"), ("0777", "777"), ("+5", "5"), ("-5", "-5"), ("0o17", "15"), ("0x1F", "31"), ("0", "0")],
        *[(f'"{word}"', word) for word in ("7", "0777", "1e3", "1.0", "true", "null", "~", ".inf", "0x1F")],
        *[("'7'", "7"), ("'it''s'", "it's"), ("nan", "nan"), ("inf", "inf"), ("r 0", "r 0"), ("<<", "<<")],
    ],
)
def test_names_by_the_core_schema_of_yaml_1_2(written, read):
    assert parse_yaml(ONE.format(id=written, number=1), FILE).robots[0].id == read


@pytest.mark.parametrize(
    ("written", "read"),
    [
        *[("1e3", 1000.0), ("1E+3", 1000.0), ("1.", 1.0), (".5", 0.5), ("+.5", 0.5), ("0.5e-1", 0.05), ("0777", 777.0)],
        *[("0x10", 16.0), ("0o17", 15.0), ("1" + "0" * 299, 1e299), ("5e-324", 5e-324), ("-0.0", 0.0), ("12", 12.0)],
        *[(word, None) for word in ("null", "Null", "NULL", "~", "")],
    ],
)
def test_numbers_by_the_core_schema_of_yaml_1_2(written, read):
    assert parse_yaml(ONE.format(id="r_0", number=written), FILE).robots[0].work_capacity == read


@pytest.mark.parametrize("written", ["1:30", "1_000", "0b11", '"5"', "5 m", ".nan", ".inf", "-.INF", "1e999", "true"])
def test_what_is_no_number_by_the_core_schema_of_yaml_1_2(written):
    with pytest.raises(MissionError, match=r"^mission.yaml:1: robots\[0\].work_capacity: .*; expected a finite number"):
        parse_yaml(ONE.format(id="r_0", number=written), FILE)


@pytest.mark.parametrize(("written", "read"), [("true", True), ("True", True), ("FALSE", False)])
def test_flags_by_the_core_schema_of_yaml_1_2(written, read):
    text = (
        f"{{schema: muster/1, rules: {{return_to_start: {written}}}, robots: [{{id: 1, position: [0, 0]}}], tasks: []}}"
    )
    assert parse_yaml(text, FILE).rules.return_to_start is read


def test_a_type_is_the_same_word_as_a_key_and_as_a_value():
    text = """
    schema: muster/1
    suitability: {01: {007: 0.9, 0x10: 0.8}}
    robots: [{id: r_0, type: 01, position: [0, 0]}]
    tasks: [{id: a, type: 007, position: [0, 0]}, {id: b, type: 0x10, position: [0, 0]}]
    """
    mission = parse_yaml(text, FILE)
    assert mission.suitability == {
        mission.robots[0].type: {task.type: s for task, s in zip(mission.tasks, (0.9, 0.8), strict=True)}
    }


# --- CSV -------------------------------------------------------------------------------------------------------------


def csv_files(folder):
    return folder / "tasks.csv", folder / "robots.csv", folder / "suitability.csv"


def through_csv(mission, folder):
    """The mission written as CSV and read back."""
    tasks, robots, suitability = csv_files(folder)
    table = None if mission.suitability is None else suitability
    write_csv(mission, tasks, robots, table)
    return read_csv(tasks, robots, table)


def filled(mission):
    """With a score of 0 for every type of task that a row lacks: a table in CSV has no gaps."""
    if mission.suitability is None:
        return mission
    columns = {kind for row in mission.suitability.values() for kind in row}
    table = {name: dict.fromkeys(columns, 0.0) | dict(row) for name, row in mission.suitability.items()}
    return replace(mission, suitability=table)


@examples(80)
@given(plain_missions())
def test_csv_is_read_back(folder, mission):
    assert through_csv(mission, folder) == filled(mission)


@examples(120)
@given(plain_missions(names="any"))
def test_csv_is_read_back_or_refused(folder, mission):
    """Names with spaces, commas and brackets: whatever is written means the same when it is read."""
    try:
        again = through_csv(mission, folder)
    except MissionError as error:
        again, refused = None, {finding.value for finding in error.findings}
    assert again == filled(mission) if again else refused == {"more than CSV can say"}


R, T = Robot(id="r_0", position=(0, 0)), Task(id="1", position=(4, 5))
PLAIN = Mission(name="tasks", robots=(R,), tasks=(T,))


@pytest.mark.parametrize(
    ("mission", "field"),
    [
        (replace(PLAIN, rules=Rules(objective="max")), "rules"),
        (replace(PLAIN, rules=Rules(travel="euclidean"), map=Map(ros_yaml="floor.yaml")), "map"),
        (replace(PLAIN, events=(Event(at_s=3, cancel_task="1"),)), "events"),
        (replace(PLAIN, robots=(replace(R, speed_mps=2),)), "robots"),
        (replace(PLAIN, robots=(replace(R, skills=("camera",)),)), "robots"),
        (replace(PLAIN, robots=(replace(R, end_position=(1, 1)),)), "robots"),
        (replace(PLAIN, tasks=(replace(T, requires=("camera",)),)), "tasks"),
        (replace(PLAIN, tasks=(replace(T, priority=2),)), "tasks"),
        (replace(PLAIN, tasks=(replace(T, duration_s=0),)), "tasks"),
        (replace(PLAIN, tasks=(replace(T, action=Action(name="go-to-goal")),)), "tasks"),
        (replace(PLAIN, tasks=(replace(T, id="a b"), Task(id="2", position=(1, 1), prerequisites=("a b",)))), "tasks"),
        (replace(PLAIN, tasks=(replace(T, id="[7]"), Task(id="2", position=(1, 1), prerequisites=("[7]",)))), "tasks"),
        (replace(PLAIN, tasks=(replace(T, id=" 1"),)), "tasks"),
        (replace(PLAIN, robots=(replace(R, type="beta "),)), "robots"),
    ],
)
def test_what_csv_cannot_say_is_refused_and_nothing_is_written(mission, field, tmp_path):
    with pytest.raises(MissionError) as caught:
        write_csv(mission, *csv_files(tmp_path))
    assert field in [finding.field for finding in caught.value.findings]
    assert all(f.value == "more than CSV can say" for f in caught.value.findings)
    assert list(tmp_path.iterdir()) == []


def test_suitability_without_a_file_for_it_is_refused(tmp_path):
    table = {"beta": {"D": 0.9}}
    mission = replace(PLAIN, suitability=table, robots=(replace(R, type="beta"),), tasks=(replace(T, type="D"),))
    with pytest.raises(MissionError, match="suitability: more than CSV can say"):
        write_csv(mission, *csv_files(tmp_path)[:2])


def test_csv_as_people_write_it(tmp_path):
    """Spaces, empty lines, every form of a list and of an unlimited capacity, columns in another order."""
    tasks, robots, _ = csv_files(tmp_path)
    tasks.write_text(
        'type, index ,x,y,prerequisites,actuation_cost\r\n\r\nD,1, 4 ,5,[],\r\nD,2,4,5,1,2.5\r\n,3,4,5,"[1, 2]",0\r\n'
        "D,4,4,5,1 2 3,0\r\nD,5,4,5,1;2,0\r\nD,6,4,5,,0\r\n",
        encoding="utf-8-sig",
    )
    robots.write_text("id,type,x,y,work_capacity\nr_0,,0,0,inf\nr_1,,1e1,0,\nr_2,,0,-.5,INF\nr_3,,0,0,50\n", "utf-8")
    mission = read_csv(tasks, robots)
    assert mission.name == "tasks"
    assert [task.prerequisites for task in mission.tasks] == [(), ("1",), ("1", "2"), ("1", "2", "3"), ("1", "2"), ()]
    assert [task.actuation_cost for task in mission.tasks] == [0, 2.5, 0, 0, 0, 0]
    assert [task.type for task in mission.tasks] == ["D", "D", None, "D", "D", "D"]
    assert [robot.work_capacity for robot in mission.robots] == [None, None, None, 50]
    assert mission.robots[1].position == (10, 0)


# --- TSPLIB ----------------------------------------------------------------------------------------------------------


@examples(80)
@given(salesmen())
def test_tsplib_is_read_back(folder, mission):
    path = folder / "places.tsp"
    write_tsplib(mission, path)
    assert read_tsplib(path, salesmen=len(mission.robots)) == mission


@pytest.mark.parametrize("name", ["eil51-3", "eil51-5", "berlin52-5", "eil76-7"])
def test_shipped_salesmen_are_the_shipped_tsplib_files(name, tmp_path):
    mission, (stem, count) = muster.load(name), name.split("-")
    assert muster.load(stem, salesmen=int(count)) == mission
    write_tsplib(mission, tmp_path / "again.tsp")
    assert read_tsplib(tmp_path / "again.tsp", salesmen=int(count)) == mission


CLOSED = Mission(
    name="places-1",
    rules=Rules(return_to_start=True),
    robots=(R,),
    tasks=(Task(id="2", position=(4, 5)), Task(id="3", position=(4, 6))),
)


@pytest.mark.parametrize(
    "mission",
    [
        replace(CLOSED, rules=Rules()),
        replace(CLOSED, rules=Rules(return_to_start=True, objective="max")),
        replace(CLOSED, robots=(R, Robot(id="r_1", position=(1, 0)))),
        replace(CLOSED, robots=(replace(R, work_capacity=9),)),
        replace(CLOSED, robots=(replace(R, id="drone"),)),
        replace(CLOSED, tasks=(replace(CLOSED.tasks[0], actuation_cost=1),)),
        replace(CLOSED, tasks=(replace(CLOSED.tasks[0], id="a"),)),
        replace(CLOSED, tasks=CLOSED.tasks[::-1]),
        replace(CLOSED, tasks=(replace(CLOSED.tasks[1], prerequisites=("2",)), CLOSED.tasks[0])),
        replace(CLOSED, robots=(Robot(id="r_0", position=(0, 0, 0)),), tasks=()),
    ],
)
def test_what_tsplib_cannot_say_is_refused_and_nothing_is_written(mission, tmp_path):
    with pytest.raises(
        MissionError, match="more than TSPLIB can say; expected salesmen, one depot, plain tasks in 2-D"
    ):
        write_tsplib(mission, tmp_path / "places.tsp")
    assert list(tmp_path.iterdir()) == []


def test_the_depot_can_be_any_node(tmp_path):
    path = tmp_path / "three.tsp"
    path.write_text(
        "NAME: three\nTYPE: TSP\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: EUC_2D\n"
        "NODE_COORD_SECTION\n1 0 0\n2 1.5 1e1\n 3 2 2\n",
        encoding="utf-8",
    )
    mission = muster.load(path, salesmen=2, depot="2")
    assert mission.name == "three-2"
    assert [robot.position for robot in mission.robots] == [(1.5, 10)] * 2
    assert [task.id for task in mission.tasks] == ["1", "3"]
    assert mission.rules == Rules(return_to_start=True)


# --- the JSON Schema -------------------------------------------------------------------------------------------------


class CoreLoader(yaml.SafeLoader):
    """PyYAML with the scalars of YAML 1.2's core schema, as any editor with a YAML 1.2 parser has them."""

    yaml_implicit_resolvers: ClassVar = {}


for tag, pattern in {
    "null": r"~|null|Null|NULL|",
    "bool": r"true|True|TRUE|false|False|FALSE",
    "int": r"[-+]?[0-9]+",
    "float": r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?",
}.items():
    CoreLoader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(rf"^(?:{pattern})$"), None)


def plain_data(text):
    return yaml.load(text, Loader=CoreLoader)


@pytest.fixture(scope="module")
def validator():
    schema = json.loads(json_schema.schema_text())
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def test_the_schema_that_ships_is_that_of_the_model():
    shipped = Path(json_schema.__file__).with_name("muster-1.schema.json").read_text(encoding="utf-8")
    assert shipped == json_schema.schema_text()


@pytest.mark.parametrize("name", SHIPPED)
def test_the_schema_accepts_shipped_missions(name, validator):
    assert list(validator.iter_errors(plain_data(mission_path(name).read_text(encoding="utf-8")))) == []


@examples(40)
@given(mission=missions())
def test_the_schema_accepts_what_is_written(validator, mission):
    assert list(validator.iter_errors(plain_data(yaml_text(mission)))) == []


def test_the_schema_accepts_keys_without_value_that_the_reader_accepts(validator):
    text = "schema: muster/1\nrobots: [{id: r_0, position: [0, 0], work_capacity: null, camera: }]\ntasks: []\nmap:\n"
    assert parse_yaml(text, FILE).robots[0].work_capacity is None
    assert list(validator.iter_errors(plain_data(text))) == []


@pytest.mark.parametrize(
    "name",
    [
        *("unknown-key-top", "unknown-key-robot-no-hint", "unknown-key-camera", "reserved-time-window", "lat-lon"),
        *("missing-schema", "missing-robots", "missing-tasks", "missing-position", "no-robots", "wrong-schema-version"),
        *("robots-mapping", "skills-text", "flag-number", "negative-work-capacity", "zero-speed", "unknown-kind"),
        *(
            "capacity-reserve-1",
            "unknown-objective",
            "suitability-score-above-1",
            "action-unknown",
            "only-robots-empty",
        ),
        *("event-without-happening", "event-with-two-happenings", "map-boundary-in-space", "position-of-one-number"),
    ],
)
def test_the_schema_refuses_what_the_reader_refuses(name, validator):
    data = plain_data((BROKEN / f"{name}.yaml").read_text(encoding="utf-8"))
    assert list(validator.iter_errors(data)) != []


# --- plans -----------------------------------------------------------------------------------------------------------

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
    assert json.loads(plan.text())["schema"] == "muster-plan/1"


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
    "ignored unknown": (with_routes('"ignored": ["skill"]'), f': ignored: "skill"; expected {" or ".join(IGNORABLE)}'),
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
