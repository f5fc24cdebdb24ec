"""Files of other programs that are no missions: refused in one line that names what they are."""

import json

import pytest

import muster
from muster.mission.errors import MissionError

GRAPH = {"id": 0, "frame": "map"}
EDGE = {"id": 10, "startid": 0, "endid": 1}


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        (
            "b.building.yaml",
            "levels:\n  L1: {vertices: [], lanes: []}\nlifts: {}\nname: b\n",
            "a building map of Open-RMF",
        ),
        (
            "graph.yaml",
            "building_name: b\nlevels:\n  L1: {vertices: [], lanes: []}\n",
            "a navigation graph of Open-RMF",
        ),
        ("fleet.yaml", "rmf_fleet: {name: a}\n", "a fleet configuration of Open-RMF"),
        ("floor.yaml", "image: f.png\nresolution: 0.05\norigin: [0, 0, 0]\n", "a map of ROS"),
        ("x.json", json.dumps({"fileType": "Plan", "mission": {}}), "a plan of QGroundControl"),
    ],
)
def test_a_file_of_another_program_is_named(name, text, said, tmp_path):
    (tmp_path / name).write_text(text, encoding="utf-8")
    with pytest.raises(MissionError) as error:
        muster.load(tmp_path / name)
    assert str(error.value).startswith(f"{tmp_path / name}: {said}; expected ")
    assert "\n" not in str(error.value)


def test_a_mission_with_faults_is_not_taken_for_another_file(tmp_path):
    (tmp_path / "m.yaml").write_text("schema: muster/1\nlevels: {}\n", encoding="utf-8")
    with pytest.raises(MissionError, match="levels: "):
        muster.load(tmp_path / "m.yaml")
