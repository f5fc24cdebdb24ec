"""One request of a run, three doors: Python, the command and mission control give the same run or the same error."""

import itertools
import json
import sys
from dataclasses import replace
from importlib.util import find_spec

import pytest
from tests.muster_control.runs.stage import performed
from tests.running.test_live import WorldAsFleet
from tests.running.test_live import mission as a_mission_for_fleets

import muster
from muster.cli.main import run
from muster.cli.options.request import option_name
from muster.mission.errors import MusterError
from muster.mission.model import Event, Map, Mission, Robot, Task, Zone
from muster.mission.records import Settings, record, spec, specified
from muster.mission.value_types import Number, Text
from muster.mission.yaml_writer import yaml_text
from muster.planning.options import PlanningOptions
from muster.running.fleet_registry import FLEETS
from muster.running.fleet_type import FleetType
from muster.running.observed_run import ObservedRun
from muster.running.run_request import BESIDE_SETTINGS, RunRequest
from muster_control.runs.run_settings import new_request
from muster_robots.fleet_settings import Ros1Settings

MISSION = Mission(
    name="pairs",
    robots=tuple(
        Robot(id=f"r_{k}", position=(0.0, 3.0 * k), radius_m=0.2, work_capacity=60.0, kinematics="differential-drive")
        for k in range(2)
    ),
    tasks=tuple(Task(id=f"t_{k}", position=(4.0, 1.5 * k)) for k in range(3)),
    events=(Event(at_s=2.0, new_task=Task(id="late", position=(2.0, 1.0))),),
)
ORDERS = [{"at_s": 1.0, "new_task": {"id": "o_1", "position": [1.0, 2.0]}}, {"at_s": 3.0, "cancel_task": "t_2"}]
VALUES = {
    "world": ("kinematic", "physics"),
    "avoidance": ("auto", "orca", "none"),
    "traffic": ("auto", "free", "reserve"),
    "law": ("profile", "thesis", "trajectory"),
    "dt_s": (0.1, 0.2),
    "noise": ({}, {"slip": 0.05}, {"position_m": 0.02}),
    "duty": ({}, {"stay": True, "until_s": 4.0}),
    "orders": ([], ORDERS),
    "wind": ({}, {"velocity_mps": [1.0, 0.5, 0.0]}, {"gusts_mps": 3.0}),
    "rotor_level": (False, True),
    "batteries": ({}, {"all": 1.0}, {"r_0": 0.5}),
    "drain": ({}, {"r_0": 2.0}),
    "pose": (None, "true", "estimate"),
    "localise": (None, {"odometry": {}}, {"motion-capture": {"turn_deg": 3.0}}),
    "seed": (0, 7),
    "ignore": ((), ["capacity"]),
    "planning": (None, {"allocator": "greedy"}, {"rewire": True}),
}
"""The values of each field that counts in simulated worlds and changes what happens; the first is the default.

`duty` stands for `stay` and `until_s`: a fleet that stays without an end never reports.
"""
OTHER_FIELDS = {"speed", "accept_partial", "starts", "settings", "unknown", "explore", "recover"}
"""What is stated below: the wall clock, plans that were cut short, real robots, and ground without a map."""
CONFLICTS = [
    *((("world", "kinematic"), ("wind", wind)) for wind in VALUES["wind"][1:]),
    (("world", "kinematic"), ("rotor_level", True)),
    *((("traffic", "reserve"), ("law", law)) for law in VALUES["law"][1:]),
]
"""Values that do not go together: each such pair has a request of its own, which is refused."""


