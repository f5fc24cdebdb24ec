"""Files of the MovingAI benchmarks."""

import numpy as np
import pytest
from tests.muster_studies.movingai_maps import map_text

from muster.mission.errors import InputError
from muster.traffic.joint_path_faults import faults
from muster.traffic.movingai import Ends, read_map, read_scenario

MAP = "type octile\nheight 2\nwidth 4\nmap\n..@T\nGSOW\n"


def test_a_map(tmp_path):
    path = tmp_path / "a.map"
    path.write_text(MAP)
    assert read_map(path).tolist() == [[False, False, True, True], [False, False, True, True]]


def test_there_and_back(tmp_path):
    blocked = np.random.default_rng(0).random((5, 7)) < 0.3
    path = tmp_path / "a.map"
    path.write_text(map_text(blocked))
    assert np.array_equal(read_map(path), blocked)


def test_a_scenario(tmp_path):
    path = tmp_path / "a.scen"
    path.write_text("version 1\n3\ta.map\t4\t2\t1\t0\t0\t1\t2.0\n")
    assert read_scenario(path) == [Ends(start=(0, 1), goal=(1, 0))]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("type octile\nheight two\nwidth 4\nmap\n", "a.map:2: height: two"),
        (MAP.replace("GSOW", "GSO"), "a.map:6: row: GSO"),
        (MAP.replace("GSOW", "GSOX"), "a.map:6: row: GSOX"),
        ("type octile\nheight 2\nwidth 4\nmap\n..@T\n", "a.map:4: map: 1 rows"),
        ("", "a.map:1: type: missing"),
    ],
)
def test_what_is_no_map(tmp_path, monkeypatch, text, place):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.map").write_text(text)
    with pytest.raises(InputError, match=place):
        read_map((tmp_path / "a.map").relative_to(tmp_path))


@pytest.mark.parametrize(
    "text", ["", "1 a.map\n", "version 1\n3 a.map 4 2 1 0 0\n", "version 1\n3 a.map 4 2 1 x 0 1 2.0\n"]
)
def test_what_is_no_scenario(tmp_path, text):
    (tmp_path / "a.scen").write_text(text)
    with pytest.raises(InputError, match="expected"):
        read_scenario(tmp_path / "a.scen")


def test_the_judge_sees_conflicts():
    blocked = np.array([[False, False, False], [True, True, False]])
    a, b, c = (0, 0), (0, 1), (0, 2)
    assert faults(blocked, [[a, b], [b, c]], [(a, b), (b, c)]) == []
    assert faults(blocked, [[a, b], [b, a]], [(a, b), (b, a)]) == ["robots 0 and 1 change places at step 1"]
    assert faults(blocked, [[a, b], [c, b]], [(a, b), (c, b)]) == [f"robots 0 and 1 are both in {b} at step 1"]
    assert faults(blocked, [[a, c]], [(a, c)]) == ["robot 0 jumps at step 1"]
    assert faults(blocked, [[a, (1, 0)]], [(a, (1, 0))]) == ["robot 0 is in (1, 0) at step 1, which is blocked"]
    assert faults(blocked, [[a, b]], [(a, c)]) == [f"robot 0 goes from {a} to {b}, not from {a} to {c}"]
