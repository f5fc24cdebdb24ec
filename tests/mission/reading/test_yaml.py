"""Mission YAML: what is written is read back; scalars are those of YAML 1.2's core schema."""

import pytest
from hypothesis import given
from tests.mission.formats import FILE, SHIPPED
from tests.mission.strategies import examples, missions, tiny_missions

import muster
from muster.library import mission_path
from muster.mission.errors import MissionError
from muster.mission.model import (
    Robot,
)
from muster.mission.reading.yaml_reader import parse_yaml, read_yaml
from muster.mission.yaml_writer import yaml_text


@pytest.mark.long
@examples(120)
@given(missions())
def test_yaml_is_read_back(mission):
    text = yaml_text(mission)
    again = parse_yaml(text, FILE)
    assert again == mission
    assert yaml_text(again) == text


@examples(40)
@given(tiny_missions(tabled=True))
def test_yaml_with_travel_tables_is_read_back(folder, mission):
    for kind, table in mission.travel_tables.items():
        lines = [["from", *table.places]]
        lines += [[place, *map(repr, row)] for place, row in zip(table.places, table.metres, strict=True)]
        (folder / f"{kind}.csv").write_text("".join(",".join(line) + "\n" for line in lines), encoding="utf-8")
    (folder / "mission.yaml").write_text(yaml_text(mission), encoding="utf-8")
    assert read_yaml(folder / "mission.yaml") == mission


@pytest.mark.long(keep=15)
@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_missions_are_read_back(name):
    mission = muster.load(name)
    assert parse_yaml(yaml_text(mission), FILE) == mission


def test_a_byte_order_mark_and_line_ends_of_windows(tmp_path):
    path = mission_path("6T-2R")
    copy = tmp_path / "windows.yaml"
    copy.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    assert read_yaml(copy) == read_yaml(path)


def test_aliases():
    text = """
    schema: muster/1
    robots:
      - {id: r_0, position: &depot [0, 0], skills: &skills [camera]}
      - {id: r_1, position: *depot, end_position: *depot, skills: *skills}
    tasks: []
    """
    mission = parse_yaml(text, FILE)
    assert mission.robots[1] == Robot(id="r_1", position=(0, 0), end_position=(0, 0), skills=("camera",))


ONE = "{{schema: muster/1, robots: [{{id: {id}, position: [0, 0], work_capacity: {number}}}], tasks: []}}"


@pytest.mark.parametrize(
    ("written", "read"),
    [
        *[
            (word, word)
            for word in ("no", "No", "off", "on", "y", "yes", "1:30", "1_000", "2026-10-07", "0b11", "1e", "=")
        ],
        *[("7", "7"), ("0777", "777"), ("+5", "5"), ("-5", "-5"), ("0o17", "15"), ("0x1F", "31"), ("0", "0")],
        *[(f'"{word}"', word) for word in ("7", "0777", "1e3", "1.0", "true", "null", "~", ".inf", "0x1F")],
        *[("'7'", "7"), ("'it''s'", "it's"), ("nan", "nan"), ("inf", "inf"), ("r 0", "r 0"), ("<<", "<<")],
    ],
)
def test_names_by_the_core_schema_of_yaml_1_2(written, read):
    assert parse_yaml(ONE.format(id=written, number=1), FILE).robots[0].id == read


@pytest.mark.parametrize(
    ("written", "read"),
    [
        *[("1e3", 1000.0), ("1E+3", 1000.0), ("1.", 1.0), (".5", 0.5), ("+.5", 0.5), ("0.5e-1", 0.05), ("0777", 777.0)],
        *[("0x10", 16.0), ("0o17", 15.0), ("1" + "0" * 299, 1e299), ("5e-324", 5e-324), ("-0.0", 0.0), ("12", 12.0)],
        *[(word, None) for word in ("null", "Null", "NULL", "~", "")],
    ],
)
def test_numbers_by_the_core_schema_of_yaml_1_2(written, read):
    assert parse_yaml(ONE.format(id="r_0", number=written), FILE).robots[0].work_capacity == read


@pytest.mark.parametrize("written", ["1:30", "1_000", "0b11", '"5"', "5 m", ".nan", ".inf", "-.INF", "1e999", "true"])
def test_what_is_no_number_by_the_core_schema_of_yaml_1_2(written):
    with pytest.raises(MissionError, match=r"^mission.yaml:1: robots\[0\].work_capacity: .*; expected a finite number"):
        parse_yaml(ONE.format(id="r_0", number=written), FILE)


@pytest.mark.parametrize(("written", "read"), [("true", True), ("True", True), ("FALSE", False)])
def test_flags_by_the_core_schema_of_yaml_1_2(written, read):
    text = (
        f"{{schema: muster/1, rules: {{return_to_start: {written}}}, robots: [{{id: 1, position: [0, 0]}}], tasks: []}}"
    )
    assert parse_yaml(text, FILE).rules.return_to_start is read


def test_a_type_is_the_same_word_as_a_key_and_as_a_value():
    text = """
    schema: muster/1
    suitability: {01: {007: 0.9, 0x10: 0.8}}
    robots: [{id: r_0, type: 01, position: [0, 0]}]
    tasks: [{id: a, type: 007, position: [0, 0]}, {id: b, type: 0x10, position: [0, 0]}]
    """
    mission = parse_yaml(text, FILE)
    assert mission.suitability == {
        mission.robots[0].type: {task.type: s for task, s in zip(mission.tasks, (0.9, 0.8), strict=True)}
    }
