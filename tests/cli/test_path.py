"""`muster path`: a way over the map of a mission."""

import csv
import json
import math
import re

import numpy as np
import pytest
import shapely

WALLED = """
schema: muster/1
name: walled
map:
  boundary: [[0, 0], [10, 0], [10, 10], [0, 10]]
  zones:
    - {polygon: [[4, 0], [6, 0], [6, 8], [4, 8]]}
    - {polygon: [[0, 9], [1, 9], [1, 10], [0, 10]], forbidden_to: [air]}
robots:
  - {id: rover, position: [1, 1], radius_m: 0.5}
  - {id: drone, position: [2, 2], kind: air, radius_m: 1.2}
tasks:
  - {id: a, position: [9, 1]}
"""


@pytest.fixture
def walled(tmp_path):
    file = tmp_path / "walled.yaml"
    file.write_text(WALLED, encoding="utf-8")
    return str(file)


def answer(muster, *arguments):
    code, out, err = muster("path", *arguments, "--format", "json")
    assert (code, err) == (0, "")
    return json.loads(out)


def test_the_shortest_way_bends_at_corners(muster, walled):
    found = answer(muster, walled, "--from", "1,1", "--to", "9,1")
    assert found["points"] == [[1, 1], [4, 8], [6, 8], [9, 1]]
    assert found["length_m"] == pytest.approx(2 * math.hypot(3, 7) + 2)


@pytest.mark.parametrize("planner", ["theta-star", "a-star", "dijkstra", "rrt-star"])
def test_other_planners_find_no_shorter_one(muster, walled, planner):
    shortest = answer(muster, walled, "--from", "1,1", "--to", "9,1", "--radius", "0.5")
    found = answer(muster, walled, "--from", "1,1", "--to", "9,1", "--radius", "0.5", "--planner", planner)
    assert (found["points"][0], found["points"][-1]) == ([1, 1], [9, 1])
    assert shortest["length_m"] <= found["length_m"] <= 1.15 * shortest["length_m"]


def test_radius_and_kind_of_a_robot(muster, walled):
    by_robot = answer(muster, walled, "--from", "2,2", "--to", "8,2", "--robot", "rover")
    assert by_robot == answer(muster, walled, "--from", "2,2", "--to", "8,2", "--radius", "0.5")
    assert by_robot["length_m"] > answer(muster, walled, "--from", "2,2", "--to", "8,2")["length_m"]
    assert answer(muster, walled, "--from", "2,2", "--to", "8,2", "--robot", "drone") == {
        "no_path": "disconnected: no free way leads from (2, 2) to (8, 2), radius 1.2 m"
    }


@pytest.mark.parametrize(
    ("ends", "reason"),
    [
        (("5,5", "9,1"), "start blocked: (5, 5): inside zone 0"),
        (("1,1", "5,5"), "goal blocked: (5, 5): inside zone 0"),
        (("1,1", "11,1"), "goal blocked: (11, 1): outside the boundary"),
    ],
)
def test_no_path_is_an_answer(muster, walled, ends, reason):
    assert answer(muster, walled, "--from", ends[0], "--to", ends[1]) == {"no_path": reason}
    code, out, err = muster("path", walled, "--from", ends[0], "--to", ends[1])
    assert (code, out, err) == (0, f"no path: {reason}\n", "")


def test_zones_hold_for_kinds(muster, walled):
    assert "points" in answer(muster, walled, "--from", "1,1", "--to", "0.5,9.5")
    assert "no_path" in answer(muster, walled, "--from", "1,1", "--to", "0.5,9.5", "--kind", "air")


def test_for_people(muster, walled):
    code, out, err = muster("path", walled, "--from", "1,1", "--to", "9,1")
    assert (code, err) == (0, "")
    assert out.splitlines()[-1] == "walled: 17.232 m in 3 straight pieces; shortest, ground, radius 0 m"


