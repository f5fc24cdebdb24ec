"""`muster check`: tasks that no plan does together."""

import json
import math
from itertools import combinations
from pathlib import Path
from random import Random

import pytest
from tests.cli.yard import FOUND

from muster.cli.verbs.check import _touching
from muster.mission.model import Robot
from muster.mission.system.clock import ProcessorClock

pytestmark = pytest.mark.usefixtures("folder", "processor_time")


@pytest.fixture
def processor_time(monkeypatch):
    """What else the machine does takes nothing from the time in which conflicts are looked for."""
    monkeypatch.setattr("muster.allocation.remedies.conflicts.SystemClock", ProcessorClock)


TWO = """\
schema: muster/1
name: two
robots:
  - {id: r_0, position: [0, 0], work_capacity: CAPACITY}
tasks:
  - {id: west, position: [-40, 0]}
  - {id: near, position: [1, 0]}
  - {id: east, position: [40, 0]}
"""
CHAIN = """\
schema: muster/1
name: chain
robots:
  - {id: r_0, position: [0, 0], work_capacity: 10}
tasks:
  - {id: first, position: [4, 0]}
  - {id: then, position: [-4, 0], prerequisites: [first]}
"""
RING = """\
schema: muster/1
name: ring
rules: {return_to_start: true}
robots:
  - {id: r_0, position: [0, 0], work_capacity: 79}
tasks:
""" + "".join(
    f"  - {{id: {k}, position: [{x}, {y}]}}\n"
    for k, (x, y) in enumerate(
        (sx * x, sy * y)
        for sx in (1, -1)
        for sy in (1, -1)
        for x, y in [(9.877, 1.564), (8.910, 4.540), (7.071, 7.071), (4.540, 8.910), (1.564, 9.877)]
    )
)


def write(text, capacity=60):
    Path("m.yaml").write_text(text.replace("CAPACITY", str(capacity)), encoding="utf-8")
    return "m.yaml"


def test_tasks_that_no_plan_does_together(muster):
    assert muster("check", write(TWO)) == (
        0,
        "two: 1 robot, 3 tasks; no errors\n"
        "no plan can do all of these 2 tasks (proven): west, east\n"
        "  only r_0 can do them, and would use at least 120.00 m, of 60.00 m\n"
        "  without any one of them a plan was found that does the others\n",
        "",
    )


def test_in_json(muster):
    code, out, err = muster("check", write(TWO), "--format", "json")
    assert (code, err) == (0, "")
    assert json.loads(out) == {
        "errors": [],
        "impossible": [],
        "conflict": {
            "tasks": ["west", "east"],
            "prerequisites": [],
            "robots": ["r_0"],
            "detail": "only r_0 can do them, and would use at least 120.00 m, of 60.00 m",
            "minimal": True,
            "proven": True,
        },
        "unknown": False,
        "shortfalls": [],
        "remedies": [],
        "unseen": [],
        "blocked": [],
        "cut_off": [],
    }


def test_a_task_too_far_behind_its_prerequisite(muster):
    out = muster("check", write(CHAIN))[1]
    assert out.splitlines()[1:] == [
        "no plan can do task then, with first before (proven)",
        "  only r_0 can do them, and would use at least 12.00 m, of 10.00 m",
    ]
    assert "tasks (proven): first, then\n" in muster("check", "m.yaml", "--ignore", "prerequisites")[1]


def test_when_all_can_be_done(muster):
    assert muster("check", write(TWO, 120)) == (
        0,
        "two: 1 robot, 3 tasks; no errors\n" + FOUND,
        "",
    )
    answer = json.loads(muster("check", "m.yaml", "--format", "json")[1])
    nothing = {
        "errors": [],
        "impossible": [],
        "conflict": None,
        "unknown": False,
        "shortfalls": [],
        "remedies": [],
        "unseen": [],
        "blocked": [],
        "cut_off": [],
    }
    assert answer == nothing


@pytest.mark.parametrize(("capacity", "code"), [(60, 3), (120, 0)])
def test_require_complete(capacity, code, muster):
    assert muster("check", write(TWO, capacity), "--require-complete")[0] == code
    assert muster("check", "m.yaml", "--require-complete", "--ignore", "capacity")[0] == 0