def covering(values, conflicts):
    """Rows that hold every pair of values of two fields, those in conflict aside; each next value covers most."""
    numbers = {name: range(len(values[name])) for name in values}
    no = {tuple((name, values[name].index(value)) for name, value in pair) for pair in conflicts}
    pairs = (((a, i), (b, j)) for a, b in itertools.combinations(values, 2) for i in numbers[a] for j in numbers[b])
    left, rows = set(pairs) - no, []
    while left:
        row = dict(min(left))
        for name in (name for name in values if name not in row):
            fits = [i for i in numbers[name] if not no & _pairs(values, row, name, i)]
            row[name] = max(fits, key=lambda i: len(left & _pairs(values, row, name, i)))
        left -= set().union(*(_pairs(values, row, name, row[name]) for name in values))
        rows.append({name: values[name][row[name]] for name in values})
    return rows


def _pairs(values, row, name, value):
    """The pairs of a value with those of a row, in the order of the fields."""
    order = list(values).index
    others = [(other, k) for other, k in row.items() if other != name]
    return {tuple(sorted(((name, value), other), key=lambda one: order(one[0]))) for other in others}


ROWS = covering(VALUES, CONFLICTS)
REFUSED = [{name: value for name, value in pair if value != VALUES[name][0]} for pair in CONFLICTS]


def given(row):
    """The fields of a row that differ from the defaults, as plain data."""
    fields = {name: value for name, value in row.items() if value != VALUES[name][0]}
    return fields | fields.pop("duty", {})


def test_every_pair_of_values_is_in_some_request():
    for a, b in itertools.combinations(VALUES, 2):
        for one, other in itertools.product(VALUES[a], VALUES[b]):
            held = any(row[a] == one and row[b] == other for row in ROWS)
            assert held or ((a, one), (b, other)) in CONFLICTS, (a, one, b, other)
    assert len(ROWS) < 40
    assert {f.name for f in specified(RunRequest)} == (VALUES.keys() - {"duty"}) | {"stay", "until_s"} | OTHER_FIELDS


@pytest.fixture(scope="module")
def plan():
    return muster.solve(MISSION, "greedy")


@pytest.fixture
def files(plan, tmp_path):
    """A folder with the mission and the plan."""
    (tmp_path / "m.yaml").write_text(yaml_text(MISSION), encoding="utf-8")
    plan.save(tmp_path / "p.json")
    return tmp_path


def by_python(plan, fields):
    try:
        return plain(muster.simulate(MISSION, plan, **fields).as_dict())
    except MusterError as error:
        return str(error)


def by_server(plan, fields):
    """What mission control answers, and what its runner does, without a socket between them."""
    settings = json.loads(json.dumps({name: value for name, value in fields.items() if name not in BESIDE_SETTINGS}))
    world = fields.get("world", "kinematic")
    try:
        request = new_request(world, (), settings, fields.get("speed"))
        there = replace(plan, ignored=request.ignore)
        return plain(performed(MISSION, there, world=world, settings=settings).log[-1]["data"])
    except MusterError as error:
        return str(error)


def by_command(files, capsys, fields):
    call = ["simulate", str(files / "m.yaml"), "--plan", str(files / "p.json"), "--format", "json", "-q"]
    code = run([*call, *itertools.chain.from_iterable(flags(files, name, value) for name, value in fields.items())])
    out, err = capsys.readouterr()
    return plain(json.loads(out)) if code == 0 else err.rstrip("\n")


def flags(files, name, value):
    """The options of the command for a field."""
    declared = {f.name: f for f in specified(RunRequest)}
    if name == "planning":
        return ["--rewire"] if value.get("rewire") else [f"--allocator={value['allocator']}"]
    if name == "ignore":
        return [f"--ignore={','.join(value)}"]
    if name == "seed":
        return [f"--seed={value}"]
    if name == "wind" and isinstance(value, dict):
        blows = ",".join(map(str, value.get("velocity_mps", ())))
        return [f"--wind={blows}"] * bool(blows) + [f"--gusts={value[key]}" for key in value if key == "gusts_mps"]
    option = option_name(declared[name])
    if value is True:
        return [option]
    if name == "orders":
        (files / "orders.jsonl").write_text("\n".join(map(json.dumps, value)), encoding="utf-8")
        return [f"{option}={files / 'orders.jsonl'}"]
    if name == "localise":
        return [f"{option}={one}:{','.join(f'{k}={v}' for k, v in how.items())}" for one, how in value.items()]
    if isinstance(value, dict):
        return [f"{option}={key}={amount}" for key, amount in value.items()]
    return [f"{option}={value}"]


