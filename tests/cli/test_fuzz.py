"""Broken and odd missions and plans by the hundred: the command never crashes, and what it plans the judge admits.

In-process, with warnings as errors: a warning of NumPy on standard error is nothing that a user can use.
"""

import io
import json
import math
import re
from contextlib import redirect_stderr, redirect_stdout

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from tests.mission.strategies import examples, missions, plain_words, tiny_missions

from muster.cli.main import run
from muster.library import mission_path
from muster.mission.plan import Plan, Route
from muster.mission.yaml_writer import plain, yaml_text

SHIPPED = [mission_path(name).read_text(encoding="utf-8") for name in ("6T-2R", "11T-2R", "market-rescue", "auction-1")]
EXTREMES = (
    *(None, True, False, 0, -1, 1, 3, 0.5, -0.0, 1e-320, 5e-324, 1e154, 1e155, 1e300, 1.7e308, -1.7e308),
    *(math.nan, math.inf, -math.inf, 10**17, 10**18, 10**40, 10**400, -(10**400)),
    *("", " ", "x", "r_0", "0", "1", "tau", "total", "no", "matrix", "map", "a\nb", "\u2028", "é", "x" * 300, "%s{}"),
    *([], {}, [[]], [0, 0], [0, 0, 0], [1e308, -1e308], [None], {"x": 1}, [0, 1, 2, 3], ["r_0", "r_0"]),
)
SCRAPS = (
    *("\t", "\n", " ", "  ", "\r", "\x00", "\x07", "\x85", "\u2028", "\ufeff", "é", "\U0001f916", "\ue000"),
    *(
        ":",
        ": ",
        "-",
        "- ",
        "#",
        ",",
        "'",
        '"',
        "{",
        "}",
        "[",
        "]",
        "&a ",
        "*a ",
        "!!str ",
        "!x ",
        "%",
        "@",
        "|",
        ">",
        "?",
    ),
    *(
        ".nan",
        ".inf",
        "1e309",
        "1e308",
        "9" * 50,
        "9" * 5000,
        "-",
        "0x",
        "0o7",
        "~",
        "null",
        "true",
        "<<: ",
        "---\n",
        "...",
    ),
    *("\nrobots:", "\ntasks:", "\nrules: {travel: matrix}", "\nmap: {ros_yaml: x}", "[" * 300, "{a: " * 60),
)


def muster(*arguments):
    """The command's exit code, standard output and standard error; as strict about text as real streams are."""
    out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8", newline="")
    err = io.TextIOWrapper(io.BytesIO(), encoding="utf-8", errors="backslashreplace", newline="")
    with redirect_stdout(out), redirect_stderr(err):
        code = run([str(argument) for argument in arguments])
    out.flush()
    err.flush()
    return code, out.buffer.getvalue().decode(), _without_notes(err.buffer.getvalue().decode())


def _without_notes(err):
    """Standard error without the lines on what of an instance file is not read."""
    lines = err.splitlines(keepends=True)
    return "".join(line for line in lines if not re.fullmatch(r"\S+: passed over: .*: it \w.*\n", line))


def is_a_message(err):
    """Every line tells a place and what was expected; none is from the inside of the program."""
    return err != "" and "Traceback" not in err and "internal error" not in err and "Warning" not in err


def only_warns(err):
    """Nothing is said but that the plan was made with rules ignored that hold here."""
    return all(re.match(r"warning: \S+: ignored: .*; expected ", line) for line in err.splitlines())


