"""Places that robots cannot stand at, and what is said of them."""

from importlib.util import find_spec

import numpy as np
import pytest

from muster.mission.errors import MissionError
from muster.mission.reading.yaml_reader import parse_yaml
from muster.motion.map_world import World
from muster.motion.unreachable_places import blocked_places, checked_world

pytestmark = pytest.mark.skipif(find_spec("shapely") is None, reason="needs the extra `map`")

ZONES = "zones: [{polygon: [[4, 4], [6, 4], [6, 6], [4, 6]], forbidden_to: [ground], floor_m: 0, ceiling_m: 2}]"
ARENA = f"{{boundary: [[0, 0], [10, 0], [10, 10], [0, 10]], {ZONES}}}"


def mission(folder, robots, tasks, chart=ARENA):
    text = f"schema: muster/1\nname: m\nmap: {chart}\nrobots:\n{robots}\ntasks:\n{tasks}\n"
    return parse_yaml(text, folder / "m.yaml")


def told(question):
    return [str(place) for place in blocked_places(World.of(question), question)]


def test_each_reason_has_its_words(tmp_path):
    robots = "  - {id: r_0, position: [1, 1], radius_m: 0.2, end_position: [5, 5]}"
    tasks = """\
  - {id: in, position: [5.5, 5]}
  - {id: near, position: [3.88, 5]}
  - {id: out, position: [12, 5]}
  - {id: wall, position: [0.05, 5]}
  - {id: fine, position: [3.8, 5]}
  - {id: doors, position: [5, 5], entry: [3, 3], exit: [5, 5.5]}"""
    assert told(mission(tmp_path, robots, tasks)) == [
        "robot r_0 at (5, 5): inside zone 0",
        "task in at (5.5, 5): inside zone 0",
        "task near at (3.88, 5): 0.12 m from zone 0, radius 0.2 m",
        "task out at (12, 5): outside the boundary",
        "task wall at (0.05, 5): 0.05 m from the boundary, radius 0.2 m",
        "task doors at (5, 5.5): inside zone 0",
    ]


def test_in_the_air(tmp_path):
    robots = "  - {id: uav, position: [1, 1, 0], radius_m: 0.2, kind: air}"
    tasks = (
        "  - {id: low, position: [5, 5, 1]}\n  - {id: near, position: [5, 5, 2.1]}\n  - {id: high, position: [5, 5, 3]}"
    )
    chart = ARENA.replace("[ground]", "[air]")
    assert told(mission(tmp_path, robots, tasks, chart)) == [
        "task low at (5, 5, 1): inside zone 0",
        "task near at (5, 5, 2.1): 0.1 m from zone 0, radius 0.2 m",
    ]


def test_on_an_image(tmp_path):
    blocked = np.zeros((10, 10), dtype=np.uint8)
    blocked[5, 5] = 1
    (tmp_path / "floor.pgm").write_bytes(b"P5 10 10 255\n" + ((1 - blocked[::-1]) * 255).tobytes())
    robots = "  - {id: r_0, position: [1, 1], radius_m: 0.2}"
    tasks = """\
  - {id: in, position: [5.5, 5.5]}
  - {id: near, position: [4.9, 5.5]}
  - {id: cell, position: [4.2, 5.5]}
  - {id: out, position: [10.5, 5]}
  - {id: fine, position: [3.9, 5.5]}"""
    assert told(mission(tmp_path, robots, tasks, "{image: floor.pgm, resolution_m: 1}")) == [
        "task in at (5.5, 5.5): inside a wall, or where the map is unknown",
        "task near at (4.9, 5.5): 0.1 m from a wall, radius 0.2 m",
        "task cell at (4.2, 5.5): in a cell of 1 m that is nearer than 0.2 m to a wall",
        "task out at (10.5, 5): outside the map",
    ]


def test_a_start_that_is_blocked_is_a_fault_and_a_task_is_none(tmp_path):
    """A task that no robot can come to is left out, and the others can be planned."""
    robots = (
        "  - {id: r_0, position: [0.1, 1], radius_m: 0.2}\n  - {id: uav, position: [2, 2], kind: air, radius_m: 0.3}"
    )
    tasks = "  - {id: 0, position: [5, 5]}\n  - {id: 1, position: [5, 5], only_robots: [r_0]}\n"
    tasks += "  - {id: 2, position: [-1, 5]}"
    question = mission(tmp_path, robots, tasks)
    assert [(p.owner, p.body.kind) for p in blocked_places(World.of(question), question)] == [
        ("robot r_0", "ground"),
        ("task 0", "ground"),
        ("task 1", "ground"),
        ("task 2", "ground"),
        ("task 2", "air"),
    ]
    with pytest.raises(MissionError) as caught:
        checked_world(question)
    assert str(caught.value) == (
        f"{tmp_path / 'm.yaml'}:5: robots[0].position: [0.1, 1.0], 0.1 m from the boundary, radius 0.2 m; "
        "expected a place that is free for its robot (ground, radius 0.2 m)"
    )


def test_a_world_without_faults(tmp_path):
    question = mission(tmp_path, "  - {id: r_0, position: [1, 1]}", "  - {id: 0, position: [2, 2]}")
    assert checked_world(question).boundary.area == 100


def test_a_start_inside_a_wall_is_a_fault(tmp_path):
    question = mission(tmp_path, "  - {id: r_0, position: [5, 5]}", "  - {id: 0, position: [2, 2]}")
    with pytest.raises(MissionError, match=r"m.yaml:5: robots\[0\].position: \[5.0, 5.0\], inside zone 0; expected"):
        checked_world(question)


def test_the_way_points_of_actions_are_looked_at_for_robots_that_pass_them(tmp_path):
    """Each once, by the name that the mission has for it; the position itself need not be free."""
    robots = (
        "  - {id: r_0, position: [1, 1], radius_m: 0.2}\n"
        "  - {id: r_1, position: [2, 1], radius_m: 0.2, camera: {fov_deg: 60, tilt_deg: 45}}\n"
        "  - {id: uav, position: [1, 2], kind: air}"
    )
    tasks = """\
  - {id: around, position: [5, 5], action: {name: ground-patrol, side_m: 4}}
  - {id: corner, position: [7, 7], action: {name: ground-patrol, side_m: 3}}
  - {id: load, position: [2, 8], action: {name: delivery, pickup: [5, 5]}}
  - {id: bring, position: [5, 5], action: {name: delivery, pickup: [2, 8]}, exit: [5, 5.5]}
  - {id: look, position: [6.5, 5], action: {name: stationary-observation, width_m: 1}}
  - {id: only, position: [7, 7], action: {name: ground-patrol, side_m: 3}, only_robots: [uav]}"""
    question = mission(tmp_path, robots, tasks)
    blocked = blocked_places(World.of(question), question)
    assert [(p.owner, p.path[2:], p.point) for p in blocked] == [
        ("task corner", ("action",), (5.5, 5.5)),
        ("task load", ("action", "pickup"), (5, 5)),
        ("task bring", ("position",), (5, 5)),
        ("task bring", ("exit",), (5, 5.5)),
        ("task look", ("action",), (pytest.approx(5.817, abs=1e-3), 5)),
    ]
