"""What pages make of missions, plans and files before it is shown."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from muster.library.shipped import mission_path
from muster.mission.reading.yaml_reader import read_yaml
from muster.mission.yaml_writer import plain
from muster_control.contract import MissionVersion
from muster_control.pages.map import scene_of
from muster_control.pages.map.ground import image_of
from muster_control.pages.missions.new_mission import EMPTY, EMPTY_IN_SPACE, options_of, refused, sorted_out
from muster_control.pages.missions.view import ago
from muster_control.pages.plan.compare import moved_tasks, with_better
from muster_control.pages.plan.explanation import question
from muster_control.pages.plan.figures import figures_of, lines_of, meaning_of
from muster_control.pages.plan.versions import differences, marked


def test_the_scene_of_a_floor_has_its_robots_tasks_and_zone() -> None:
    path = mission_path("floor")
    assert path is not None
    scene = scene_of(plain(read_yaml(path)), impossible=["gate"])
    assert [robot["kind"] for robot in scene["robots"]] == ["ground"] * 3 + ["air"] * 2
    assert scene["tasks"][4] == {"id": "crate", "x": 12, "y": 8, "z": None, "type": "", "prerequisites": ["aisle4"]}
    assert scene["zones"][0]["label"] == "zone 1, closed to air robots"
    assert (scene["zones"][0]["partly"], scene["boundary"], scene["impossible"]) == (True, None, ["gate"])


def test_an_area_is_in_the_scene_once_however_many_tasks_cover_it() -> None:
    path = mission_path("field-survey")
    assert path is not None
    scene = scene_of(plain(read_yaml(path)))
    (area,) = scene["areas"]
    assert (len(area["corners"]), len(area["holes"])) == (7, 2)
    assert [task["id"] for task in scene["tasks"] if "fixed" not in task] == ["hedge", "gate"]


def test_tiles_are_drawn_only_where_the_earth_is_known() -> None:
    mission = {"robots": [], "tasks": []}
    assert scene_of(mission, tiles="/t")["tiles"] is None
    scene = scene_of({**mission, "origin_wgs84": {"lat_deg": 35.5, "lon_deg": 24.0}}, tiles="/t")
    assert scene["tiles"] == {"url": "/t", "origin": [35.5, 24.0]}


def test_a_floor_plan_is_found_among_the_files_of_the_mission() -> None:
    kept = MissionVersion(mission="my floor", version=3, text="", author="", at=None, files={"floor.pgm": b"P5"})
    floor = {"file": "floor.pgm", "resolution_m": 0.05, "origin": [-1.0, -2.0, 0.0]}
    url = "/api/v1/missions/my%20floor/files/floor.pgm?version=3"
    assert image_of(floor, kept) == {"url": url, "resolution": 0.05, "origin": [-1.0, -2.0, 0.0]}
    assert image_of({**floor, "file": "../secret.png"}, kept) is None
    assert image_of(None, kept) is None


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["robots.csv", "t.csv", "suitab.csv"], ("t.csv", {"robots": "robots.csv", "suitability": "suitab.csv"})),
        (["floor.png", "floor.yaml"], ("floor.yaml", {})),
        (["panels.csv", "site.geojson", "team.yaml"], ("team.yaml", {})),
        (["robots.csv"], ("robots.csv", {})),
        (["eil51.tsp"], ("eil51.tsp", {})),
    ],
)
def test_the_mission_among_files_is_found_by_their_names(
    names: list[str], expected: tuple[str, dict[str, str]]
) -> None:
    assert sorted_out(names) == expected


def test_files_in_capitals_are_uploaded_like_others() -> None:
    assert options_of("EIL51.TSP", {}, 4) == {"salesmen": 4, "depot": "1"}
    assert options_of("TASKS.CSV", {"robots": "ROBOTS.CSV"}, 4) == {"robots": "ROBOTS.CSV"}
    assert options_of("yard.YAML", {}, 4) == {}
    assert options_of("A-N32.VRP", {"robots": "ROBOTS.CSV"}, 4) == {}


def test_tasks_that_change_robot_are_told_with_both() -> None:
    a = {"routes": [{"robot": "x", "tasks": ["1", "2"]}, {"robot": "y", "tasks": ["3"]}]}
    b = {"routes": [{"robot": "x", "tasks": ["2", "4"]}, {"robot": "y", "tasks": ["3", "1"]}]}
    assert moved_tasks(a, b) == [("1", "x", "y"), ("4", "left out", "x")]
    assert moved_tasks(a, a) == []
    teams = [{"routes": [{"robot": robot, "tasks": ["5"]} for robot in team]} for team in ("xz", "yz")]
    assert moved_tasks(*teams) == [("5", "x, z", "y, z")]
    a = {"routes": [{"robot": "x", "tasks": ["2", "t_12", "12", "t_4"]}]}
    assert [task for task, *_ in moved_tasks(a, {"routes": []})] == ["2", "t_4", "12", "t_12"]


def test_the_better_of_two_plans_is_marked_where_one_is() -> None:
    assert with_better("Total cost", "2.00 m", "1.50 m") == ("2.00 m", "1.50 m (better)")
    assert with_better("Objective, max", "9.00 m", "10.00 m") == ("9.00 m (better)", "10.00 m")
    assert with_better("Tasks done", "31 of 31", "27 of 31") == ("31 of 31 (better)", "27 of 31")
    assert with_better("Ends after", "2.00 s", "2.00 s") == ("2.00 s", "2.00 s")
    assert with_better("Lower bound", "1.00 m", "2.00 m") == ("1.00 m", "2.00 m")
    assert with_better("Equality", "0.96", "") == ("0.96", "")


def test_a_task_that_is_left_out_is_asked_about_as_such() -> None:
    plan = {"unassigned": [{"task": "8"}]}
    assert question("8", plan) == "Why is task 8 left out?"
    assert question("9", plan) == "Why is task 9 done as it is?"


def test_files_that_are_refused_are_told_with_the_reason() -> None:
    words = refused([("max-file-size", "big.yaml", 30 * 2**20), ("accept", "a.doc", 5)]).splitlines()
    assert words[0] == "big.yaml: 30.0 MiB is too large; expected at most 16 MiB"
    assert words[1].startswith("a.doc: not a kind of file")


@pytest.mark.parametrize(("text", "dimensions"), [(EMPTY, 2), (EMPTY_IN_SPACE, 3)])
def test_what_a_mission_begins_with_is_one(text: str, dimensions: int, tmp_path: Path) -> None:
    file = tmp_path / "mission.yaml"
    file.write_text(text.format(name="yard"))
    mission = read_yaml(file)
    assert {len(one.position) for one in (*mission.robots, *mission.tasks)} == {dimensions}


def test_figures_are_the_judges_and_say_what_is_wrong() -> None:
    plan = {"objective": {"name": "max", "value": 10.0}, "lower_bound": 8.0, "total_cost": 1.0, "usage_unit": "m"}
    wrong = [{"kind": "capacity", "robot": "r_0", "task": None}]
    verdict = {"valid": False, "violations": wrong, "total_cost": 2.0, "ignored": ["skills"]}
    figures = dict(figures_of(plan, verdict))
    assert figures["Rules ignored"] == "skills"
    assert figures["Lower bound"] == "8.00 m (gap 20.0%)"
    assert figures["Total cost"] == "2.00 m"
    assert figures["The judge says"] == "not admissible: capacity r_0"
    assert "Tasks done" not in figures


def test_a_makespan_is_in_seconds_and_a_bound_that_is_missing_is_told() -> None:
    plan = {"objective": {"name": "makespan", "value": 137.39}, "usage_unit": "m", "total_cost": 1.0}
    figures = dict(figures_of(plan))
    assert figures["Objective, makespan"] == "137.39 s"
    assert figures["Lower bound"] == "none was found"
    assert figures["Total cost"] == "1.00 m"
    assert all(meaning_of(name) for name in figures)


def test_the_map_gets_lines_and_what_is_left_out() -> None:
    verdict = {
        "routes": [{"robot": "x", "tasks": ("1",), "order": ("1", "[dock]")}],
        "lines": {"x": {"travel": [[[0, 0], [1, 1]]]}},
    }
    shown = lines_of({"unassigned": [{"task": "9"}]}, verdict)
    assert shown["left_out"] == ["9"]
    assert shown["routes"] == [
        {"robot": "x", "tasks": ["1"], "order": ["1", "[dock]"], "lines": {"travel": [[[0, 0], [1, 1]]]}}
    ]


def test_times_are_told_from_now() -> None:
    now = datetime(2026, 5, 1, 12, tzinfo=UTC)
    cases = ((5, "just now"), (61, "1 minute ago"), (7200, "2 hours ago"), (86400 * 7, "7 days ago"))
    for seconds, words in cases:
        assert ago(now - timedelta(seconds=seconds), now) == words
    assert ago(now - timedelta(days=30), now) == "2026-04-01"


def test_differences_are_lines_with_signs() -> None:
    assert differences("a\nb\n", "a\nc\n")[1:] == [" a", "-b", "+c"]
    assert differences("a", "a") == []
    assert differences("a\n" * 15_000, "b\n" * 15_000) == ["The texts differ, and are too long to be compared here."]


def test_differences_are_one_piece_of_html_in_which_nothing_is_marked_but_the_signs() -> None:
    expected = '<div class="added">+a: &lt;b&gt; &amp;</div><div class="removed">-</div><div class=""> c</div>'
    assert marked(["+a: <b> &", "-", " c"]) == expected