def survives(folder, *arguments):
    """Check and plan a mission that may be broken in any way; what comes out must hold together."""
    code, out, err = muster("check", *arguments)
    if code == 2:
        assert out == ""
        assert is_a_message(err)
    else:
        assert code in (0, 3)
        assert ("can never be done" in out) == (code == 3)
        assert all(re.fullmatch(r"warning: robots .* apart, and touch below .*", line) for line in err.splitlines())
    json_code, out, err = muster("check", *arguments, "--format", "json")
    assert (json_code, err) == (code, "")
    assert bool(json.loads(out)["errors"]) == (code == 2)

    code_of_solve, out, err = muster("solve", *arguments, "--iterations", 5, "--format", "json")
    if code == 2 or code_of_solve == 2:
        assert code_of_solve == 2
        assert out == ""
        assert is_a_message(err)
        return
    assert (code_of_solve, err) == (0, "")
    plan = folder / "plan.json"
    plan.write_text(out, encoding="utf-8")
    verdict = muster("verify", *arguments, plan, "--format", "json")
    assert (verdict[0], verdict[2]) == (0, "")
    assert json.loads(verdict[1])["valid"] is True
    complete = json.loads(out)["unassigned"] == []
    assert muster("solve", *arguments, "--iterations", 5, "--require-complete")[0] == (0 if complete else 3)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


# --- mutations -------------------------------------------------------------------------------------------------------

share = st.floats(0, 1)
scraps = st.sampled_from(SCRAPS)
changes = st.lists(st.tuples(st.integers(0, 7), share, share, scraps), min_size=1, max_size=3)


def cut(text, begin, end):
    """Two places in a text, in order and not far from each other."""
    first = int(begin * len(text))
    return first, min(len(text), first + 1 + int(end * 20))


def changed(text: bytes, change) -> bytes:
    """A text with one change: something deleted, doubled, swapped, inserted, or another byte."""
    kind, begin, end, scrap = change
    first, last = cut(text, begin, end)
    lines = text.splitlines(keepends=True)
    one, other = (min(int(place * len(lines)), len(lines) - 1) for place in (begin, end))
    if kind == 0 or not lines:
        return text[:first] + text[last:]
    if kind == 1:
        return text[:last] + text[first:]
    if kind == 2:
        return text[:first] + scrap.encode() + text[first:]
    if kind == 3:
        return text[:first] + scrap.encode() + text[last:]
    if kind == 4:
        return b"".join(lines[:one] + lines[one + 1 :])
    if kind == 5:
        return b"".join(lines[: one + 1] + lines[one:])
    if kind == 6:
        lines[one], lines[other] = lines[other], lines[one]
        return b"".join(lines)
    return text[:first] + bytes([int(end * 255)]) + text[last:]


def all_changed(text: str, some) -> bytes:
    data = text.encode()
    for change in some:
        data = changed(data, change)
    return data


def places(data, at=()):
    """The path of every value in plain data."""
    yield at
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        yield from places(value, (*at, key))


def replaced(data, path, value):
    if not path:
        return value
    copy = dict(data) if isinstance(data, dict) else list(data)
    copy[path[0]] = replaced(copy[path[0]], path[1:], value)
    return copy


def flow(data):
    """Plain data in YAML's flow style, which also has a word for what is no finite number."""
    if isinstance(data, dict):
        return "{" + ", ".join(f"{json.dumps(key)}: {flow(value)}" for key, value in data.items()) + "}"
    if isinstance(data, list):
        return "[" + ", ".join(map(flow, data)) + "]"
    if isinstance(data, float) and not math.isfinite(data):
        return ".nan" if math.isnan(data) else ".inf" if data > 0 else "-.inf"
    return json.dumps(data)


def edges(mission):
    """A mission as plain data with every key that has an extreme worth a try, so that one replacement reaches it."""
    return {"schema": "muster/1", "rules": {}, "events": []} | plain(mission)


# --- missions --------------------------------------------------------------------------------------------------------


@pytest.mark.long
@examples(75)
@given(mission=st.one_of(tiny_missions(tabled=False), missions()))
def test_valid_missions(folder, mission):
    path = folder / "mission.yaml"
    path.write_text(yaml_text(mission), encoding="utf-8")
    survives(folder, path)


@examples(100)
@given(text=st.one_of(st.sampled_from(SHIPPED), tiny_missions(tabled=False).map(yaml_text)), some=changes)
def test_changed_text(folder, text, some):
    path = folder / "mission.yaml"
    path.write_bytes(all_changed(text, some))
    survives(folder, path)