def test_smooth(muster, walled):
    """Longer than the path it rounds, through its points, and as far from walls."""
    straight = answer(muster, walled, "--from", "1,1", "--to", "9,1", "--radius", "0.5")
    found = answer(muster, walled, "--from", "1,1", "--to", "9,1", "--radius", "0.5", "--smooth")
    assert straight["length_m"] < found["length_m"] < 1.1 * straight["length_m"]
    assert all(point in found["points"] for point in straight["points"])
    assert found["max_curvature_per_m"] > 0
    wall = shapely.box(4, 0, 6, 8)
    assert shapely.LineString(found["points"]).distance(wall) >= 0.5 - 1e-9
    code, out, _ = muster("path", walled, "--from", "1,1", "--to", "9,1", "--smooth")
    assert code == 0
    assert out.startswith("walled: 17.")
    assert "greatest curvature" in out


def test_people_are_told_where_a_way_turns_and_programs_each_cell(muster, walled):
    found = answer(muster, walled, "--from", "1,1", "--to", "3,1", "--planner", "a-star")
    _, out, _ = muster("path", walled, "--from", "1,1", "--to", "3,1", "--planner", "a-star")
    pieces = int(re.search(r"in (\d+) straight pieces?", out)[1])
    assert len(found["points"]) > 50
    assert pieces < 8
    assert len([line for line in out.splitlines() if re.match(r" +\d", line)]) == pieces + 1


def test_in_the_air_over_a_wall(muster):
    found = answer(muster, "yard", "--from", "10,20,1", "--to", "20,20,1", "--kind", "air")
    assert found["length_m"] == pytest.approx(math.hypot(4, 3) + 0.5 + math.hypot(5.5, 3), rel=1e-6)
    around = answer(muster, "yard", "--from", "10,20,1", "--to", "20,20,1")
    assert around["length_m"] > found["length_m"]


def test_the_height_of_a_ground_robot_changes_evenly(muster):
    found = answer(muster, "yard", "--from", "3,3,0", "--to", "3,13,2")
    assert found["length_m"] == pytest.approx(math.hypot(10, 2))


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("planner", ["theta-star", "a-star", "dijkstra", "rrt-star"])
def test_so_it_does_by_other_planners(muster, planner, tmp_path):
    ends = ("yard", "--from", "3,3,0", "--to", "3,13,2", "--planner", planner)
    found = answer(muster, *ends, "--plot", tmp_path / "way.svg")
    assert found["points"][0] == [3, 3, 0]
    assert found["points"][-1] == [3, 13, 2]
    assert math.hypot(10, 2) - 1e-9 <= found["length_m"] < 12


def test_without_a_map_the_way_is_straight(muster):
    assert answer(muster, "31T-6R", "--from", "0,0", "--to", "3,4") == {"length_m": 5.0, "points": [[0, 0], [3, 4]]}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--from", "1", "--to", "9,1"), "--from: '1'; expected x,y, metres in the map frame"),
        (("--from", "1,1", "--to", "9,one"), "--to: '9,one'; expected x,y, metres in the map frame"),
        (("--from", "1,1", "--to", "nan,1"), "--to: 'nan,1'; expected x,y, metres in the map frame"),
        (("--from", "1,1,1", "--to", "9,1"), "--from: '1,1,1'; expected x,y, metres in the map frame"),
        (("--from", "1,1", "--to", "9,1", "--radius", "-1"), "--radius: -1; expected a finite number of at least 0"),
        (
            ("--from", "1,1", "--to", "9,1", "--robot", "rovr"),
            "--robot: 'rovr'; expected a robot of the mission; did you mean 'rover'?",
        ),
    ],
)
def test_bad_input(muster, walled, arguments, message):
    assert muster("path", walled, *arguments) == (2, "", f"{message}\n")


