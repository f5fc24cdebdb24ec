"""`muster traffic`: the figures of a roadmap, its picture, and what it warns of."""

import json

import pytest

AISLES = """\
schema: muster/1
name: aisles
map:
  boundary: [[0, 0], [8, 0], [8, 10], [0, 10]]
  zones:
    - {polygon: [[0, 3], [2, 3], [2, 10], [0, 10]]}
    - {polygon: [[2.9, 3], [5, 3], [5, 10], [2.9, 10]]}
    - {polygon: [[5.9, 3], [8, 3], [8, 10], [5.9, 10]]}
robots:
  - {id: cart, position: [1, 1], radius_m: 0.3}
  - {id: drone, position: [7, 1], kind: air, radius_m: 1}
tasks:
  - {id: a, position: [2.45, 8]}
  - {id: b, position: [0.1, 1]}
"""
LANES = """\
schema: muster/1
name: lanes
lanes:
  nodes: {dock: [0, 0], gate: [5, 0], rack: [9, 3]}
  edges:
    - {from: dock, to: gate, both_ways: true, capacity: 1}
    - {from: gate, to: rack, capacity: 1}
    - {from: rack, to: dock, width_m: 0.5}
robots: [{id: r_0, position: [0, 0], radius_m: 0.3}]
tasks: []
"""


@pytest.fixture
def aisles(tmp_path):
    file = tmp_path / "aisles.yaml"
    file.write_text(AISLES, encoding="utf-8")
    return file


@pytest.fixture
def lanes(tmp_path):
    file = tmp_path / "lanes.yaml"
    file.write_text(LANES, encoding="utf-8")
    return file


def test_the_figures_of_a_roadmap(muster, aisles):
    code, out, _ = muster("traffic", aisles, "--format", "json")
    figures = json.loads(out)
    assert code == 0
    assert (figures["radius_m"], figures["margin_m"]) == (0.3, 0.02)
    assert (figures["passages_for_one"], figures["dead_ends"], figures["one_way"]) == (2, 2, 0)
    assert figures["points"] > figures["holding_places"] > 0
    assert figures["edges"] % 2 == 0
    assert figures["places_without_a_way"] == [[0.1, 1]]


def test_a_wider_margin_thins_the_lattice(muster, aisles):
    def points(margin):
        return json.loads(muster("traffic", aisles, "--margin", margin, "--format", "json")[1])["points"]

    assert points(0.5) < points(0.02)


def test_the_table_says_the_same(muster, aisles):
    code, out, err = muster("traffic", aisles)
    assert code == 0
    assert ["passages", "for", "one", "2"] in [line.split() for line in out.splitlines()]
    assert "aisles: 1 robot, radius 0.3 m, margin 0.02 m;" in out
    assert err == "warning: no way for radius 0.3 m leads to (0.1, 1)\n"
    assert muster("traffic", aisles, "-q")[2] == ""


def test_lanes_that_are_left_out_are_named(muster, lanes):
    code, out, err = muster("traffic", lanes, "--format", "json")
    figures = json.loads(out)
    assert code == 0
    assert (figures["edges"], figures["one_way"], figures["length_m"]) == (3, 1, 10.0)
    assert figures["lanes_left_out"] == [2]
    assert err == "warning: lanes.edges[2]: 0.5 m wide, diameter 0.6 m; the lane is left out\n"


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("suffix", [".png", ".svg"])
def test_the_picture_is_written(muster, aisles, tmp_path, suffix):
    file = tmp_path / f"roadmap{suffix}"
    assert muster("traffic", aisles, "--plot", file)[0] == 0
    assert file.stat().st_size > 10_000


def test_robots_without_a_radius_are_refused(muster, tmp_path):
    file = tmp_path / "points.yaml"
    file.write_text(AISLES.replace(", radius_m: 0.3", ""), encoding="utf-8")
    code, _, err = muster("traffic", file)
    assert code == 2
    assert "radius_m: 0 for all robots; expected a robot with a radius above 0" in err


DOOR = """\
schema: muster/1
name: door
rules: {travel: map}
map:
  boundary: [[-6, -3], [6, -3], [6, 3], [-6, 3]]
  zones:
    - {polygon: [[-0.2, -3], [0.2, -3], [0.2, -0.45], [-0.2, -0.45]]}
    - {polygon: [[-0.2, 0.45], [0.2, 0.45], [0.2, 3], [-0.2, 3]]}
robots:
  - {id: r_0, position: [-2, 0], radius_m: 0.3}
  - {id: r_1, position: [2, 0], radius_m: 0.3}
tasks:
  - {id: east, position: [5, 0], only_robots: [r_0]}
  - {id: west, position: [-5, 0], only_robots: [r_1]}
"""


def test_the_traffic_of_a_plan_is_forecast(muster, tmp_path):
    door, plan = tmp_path / "door.yaml", tmp_path / "plan.json"
    door.write_text(DOOR, encoding="utf-8")
    assert muster("solve", door, "-a", "greedy", "-q", "-o", plan)[0] == 0
    code, out, _ = muster("traffic", door, "--plan", plan, "--format", "json")
    robots = json.loads(out)["plan"]["robots"]
    assert code == 0
    assert [row["alone_s"] for row in robots] == pytest.approx([7.0, 7.0], abs=0.5)
    first, second = sorted(row["with_traffic_s"] for row in robots)
    assert first == pytest.approx(7.0, abs=0.5)
    assert second > 8.5
    assert f"time with traffic {second:.2f} s" in muster("traffic", door, "--plan", plan)[1]


def test_a_plan_that_breaks_rules_is_not_forecast(muster, tmp_path):
    door, plan = tmp_path / "door.yaml", tmp_path / "plan.json"
    door.write_text(DOOR, encoding="utf-8")
    routes = [{"robot": "r_0", "tasks": ["west"]}, {"robot": "r_1", "tasks": ["east"]}]
    plan.write_text(json.dumps({"schema": "muster-plan/1", "routes": routes}), encoding="utf-8")
    code, _, err = muster("traffic", door, "--plan", plan)
    assert code == 2
    assert "the judge rejects this plan" in err


def test_the_traffic_of_drones_is_not_forecast(muster, tmp_path):
    air, plan = tmp_path / "air.yaml", tmp_path / "plan.json"
    air.write_text(DOOR.replace("radius_m: 0.3", "radius_m: 0.3, kind: air"), encoding="utf-8")
    assert muster("solve", air, "-a", "greedy", "-q", "-o", plan)[0] == 0
    code, _, err = muster("traffic", air, "--plan", plan)
    assert code == 2
    assert "no robot is of kind ground with a radius above 0" in err