@pytest.mark.long
@examples(100)
@given(
    mission=st.one_of(tiny_missions(tabled=False), missions()),
    some=st.lists(st.tuples(share, st.sampled_from(EXTREMES)), min_size=1, max_size=3),
)
def test_changed_values(folder, mission, some):
    data = edges(mission)
    for place, value in some:
        paths = list(places(data))
        data = replaced(data, paths[min(int(place * len(paths)), len(paths) - 1)], value)
    path = folder / "mission.yaml"
    path.write_text(flow(data), encoding="utf-8")
    survives(folder, path)


@examples(30)
@given(data=st.binary(max_size=200))
@example(data=b"")
@example(data=b"\xff\xfe\x00")
@example(data=b"&a [*a]")
@example(data=b"? ? ?")
@example(data=b"%YAML 9.9\n---\n")
def test_any_bytes(folder, data):
    for name in ("mission.yaml", "places.tsp"):
        (folder / name).write_bytes(data)
        arguments = (folder / name, *(["--salesmen", "2"] if name.endswith("tsp") else []))
        survives(folder, *arguments)


NUMBERS = (0.0, 1e-320, 1e150, 1e154, 1e300, 1.7e308)
MISSION = """\
schema: muster/1
rules: {{objective: {objective}, usage: {usage}, return_to_start: true}}
robots:
  - {{id: r_0, position: [0, 0], speed_mps: {speed}}}
  - {{id: r_1, position: [{far}, 0], efficiency: {speed}}}
tasks:
  - {{id: 1, position: [-{far}, {far}], actuation_cost: {cost}}}
  - {{id: 2, position: [1, 1], duration_s: {cost}, priority: {weight}}}
  - {{id: 3, position: [2, 1], priority: {weight}}}
"""


@examples(40)
@given(
    objective=st.sampled_from(["total", "max", "total+max", "average", "makespan"]),
    usage=st.sampled_from(["distance", "time"]),
    speed=st.sampled_from(NUMBERS[1:]),
    far=st.sampled_from(NUMBERS),
    cost=st.sampled_from(NUMBERS),
    weight=st.sampled_from(NUMBERS[1:]),
)
def test_numbers_near_the_ends_of_float64(folder, objective, usage, speed, far, cost, weight):
    path = folder / "mission.yaml"
    text = MISSION.format(objective=objective, usage=usage, speed=speed, far=far, cost=cost, weight=weight)
    path.write_text(text, encoding="utf-8")
    survives(folder, path)


TASKS = 'index,x,y,type,actuation_cost,prerequisites\n1,4,5,D,0,[]\n2,6,1,E,12,[1]\n3,7,2,D,0,"[1,2]"\n4,1,1,E,,1 3\n'
ROBOTS = "id,type,x,y,work_capacity\nr_0,beta,0,0,50\nr_1,tau,2,0,inf\n"
TABLE = "robot_type,D,E\nbeta,0.9,0.7\ntau,0.5,0.9\n"


@examples(50)
@given(which=st.integers(0, 2), some=changes)
def test_changed_csv(folder, which, some):
    texts = [TASKS.encode(), ROBOTS.encode(), TABLE.encode()]
    texts[which] = all_changed(texts[which].decode(), some)
    files = [folder / name for name in ("tasks.csv", "robots.csv", "suitability.csv")]
    for file, text in zip(files, texts, strict=True):
        file.write_bytes(text)
    survives(folder, files[0], "--robots", files[1], "--suitability", files[2])


TSPLIB = """\
NAME : five
TYPE : TSP
DIMENSION : 5
EDGE_WEIGHT_TYPE : EUC_2D
NODE_COORD_SECTION
1 37 52
2 49 49
3 52 64
4 20 26
5 40 30
EOF
"""


@examples(40)
@given(some=changes, depot=st.sampled_from(["1", "3", "9", "x", ""]))
def test_changed_tsplib(folder, some, depot):
    path = folder / "places.tsp"
    path.write_bytes(all_changed(TSPLIB, some))
    survives(folder, path, "--salesmen", 2, "--depot", depot)