def test_what_is_not_known(muster):
    code, out, err = muster("check", write(RING), "--time-limit", "0.1", "--require-complete")
    assert (code, err) == (0, "")
    assert out.splitlines()[1:] == ["no plan for all tasks was found; none was proven impossible"]
    assert json.loads(muster("check", "m.yaml", "--time-limit", "0.1", "--format", "json")[1])["unknown"] is True


DOCK = """\
schema: muster/1
map: {boundary: [[-10, -10], [30, -10], [30, 10], [-10, 10]], zones: [{polygon: [[4, 4], [8, 4], [8, 8], [4, 8]]}]}
robots: [{id: r, position: [0, 0], radius_m: 0.3, battery: {capacity: 100}}]
stations: [{id: dock, position: PLACE, services: [charge], charge_per_s: 1}]
tasks: [{id: a, position: [20, 0]}]
"""


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    ("place", "why"),
    [
        ("[6, 6]", "inside zone 0"), ("[500, 0]", "outside the boundary"),
        ("[3.9, 6]", "0.1 m from zone 0, radius 0.3 m"), ("[9, 0]", None),
    ],
)  # fmt: skip
def test_a_station_that_no_robot_gets_to(muster, place, why):
    code, _, err = muster("check", write(DOCK.replace("PLACE", place)))
    assert (code, err) == (0, f"warning: station dock: no robot gets there: {why}\n" if why else "")
    found = json.loads(muster("check", "m.yaml", "--format", "json")[1])["cut_off"]
    assert found == ([{"station": "dock", "detail": why}] if why else [])


def test_no_time(muster):
    """Nothing is said that is not known."""
    code, out, err = muster("check", write(TWO), "--time-limit", "0")
    assert (code, err) == (0, "")
    assert out.splitlines()[1:] == ["no plan for all tasks was found; none was proven impossible"]


def test_errors_in_json_have_all_keys(muster):
    code, out, err = muster("check", write("schema: muster/1\n"), "--format", "json")
    assert (code, err) == (2, "")
    keys = ["errors", "impossible", "conflict", "unknown", "shortfalls", "remedies", "unseen", "blocked", "cut_off"]
    assert list(json.loads(out)) == keys


SEARCH = """\
schema: muster/1
name: search
robots:
  - {id: low, position: [0, 0], kind: air, camera: {fov_deg: 60, tilt_deg: 90}}
  - {id: wide, position: [1, 0], kind: air, camera: {fov_deg: 100, tilt_deg: 90}}
  - {id: blind, position: [2, 0]}
tasks:
  - {id: field, position: [9, 9], action: {name: raster-search, side_m: 4, height_m: 2, SPACING}ONLY}
"""


def searched(spacing, only=""):
    return SEARCH.replace("SPACING", spacing).replace("ONLY", only)


def test_a_search_that_no_robot_sees_all_of_is_an_error(muster):
    Path("search.yaml").write_text(searched("spacing_m: 9"), encoding="utf-8")
    code, out, err = muster("check", "search.yaml", "--format", "json")
    assert code == 2
    found = json.loads(out)
    (error,) = found["errors"]
    assert (error["field"], error["line"]) == ("tasks[0].action.spacing_m", 8)
    assert error["value"].startswith("9 (low sees 2.31 m across its lanes")
    assert error["expected"] == "no spacing_m: lanes follow from the camera then, 2.08 m apart or less"
    assert [(one["task"], one["robot"], one["never_seen"]) for one in found["unseen"]] == [
        ("field", "low", True), ("field", "wide", True),
    ]  # fmt: skip
    code, out, err = muster("check", "search.yaml")
    assert code == 2
    assert "; 1 error" in out
    assert "search.yaml:8: tasks[0].action.spacing_m" in err


def test_a_search_that_some_robots_see_all_of_is_a_warning(muster):
    Path("search.yaml").write_text(searched("spacing_m: 3.2"), encoding="utf-8")
    code, out, err = muster("check", "search.yaml")
    assert code == 0
    assert "no errors" in out
    assert "warning: task field: low sees 2.31 m across its lanes" in err
    assert "wide" not in err
    code, out, err = muster("solve", "search.yaml", "--iterations", "50", "--ignore", "skills")
    assert code == 0