@pytest.mark.parametrize(("ends", "joined"), [(("1,1", "9,1"), True), (("1,1", "5,5"), False)])
def test_the_picture(muster, walled, tmp_path, ends, joined):
    file = tmp_path / "way.svg"
    assert muster("path", walled, "--from", ends[0], "--to", ends[1], "--plot", str(file))[0] == 0
    drawn = file.read_text(encoding="utf-8")
    assert ('id="path"' in drawn) == joined
    assert 'id="start"' in drawn
    assert 'id="goal"' in drawn


def test_check_tells_of_a_robot_in_a_wall_in_both_forms(muster, tmp_path):
    file = tmp_path / "stuck.yaml"
    file.write_text(WALLED.replace("position: [1, 1], radius", "position: [4, 1], radius"), encoding="utf-8")
    expected = "a place that is free for its robot (ground, radius 0.5 m)"
    line = f"{file}:10: robots[0].position: [4.0, 1.0], inside zone 0; expected {expected}\n"
    assert muster("check", str(file)) == (2, "", line)
    code, out, err = muster("check", str(file), "--format", "json")
    assert (code, err) == (2, "")
    (error,) = json.loads(out)["errors"]
    assert (error["line"], error["field"], error["expected"]) == (10, "robots[0].position", expected)


def test_a_smooth_path_turns_no_sharper_than_the_robot_can(muster):
    """rover0 of `floor` drives 0.8 m/s and turns by 1.571 rad/s."""
    ends = ("floor", "--from", "2,2", "--to", "36,20", "--smooth")
    for planner in ("shortest", "a-star"):
        found = answer(muster, *ends, "--robot", "rover0", "--planner", planner)
        assert found["turning_radius_m"] == pytest.approx(0.8 / 1.571)
        assert found["max_curvature_per_m"] <= 1.001 / found["turning_radius_m"]
    wide = answer(muster, *ends, "--turning-radius", "3")
    assert wide["max_curvature_per_m"] == pytest.approx(1 / 3, rel=1e-3)
    assert wide["corners"]
    _, out, _ = muster("path", *ends, "--turning-radius", "3")
    assert f"no room for that radius at {len(wide['corners'])} of its corners, which stay: (" in out


def test_the_trajectory_has_the_speeds_of_the_rims(muster, tmp_path):
    file = tmp_path / "out.csv"
    ends = ("floor", "--from", "2,2", "--to", "36,20", "--robot", "rover0", "--smooth")
    code, _, _ = muster("path", *ends, "--trajectory", str(file))
    assert code == 0
    rows = list(csv.DictReader(file.read_text().splitlines()))
    names = ["t_s", "x_m", "y_m", "heading_rad", "speed_mps", "yaw_rate_radps", "left_rim_mps", "right_rim_mps"]
    assert list(rows[0]) == names
    table = np.array([[float(row[name]) for name in names] for row in rows])
    track = 0.2 * 0.287 / 0.3
    np.testing.assert_allclose((table[:, 6] + table[:, 7]) / 2, table[:, 4], atol=2e-6)
    np.testing.assert_allclose((table[:, 7] - table[:, 6]) / track, table[:, 5], atol=2e-5)
    assert table[:, 4].max() <= 0.8 + 1e-6
    assert np.abs(table[:, 5]).max() <= math.pi / 2 + 1e-6
    length = np.linalg.norm(np.diff(table[:, 1:3], axis=0), axis=1).sum()
    assert length == pytest.approx(answer(muster, *ends)["length_m"], rel=2e-3)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--smooth", "--turning-radius", "-1"), "--turning-radius: -1; expected a finite number above 0"),
        (("--trajectory", "out.txt"), "--trajectory: out.txt; expected a file that ends in .csv"),
    ],
)
def test_what_a_smooth_path_cannot_be_asked(muster, walled, options, message):
    code, _, err = muster("path", walled, "--from", "1,1", "--to", "9,1", *options)
    assert code == 2
    assert message in err