def plain(report):
    """A report as JSON has it, to nine digits and without how long planning took.

    A battery is looked at when something happens, and the sum of what it gave depends on these moments by rounding.
    """
    data = json.loads(json.dumps(report), parse_float=lambda text: float(f"{float(text):.9g}"))
    if data.get("orders"):
        data["orders"] = {key: value for key, value in data["orders"].items() if not key.endswith("_ms")}
    return data


@pytest.mark.long
@pytest.mark.parametrize("row", [pytest.param(given(row), id=str(k)) for k, row in enumerate(ROWS)])
def test_the_doors_answer_alike(row, plan, files, capsys):
    if row.get("world") == "physics" and find_spec("mujoco") is None:
        pytest.skip("needs the extra physics")
    python = by_python(plan, row)
    assert not isinstance(python, str), python
    assert by_command(files, capsys, row) == python
    assert by_server(plan, row) == python


@pytest.mark.long
@pytest.mark.parametrize("fields", [{"unknown": True}, {"unknown": True, "explore": True, "seed": 3}], ids=len)
def test_the_doors_answer_alike_where_robots_have_no_map(fields, tmp_path, capsys, monkeypatch):
    wall = Zone(polygon=((2.0, -1.0), (2.3, -1.0), (2.3, 3.0), (2.0, 3.0)), forbidden_to=("ground", "air"))
    ground = Map(boundary=((-2.0, -2.0), (6.0, -2.0), (6.0, 6.0), (-2.0, 6.0)), zones=(wall,))
    mission = replace(MISSION, map=ground, events=())
    monkeypatch.setattr(sys.modules[__name__], "MISSION", mission)
    plan = muster.solve(mission, "greedy")
    (tmp_path / "m.yaml").write_text(yaml_text(mission), encoding="utf-8")
    plan.save(tmp_path / "p.json")
    python = by_python(plan, fields)
    assert python["ground"]["driven_m"] >= python["ground"]["with_map_m"] - 0.1 > 0
    assert by_command(tmp_path, capsys, fields) == python
    assert by_server(plan, fields) == python


@pytest.mark.parametrize("fields", REFUSED, ids=lambda fields: "-".join(fields))
def test_the_doors_refuse_conflicts_alike(fields, plan, files, capsys):
    python = by_python(plan, fields)
    assert "; expected" in python
    assert by_command(files, capsys, fields) == by_server(plan, fields) == python


WRONG = {
    "world": ("fysics", 'world: "fysics"; expected kinematic or physics or ros1 or ros2 or mavlink; did you mean'),
    "avoidance": ("orcas", 'avoidance: "orcas"; expected auto or orca or rvo or hrvo or avo or none; did you mean'),
    "explore": (True, "explore: true; expected it together with unknown"),
    "traffic": ("fast", 'traffic: "fast"; expected auto or free or reserve'),
    "law": ("thesiss", 'law: "thesiss"; expected profile or thesis or trajectory; did you mean'),
    "dt_s": (7, "dt_s: 7; expected a finite number, at least 0.001 and at most 1"),
    "speed": (0, "speed: 0; expected a finite number, at least 0.001 and at most 1e+06"),
    "noise": ({"slip": 2}, "noise.slip: 2; expected a finite number, at least 0 and at most 1"),
    "until_s": (4.0, "until_s: 4.0; expected it together with stay"),
    "wind": ({"gusts_mps": -1}, "wind.gusts_mps: -1; expected a finite number, at least 0"),
    "rotor_level": (True, "rotor_level: true; expected the world physics: kinematic has no rotors"),
    "batteries": ({"r_0": 2}, "batteries.r_0: 2; expected a finite number, at least 0 and at most 1"),
    "drain": ({"r_9": 2.0}, "drain: robot r_9; expected all or a robot"),
    "pose": ("truth", 'pose: "truth"; expected true or estimate'),
    "localise": ({"gps": {}}, "localise: gps; expected odometry among them, or motion-capture alone"),
    "seed": (-1, "seed: -1; expected a whole number"),
    "ignore": (["capcity"], 'ignore: "capcity"; expected prerequisite or'),
    "planning": ({"allocator": "gredy"}, "allocator: gredy; expected greedy, "),
}


