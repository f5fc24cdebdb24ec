"""`muster path --joint`: figures, files and faults of MovingAI instances, and paths on a mission's roadmap."""

import json

import pytest

MAP = "type octile\nheight 2\nwidth 5\nmap\n@.@@@\n.....\n"
SWAP = "version 1\n0\ta.map\t5\t2\t0\t1\t4\t1\t4\n0\ta.map\t5\t2\t4\t1\t0\t1\t4\n"
YARD = """
schema: muster/1
name: yard
map: {boundary: [[0, 0], [10, 0], [10, 10], [0, 10]]}
robots:
  - {id: a, position: [1, 1], radius_m: 0.3}
  - {id: b, position: [9, 9], radius_m: 0.3}
tasks:
  - {id: t, position: [9, 1]}
"""


@pytest.fixture
def swap(tmp_path):
    (tmp_path / "a.map").write_text(MAP)
    (tmp_path / "a.scen").write_text(SWAP)
    return [str(tmp_path / "a.map"), "--joint", "--scenario", str(tmp_path / "a.scen"), "--expansions", "200"]


def test_two_that_change_places(muster, swap, tmp_path):
    code, out, err = muster("path", *swap, "--format", "json", "-o", str(tmp_path / "paths.txt"))
    assert (code, err) == (0, "")
    figures = json.loads(out)
    assert (figures["agents"], figures["lower_bound"], figures["sum_of_costs"]) == (2, 8, 11)
    lines = (tmp_path / "paths.txt").read_text().splitlines()
    assert {"agents=2", "soc=11", "soc_lb=8", "starts=(0,1),(4,1),", "goals=(4,1),(0,1),"} <= set(lines)
    assert lines[lines.index("solution=") + 1] == "0:(0,1),(4,1),"
    assert len(lines) - lines.index("solution=") - 2 == figures["steps"]


def test_paths_as_json(muster, swap, tmp_path):
    muster("path", *swap, "-o", str(tmp_path / "paths.json"))
    robots = json.loads((tmp_path / "paths.json").read_text())["robots"]
    assert [(robot["points"][0], robot["points"][-1]) for robot in robots] == [([0, 1], [4, 1]), ([4, 1], [0, 1])]


def test_the_first_robots_and_a_proof(muster, swap, tmp_path):
    assert "1 robot, seed 0" in muster("path", *swap, "--agents", "1")[1]
    (tmp_path / "a.map").write_text(MAP.replace("@.@@@", "@@@@@"))
    code, out, _ = muster("path", *swap)
    assert (code, out) == (0, "no paths: all 10 configurations that can be reached were seen; proven\n")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("\t4\t1\t0\t1\t4", "\t9\t1\t0\t1\t4"), "a.scen:3: start: x 9, y 1; expected a free cell of the map, 5 x 2"),
        (("\t4\t1\t0\t1\t4", "\t0\t0\t0\t1\t4"), "a.scen:3: start: x 0, y 0; expected a free cell"),
        (("\t4\t1\t0\t1\t4", "\t0\t1\t0\t1\t4"), "a.scen:3: start: x 0, y 1; expected a cell that no other robot has"),
        (("\t4\t1\t0\t1\t4", "\t4\t1\tx\t1\t4"), "a.scen:3: "),
    ],
)
def test_scenarios_that_do_not_fit(muster, swap, tmp_path, change, message):
    (tmp_path / "a.scen").write_text(SWAP.replace(*change))
    code, out, err = muster("path", *swap)
    assert (code, out) == (2, "")
    assert message in err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--joint", "--agents", "3"], "--agents: 3; expected at most 2"),
        (["--agents", "1"], "--agents: 1; expected --joint beside it"),
    ],
)
def test_options_that_do_not_fit(muster, swap, arguments, message):
    rest = swap if "--joint" in arguments else [swap[0]]
    code, _, err = muster("path", *rest, *[one for one in arguments if one != "--joint"])
    assert code == 2
    assert message in err


def test_on_the_roadmap_of_a_mission(muster, tmp_path):
    (tmp_path / "yard.yaml").write_text(YARD)
    goals = ["--together", "a=9,9", "--together", "b=1,1"]
    code, out, err = muster(
        "path", str(tmp_path / "yard.yaml"), "--joint", *goals, "--expansions", "50", "--format", "json"
    )
    assert (code, err) == (0, "")
    figures = json.loads(out)
    assert figures["sum_of_costs"] >= figures["lower_bound"] > 0
    code, _, err = muster("path", str(tmp_path / "yard.yaml"), "--joint", *goals[:3], "b=9,9")
    assert code == 2
    assert "the goal of b and that of a are nearest to the same point, (" in err