def test_a_turning_radius_bends_the_way(muster, walled):
    sharp, wide = (
        answer(muster, walled, "--from", "1,1", "--to", "9,1", "--planner", "dubins", "--turning-radius", radius)
        for radius in ("0.2", "1")
    )
    shortest = answer(muster, walled, "--from", "1,1", "--to", "9,1")
    assert shortest["length_m"] < sharp["length_m"] < wide["length_m"] < 1.2 * shortest["length_m"]
    code, _, err = muster("path", walled, "--from", "1,1", "--to", "9,1", "--turning-radius", "1")
    assert code == 2
    assert "--turning-radius: 1; expected --smooth, --unknown or --planner dubins beside it" in err


@pytest.mark.parametrize("law", ["pure-pursuit", "virtual-target", "synthetic-waypoint"])
def test_a_law_of_guidance_tells_how_far_off_the_path_it_is(muster, walled, law):
    found = answer(muster, walled, "--from", "1,1", "--to", "9,1", "--robot", "rover", "--follow", law)
    assert found["arrived"]
    assert 0 < found["rms_cross_track_m"] < found["max_cross_track_m"] < 0.5
    assert found["points"][-1] == pytest.approx([9, 1], abs=0.05)
    code, out, _ = muster("path", walled, "--from", "1,1", "--to", "9,1", "--follow", law)
    assert code == 0
    assert f"rms; {law}, differential-drive" in out
    code, _, err = muster("path", walled, "--from", "1,1", "--to", "9,1", "--lookahead", "1")
    assert (code, "--lookahead: 1; expected --follow beside it" in err) == (2, True)


def test_a_local_minimum_is_an_answer(muster, walled):
    code, out, _ = muster("path", walled, "--from", "1,1", "--to", "9,1", "--planner", "potential-field")
    assert code == 0
    assert out.startswith("no path: not found: a local minimum at (")


@pytest.mark.long
def test_a_robot_without_a_map_goes_by_its_laser(muster, tmp_path):
    file = tmp_path / "posts.yaml"
    file.write_text(
        WALLED.replace("[4, 0], [6, 0], [6, 8], [4, 8]", "[4, 4], [5, 4], [5, 6], [4, 6]"), encoding="utf-8"
    )
    found = answer(muster, str(file), "--from", "1,5", "--to", "9,5", "--radius", "0.3", "--unknown")
    assert found["points"][-1] == pytest.approx([9, 5], abs=0.06)
    assert found["ways"] > 1
    gap = shapely.LineString(found["points"]).distance(shapely.box(4, 4, 5, 6))
    assert 0.2999 < gap < 0.45
    assert 8 < found["length_m"] < 9.5
    code, out, _ = muster("path", str(file), "--from", "1,5", "--to", "9,5", "--unknown")
    assert code == 0
    assert "scans" in out


def test_paths_of_several_robots_at_once(muster, tmp_path):
    file = tmp_path / "open.yaml"
    file.write_text(
        WALLED.replace("[4, 0], [6, 0], [6, 8], [4, 8]", "[4, 4], [5, 4], [5, 6], [4, 6]"), encoding="utf-8"
    )
    walled = str(file)
    code, out, err = muster("path", walled, "--together", "rover=8,8", "--format", "json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert found["robots"][0]["points"][-1] == [8, 8]
    code, out, _ = muster("path", walled, "--together", "rover=8,8")
    assert code == 0
    assert "8 neighbours" in out
    for told, message in (
        ("rver=8,8", "--together: 'rver'; expected a robot of the mission; did you mean 'rover'?"),
        ("rover=9", "--together: 'rover=9'; expected ROBOT=X,Y"),
    ):
        code, _, err = muster("path", walled, "--together", told)
        assert (code, message in err) == (2, True)
    code, _, err = muster("path", walled, "--from", "1,1")
    assert (code, "--to: missing; expected x,y" in err) == (2, True)