@pytest.mark.parametrize("name", WRONG)
def test_the_doors_refuse_alike(name, plan, files, capsys):
    value, message = WRONG[name]
    python = by_python(plan, {name: value})
    assert isinstance(python, str)
    assert python.startswith(message)
    server, command = by_server(plan, {name: value}), by_command(files, capsys, {name: value})
    assert server.partition(";")[0] == command.partition(";")[0] == python.partition(";")[0]
    if name != "seed":  # planning says it, which the command does first
        assert (server, command) == (python, python)


def test_a_plan_that_was_cut_short_needs_to_be_accepted(plan, files, capsys):
    cut = replace(plan, cut_short=True)
    cut.save(files / "p.json")
    assert by_python(cut, {}) == by_command(files, capsys, {})
    accepted = {"accept_partial": True}
    assert by_python(cut, accepted) == by_command(files, capsys, accepted) == by_server(cut, accepted)


def test_a_request_is_read_again_from_its_settings():
    for row in ROWS:
        world = row["world"]
        fields = {name: value for name, value in given(row).items() if name != "world"}
        try:
            request = RunRequest.from_settings(world, fields)
        except MusterError:
            continue
        again = json.loads(json.dumps(request.as_settings()))
        assert RunRequest.from_settings(world, again) == request
    assert RunRequest().as_settings() == {}


def test_a_request_of_real_robots_is_read_again():
    flat = {"drive": "goals", "avoidance": "orca", "namespace": "team", "starts": "now", "seed": 3, "stay": True}
    request = RunRequest.from_settings("ros1", flat)
    assert request.settings == Ros1Settings(drive="goals", avoidance="orca", namespace="team")
    assert request.avoidance == "auto"
    settings = request.as_settings()
    assert settings == {**flat, "frame": "map", "odometry": "map", "poses": ""}  # as a profile may say otherwise
    assert RunRequest.from_settings("ros1", settings) == request


def test_what_only_this_process_has_is_no_setting():
    request = ObservedRun(planning=PlanningOptions(allocator=lambda problem: []), on_event=print)
    with pytest.raises(MusterError, match="allocator: a function; expected the name of an allocator"):
        request.as_settings()
    with pytest.raises(MusterError, match="orders: generator; expected a list or a file"):
        ObservedRun(orders=(event for event in MISSION.events)).as_settings()
    assert ObservedRun(on_event=print, record="r.mcap").as_settings() == {}


@record
class AcmeSettings(Settings):
    """How the robots of Acme are reached."""

    url: str = spec(Text(), "address of their server")
    tries: float = spec(Number(minimum=1), "how often it is asked", default=3.0)


@pytest.fixture
def acme():
    """A fleet of another package; gives the settings and claims with which it was opened and claimed."""
    opened, claimed = [], []

    def claims(settings):
        claimed.append(settings)
        return [f"acme at {settings.url}"]

    def open_acme(mission, settings, halt, again):
        opened.append(settings)
        return WorldAsFleet(mission), lambda: opened.append("end")

    abilities = ("ground", "holds", "returns", "resumes")
    FLEETS.add(
        "acme", FleetType(name="acme", open=open_acme, abilities=abilities, settings=AcmeSettings, claims=claims)
    )
    yield opened, claimed
    FLEETS.remove("acme")