MATRIX = """\
schema: muster/1
rules: {travel: matrix}
travel: {beta: beta.csv}
robots:
  - {id: r_0, type: beta, position: [0, 0]}
  - {id: r_1, type: beta, position: [0, 1], skills: [camera], return_to_start: true}
tasks:
  - {id: 1, position: [4, 5], requires: [camera]}
  - {id: 2, position: [4, 5], prerequisites: [1]}
"""
WAYS = "from,r_0,r_1,1,2\nr_0,0,1,2,inf\nr_1,1,0,3,4.5\n1,2,3,0,1e3\n2,inf,4.5,1e3,0\n"


@examples(40)
@given(some=changes, in_table=st.sampled_from([True, True, False]))
def test_changed_travel_table(folder, some, in_table):
    (folder / "beta.csv").write_bytes(all_changed(WAYS, some if in_table else []))
    (folder / "matrix.yaml").write_bytes(all_changed(MATRIX, [] if in_table else some))
    survives(folder, folder / "matrix.yaml")


# --- plans -----------------------------------------------------------------------------------------------------------


def judged(folder, mission, plan):
    """Verify, explain and go on from a plan that may be broken in any way."""
    code, out, err = muster("verify", mission, plan)
    assert code in (0, 1, 2)
    assert (is_a_message(err) and out == "") if code == 2 else only_warns(err)
    json_code, out, err = muster("verify", mission, plan, "--format", "json")
    assert json_code == code
    assert code == 2 or json.loads(out)["valid"] is (code == 0)
    for form in ("table", "json"):
        for task in ((), ("--task", "3")):
            code, out, err = muster("explain", mission, plan, "--format", form, *task)
            assert code in (0, 2)
            assert is_a_message(err) if code == 2 else only_warns(err)
    code, out, err = muster("solve", mission, "--start", plan, "--iterations", 2, "--format", "json")
    assert code in (0, 2)
    if code == 2:
        assert is_a_message(err)
    else:
        (folder / "next.json").write_text(out, encoding="utf-8")
        assert muster("verify", mission, folder / "next.json")[0] == 0


@pytest.fixture(scope="module")
def solved(folder):
    """A mission and the text of its plan."""
    mission = folder / "11T-2R.yaml"
    mission.write_text(mission_path("11T-2R").read_text(encoding="utf-8"), encoding="utf-8")
    return mission, muster("solve", mission, "--iterations", 5, "--format", "json")[1]


@pytest.mark.long
@examples(60)
@given(some=changes)
def test_changed_plan_text(folder, solved, some):
    mission, text = solved
    plan = folder / "plan.json"
    plan.write_bytes(all_changed(text, some))
    judged(folder, mission, plan)


@examples(60)
@given(some=st.lists(st.tuples(share, st.sampled_from(EXTREMES)), min_size=1, max_size=3))
def test_changed_plan_values(folder, solved, some):
    mission, text = solved
    data = json.loads(text)
    for place, value in some:
        paths = list(places(data))
        data = replaced(data, paths[min(int(place * len(paths)), len(paths) - 1)], value)
    plan = folder / "plan.json"
    plan.write_text(json.dumps(data), encoding="utf-8")
    judged(folder, mission, plan)


ids = st.sampled_from([str(k) for k in range(11)]) | plain_words


@pytest.mark.long
@examples(50)
@given(
    routes=st.lists(
        st.builds(Route, st.sampled_from(["r_0", "r_1", "R0", "R1", "r_9"]), st.lists(ids, max_size=6).map(tuple)),
        max_size=3,
    ),
    ignored=st.lists(st.sampled_from(["prerequisites", "suitability", "skills", "capacity"]), unique=True).map(tuple),
)
def test_any_routes(folder, solved, routes, ignored):
    plan = folder / "plan.json"
    Plan(routes=tuple(routes), ignored=ignored).save(plan)
    judged(folder, solved[0], plan)