def test_a_robot_that_may_not_do_it_does_not_count(muster):
    Path("search.yaml").write_text(searched("spacing_m: 3.2", ", only_robots: [low]"), encoding="utf-8")
    assert muster("check", "search.yaml")[0] == 2
    code, _, err = muster("solve", "search.yaml", "--iterations", "50")
    assert code == 0
    assert "warning: task field: spacing_m 3.2: low sees 2.31 m" in err
    Path("search.yaml").write_text(searched("spacing_m: 9", ", only_robots: [blind]"), encoding="utf-8")
    assert muster("check", "search.yaml")[0] == 0


def test_without_a_spacing_all_is_seen(muster):
    Path("search.yaml").write_text(searched("overlap: 0.2", ", only_robots: [low, wide]"), encoding="utf-8")
    code, out, err = muster("check", "search.yaml")
    assert (code, err) == (0, "")
    assert "no errors" in out
    Path("search.yaml").write_text(searched("overlap: 0.2", ", only_robots: [blind]"), encoding="utf-8")
    code, out, err = muster("check", "search.yaml")
    assert "it has no camera from which the distance of lanes follows" in " ".join(out.split())


def test_a_robot_that_would_have_to_do_more_tasks_than_there_are_is_a_warning(muster):
    text = TWO.replace("CAPACITY}", "200, min_tasks: 4}\n  - {id: r_1, position: [2, 0], min_tasks: 3}")
    Path("two.yaml").write_text(text, encoding="utf-8")
    code, out, err = muster("check", "two.yaml")
    assert code == 0
    assert "no errors" in out
    assert err.splitlines() == ["warning: robot r_0: min_tasks 4, and the mission has 3 tasks: it does none"]
    assert "min_tasks" not in muster("check", "two.yaml", "--ignore", "min-tasks")[2]


def test_robots_that_touch_where_they_start_are_a_warning(muster):
    others = "\n  - {id: r_1, position: [2, 0], radius_m: 0.3}\n  - {id: r_2, position: [2, 0.5], radius_m: 0.3}"
    bodies = "200, radius_m: 0.3}" + others
    Path("two.yaml").write_text(TWO.replace("CAPACITY}", bodies), encoding="utf-8")
    code, _, err = muster("check", "two.yaml")
    assert (code, err) == (0, "warning: robots r_1 and r_2 start 0.5 m apart, and touch below 0.6 m\n")
    Path("two.yaml").write_text(TWO.replace("CAPACITY}", bodies.replace("[2, 0.5]", "[2, 0]")), encoding="utf-8")
    assert "start 0 m apart" in muster("check", "two.yaml")[2]


SWAP = """\
schema: muster/1
name: swap
map: {boundary: [[0, 0], [10, 0], [10, 0.9], [0, 0.9]]}
robots:
  - {id: r_3, position: [1, 0.45], radius_m: 0.3}
  - {id: r_7, position: [9, 0.45], radius_m: 0.3}
tasks:
  - {id: a, position: [8, 0.45], only_robots: [r_3]}
  - {id: b, position: [0.4, 0.45], only_robots: [r_7]}
  - {id: c, position: [5, 0.45]}
"""
BAY = "[[0, 0], [10, 0], [10, 0.9], [6, 0.9], [6, 2.5], [4, 2.5], [4, 0.9], [0, 0.9]]"
ENDS = """\
schema: muster/1
name: ends
map: {boundary: [[0, 0], [10, 0], [10, 0.9], [0, 0.9]]}
rules: {return_to_start: false}
robots:
  - {id: r_3, position: [1, 0.45], radius_m: 0.3, end_position: [8, 0.45]}
  - {id: r_7, position: [9, 0.45], radius_m: 0.3, end_position: [1.5, 0.45]}
tasks:
  - {id: a, position: [2, 0.45], only_robots: [r_3]}
  - {id: b, position: [8, 0.45], only_robots: [r_7]}
"""
LANES = """\
schema: muster/1
name: lanes
lanes:
  nodes: {dock: [0, 0], gate: [5, 0], rack_1: [9, 3], rack_2: [9, -3]}
  edges:
    - {from: dock, to: gate, both_ways: true}
    - {from: gate, to: rack_1}
    - {from: rack_1, to: rack_2, capacity: 1}
    - {from: rack_2, to: gate, width_m: 0.5}
robots:
  - {id: r_0, position: [0, 0], radius_m: 0.3}
  - {id: r_1, position: [5, 0], radius_m: 0.3, return_to_start: true}
tasks: [{id: 1, position: [9, 3]}, {id: 2, position: [9, -3], only_robots: [r_1]}]
"""