@pytest.fixture
def for_fleets(tmp_path):
    """A mission that a world behind a fleet carries out, its plan, and their files."""
    there = a_mission_for_fleets()
    plan = muster.solve(there, "greedy")
    (tmp_path / "m.yaml").write_text(yaml_text(there), encoding="utf-8")
    plan.save(tmp_path / "p.json")
    return there, plan, ["run", str(tmp_path / "m.yaml"), "--plan", str(tmp_path / "p.json"), "-q", "--format", "json"]


def test_a_registered_fleet_carries_out_by_python_and_command(acme, for_fleets, capsys):
    opened, claimed = acme
    there, plan, call = for_fleets
    python = muster.carry_out(there, plan, "acme", settings={"url": "here"})
    assert run([*call, "--fleet", "acme", "--setting", "url=here", "--setting", "tries=2"]) == 0
    command = json.loads(capsys.readouterr().out)
    assert set(command["tasks_done"]) == set(python.tasks_done) == {"t_0", "t_1", "t_2", "t_3"}
    assert opened == [AcmeSettings(url="here"), "end", AcmeSettings(url="here", tries=2.0), "end"]
    assert claimed == [AcmeSettings(url="here"), *[AcmeSettings(url="here", tries=2.0)] * 2]  # for its journal, too


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"urll": "x"}, "urll: unknown; did you mean 'url'?"),
        ({}, "url: missing; expected a text of one line"),
        ({"url": "x", "tries": 0}, "tries: 0; expected a finite number, at least 1"),
        ({"url": "x", "tries": "many"}, 'tries: "many"; expected a finite number, at least 1'),
    ],
)
def test_the_doors_refuse_settings_of_a_fleet_alike(acme, for_fleets, capsys, settings, message):
    there, plan, call = for_fleets
    with pytest.raises(MusterError) as python:
        muster.carry_out(there, plan, "acme", settings=settings)
    with pytest.raises(MusterError) as server:
        new_request("acme", ("acme",), settings)
    texts = itertools.chain.from_iterable(("--setting", f"{key}={value}") for key, value in settings.items())
    assert run([*call, "--fleet", "acme", *texts]) == 2
    assert str(python.value) == str(server.value) == capsys.readouterr().err.rstrip("\n") == message
    assert acme == ([], [])


def test_a_fleet_carries_no_robots_of_a_kind_that_it_does_not_have(acme):
    flies = Mission(
        robots=(Robot(id="d", position=(0.0, 0.0), kind="air"),), tasks=(Task(id="t", position=(1.0, 1.0)),)
    )
    with pytest.raises(MusterError, match='robot "d": kind air; expected ground: fleet acme has no others'):
        muster.carry_out(flies, muster.solve(flies, "greedy"), "acme", settings={"url": "x"})


def test_no_robot_joins_a_fleet_that_does_not_let_robots_join(acme):
    joins = Event(at_s=1.0, robot_joins=Robot(id="new", position=(0.0, 9.0)))
    there = replace(a_mission_for_fleets(), events=(joins,))
    with pytest.raises(MusterError, match='robot "new": joins; expected none: no robot joins fleet acme'):
        muster.carry_out(there, muster.solve(there, "greedy"), "acme", settings={"url": "x"})


def test_no_fleet_of_that_name(for_fleets, capsys):
    _, _, call = for_fleets
    assert run([*call, "--fleet", "ros3"]) == 2
    assert capsys.readouterr().err == "fleet: ros3; expected ros1, ros2, mavlink; did you mean 'ros2'?\n"


def test_fleets_are_listed_with_their_settings(acme, capsys):
    assert run(["run", "--list-fleets"]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["acme", "url", "required"] in [row[:3] for row in rows]
    assert ["mavlink", "endpoints", "required"] in [row[:3] for row in rows]
    assert ["ros2", "arrival_m", "0.25"] in [row[:3] for row in rows]
