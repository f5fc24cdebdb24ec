"""Files of the League of Robot Runners: what is read, and what is refused in one line."""

import json

import numpy as np
import pytest
from tests.traffic.league import league, write_league

from muster.mission.errors import InputError
from muster.traffic.lifelong.league_instance import read_league

ROWS = ["...#", "....", "#..."]
INSTANCE = league(ROWS, [0, 5, 10], [[1, 2], [6], [11, 4, 9]], 5)


def test_an_instance_is_read(tmp_path):
    found = read_league(write_league(tmp_path, INSTANCE))
    assert np.array_equal(found.blocked, INSTANCE.blocked)
    assert (found.starts, found.tasks, found.revealed) == (INSTANCE.starts, INSTANCE.tasks, 5)


def test_the_cells_of_stations_are_free(tmp_path):
    path = write_league(tmp_path, INSTANCE)
    text = (tmp_path / "a.map").read_text()
    head, rows = text.split("map\n", 1)
    (tmp_path / "a.map").write_text(head + "map\n" + rows.replace(".", "E", 1).replace(".", "S", 1))
    assert np.array_equal(read_league(path).blocked, INSTANCE.blocked)


def test_the_first_robots_of_a_file(tmp_path):
    path = write_league(tmp_path, INSTANCE)
    path.write_text(path.read_text().replace('"teamSize": 3', '"teamSize": 2'))
    found = read_league(path)
    assert (found.starts, found.revealed) == ([0, 5], 3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mapFile": None}, "a.json: mapFile: missing; expected the name of a file"),
        ({"mapFile": "b.map"}, "a.json: mapFile: b.map; expected a file; there is no "),
        ({"mapFile": "\0"}, "a.json: mapFile: "),
        ({"agentFile": 3}, "a.json: agentFile: 3; expected the name of a file"),
        ({"taskFile": ""}, 'a.json: taskFile: ""; expected the name of a file'),
        ({"teamSize": None}, "a.json: teamSize: missing; expected a whole number of at least 1"),
        ({"teamSize": 0}, "a.json: teamSize: 0; expected a whole number of at least 1"),
        ({"teamSize": True}, "a.json: teamSize: true; expected a whole number"),
        ({"teamSize": 4}, "a.agents: teamSize: 4; expected at most 3"),
        ({"numTasksReveal": "x"}, 'a.json: numTasksReveal: "x"; expected a number above 0'),
        ({"numTasksReveal": 0}, "a.json: numTasksReveal: 0; expected a number above 0"),
        ({"numTasksReveal": float("nan")}, "a.json: numTasksReveal: NaN; expected a number above 0"),
        ({"numTasksReveal": 1e30}, "a.json: numTasksReveal: 1e\\+30; expected a number above 0"),
        ({"delayConfig": {"seed": 0}}, "a.json: delayConfig: given; expected an instance without delays"),
        ({"agentSize": 2}, "a.json: agentSize: 2; expected 1"),
    ],
)
def test_wrong_fields(tmp_path, change, message):
    path = write_league(tmp_path, INSTANCE)
    fields = json.loads(path.read_text()) | change
    path.write_text(json.dumps({name: value for name, value in fields.items() if value is not None}))
    with pytest.raises(InputError, match=message):
        read_league(path)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.json", "[1]", "a.json:1: list; expected an object"),
        ("a.json", "{\n]", "a.json:2: .*; expected JSON"),
        ("a.json", "[" * 100_000, "a.json:1: nested too deeply; expected JSON"),
        ("a.map", "type octile\nheight 1\nwidth 2\nmap\n.x\n", "a.map:5: row: .x"),
        ("a.agents", "", "a.agents:1: number of robots: missing"),
        ("a.agents", "# n\nx\n", "a.agents:2: number of robots: x"),
        ("a.agents", "3\n0\n5\n", "a.agents:1: number of robots: 3; expected at most 2: as many lines follow"),
        ("a.agents", "3\n0\n3\n5\n", "a.agents:3: start: 3; expected a free cell"),
        ("a.agents", "3\n0\n5\n0\n", "a.agents:4: start: 0; expected a cell that no other robot has; line 2 has it"),
        ("a.agents", "3\n0\n-5\n1\n", "a.agents:3: start: -5; expected a free cell"),
        ("a.tasks", "0\n", "a.tasks:1: number of tasks: 0; expected a whole number of at least 1"),
        ("a.tasks", "2\n1,2\n", "a.tasks:1: number of tasks: 2; expected at most 1"),
        ("a.tasks", "1\n1,99\n", "a.tasks:2: task: 99; expected a free cell, row \\* 4 \\+ column, below 12"),
        ("a.tasks", "1\n1,,2\n", "a.tasks:2: task: empty; expected a free cell"),
        ("a.tasks", "1\n1;2\n", "a.tasks:2: task: 1;2; expected a free cell"),
        ("a.tasks", "1\n" + "9" * 5000 + "\n", "a.tasks:2: task: 9+; expected a free cell"),
    ],
)
def test_wrong_files(tmp_path, name, text, message):
    path = write_league(tmp_path, INSTANCE)
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=message) as error:
        read_league(path)
    assert "\n" not in str(error.value).strip()


@pytest.mark.parametrize("name", ["a.json", "a.map", "a.agents", "a.tasks"])
def test_files_that_are_no_text(tmp_path, name):
    path = write_league(tmp_path, INSTANCE)
    (tmp_path / name).write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        read_league(path)