def blocked(muster, text):
    return json.loads(muster("check", write(text), "--format", "json")[1])["blocked"]


def test_robots_that_must_swap_in_a_dead_end_are_named(muster):
    (one,) = blocked(muster, SWAP)
    assert (one["task"], one["robots"]) == ("b", ["r_7", "r_3"])
    assert one["detail"].startswith("r_7 and r_3 must swap in a dead end: r_7 cannot get to task b (")
    out = muster("check", "m.yaml")[1]
    assert "No traffic can get these done (proven on the roadmap)" in out
    assert " b " in out
    assert muster("check", "m.yaml", "--require-complete")[0] == 3


def test_a_bay_lets_them_pass(muster):
    assert blocked(muster, SWAP.replace("[[0, 0], [10, 0], [10, 0.9], [0, 0.9]]", BAY)) == []


def test_a_task_that_another_robot_can_do_as_well_is_not_named(muster):
    assert blocked(muster, SWAP.replace(", only_robots: [r_7]", "")) == []


def test_robots_that_cannot_be_at_their_ends_both_are_named(muster):
    """Each could be at its own end, were the other one elsewhere."""
    (one,) = blocked(muster, ENDS)
    assert (one["task"], sorted(one["robots"])) == (None, ["r_3", "r_7"])
    assert "they cannot be at the ends of their routes both" in one["detail"]
    assert blocked(muster, ENDS.replace("[8, 0.45]}", "[5, 0.45]}").replace("[1.5, 0.45]", "[9, 0.45]")) == []


def test_lanes_that_do_not_lead_where_robots_must_go_are_named(muster):
    (one,) = blocked(muster, LANES)
    assert (one["task"], one["robots"]) == ("2", ["r_1"])
    assert one["detail"] == "no lanes lead r_1 to task 2 and to the end of its route"
    assert blocked(muster, LANES.replace(", width_m: 0.5", "")) == []


@pytest.mark.parametrize("seed", range(20))
def test_robots_that_touch_are_found_among_all_pairs(seed):
    random = Random(seed)
    robots = [
        Robot(
            id=f"r_{k}",
            position=(random.choice((1.0, random.uniform(0, 3))), random.uniform(0, 3)),
            radius_m=random.choice((0.1, 0.3, 0.6)),
            kind=random.choice(("ground", "air")),
        )
        for k in range(12)
    ]
    pairs = [
        (a, b)
        for a, b in combinations(robots, 2)
        if a.kind == b.kind and math.dist(a.position, b.position) < a.radius_m + b.radius_m
    ]
    assert _touching(robots) == pairs


def test_too_much_work_is_said_first(tmp_path, monkeypatch, muster):
    """Before the tasks that can never be done, and before anything is searched for; `explain` says it too."""
    monkeypatch.chdir(tmp_path)
    Path("m.yaml").write_text(
        """schema: muster/1
name: crates
robots:
  - {id: r_0, position: [0, 0], available_until_s: 100}
  - {id: r_1, position: [5, 0], available_until_s: 100}
tasks:
  - {id: a, position: [1, 0], duration_s: 60}
  - {id: b, position: [2, 0], duration_s: 40, robots_needed: 2}
  - {id: c, position: [3, 0], duration_s: 70}
  - {id: d, position: [4, 0], requires: [wings]}
""",
        encoding="utf-8",
    )
    short = [
        "proven: 210 robot-seconds of work in 200 of shift: 10 robot-seconds short before any travel",
        "  least to add: 10 robot-seconds of shift, or 1 more robot; or leave out at least 1 task",
    ]
    assert muster("check", "m.yaml")[1].splitlines()[1:3] == short
    assert muster("check", "m.yaml", "--time-limit", "0")[1].splitlines()[1:3] == short
    assert muster("check", "m.yaml", "--require-complete")[0] == 3
    data = json.loads(muster("check", "m.yaml", "--format", "json")[1])
    assert (data["shortfalls"][0]["lacking"], data["unknown"]) == (10, False)
    muster("solve", "m.yaml", "--iterations", "50", "-o", "plan.json")
    assert muster("explain", "m.yaml", "plan.json")[1].splitlines()[:2] == short
    explained = json.loads(muster("explain", "m.yaml", "plan.json", "--format", "json")[1])
    assert explained["shortfalls"] == data["shortfalls"]
