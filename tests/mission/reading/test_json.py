"""Missions in JSON: read by a parser of JSON, they are what the reader of YAML makes of the same text."""

import json
import pickle
import random
from dataclasses import replace

import pytest
import yaml
from tests.mission.test_broken import FOLDER

from muster.library import mission_names, mission_path
from muster.mission.errors import MissionError
from muster.mission.model import Mission
from muster.mission.reading import yaml_reader
from muster.mission.reading.json_reader import json_data
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.records import Record

LAYOUTS = {"lines": {"indent": 1}, "one line": {}, "dense": {"separators": (",", ":")}, "sorted": {"sort_keys": True}}


def plain(path):
    """The data of a YAML file; None where it is not what JSON can say."""
    try:
        return yaml_reader.parse_data(path.read_text(encoding="utf-8"), path, "")[0]
    except (MissionError, UnicodeDecodeError):
        return None


def outcome(text, path):
    """The mission and the places of its values, or what is wrong with it."""
    try:
        mission = parse_yaml(text, path)
    except MissionError as error:
        return error.findings
    return mission, dict(mission.source.places)


@pytest.fixture
def both(monkeypatch):
    """The outcomes of a text by the parser of JSON and by the reader of YAML."""

    def both(text, path):
        fast = outcome(text, path)
        with monkeypatch.context() as slow:
            slow.setattr(yaml_reader, "json_data", lambda text: None)
            return fast, outcome(text, path)

    return both


BROKEN = {path: data for path in sorted(FOLDER.glob("*.yaml")) if (data := plain(path)) is not None}


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_shipped_missions_are_the_same(layout, both):
    for path in map(mission_path, mission_names()):
        if path.suffix == ".yaml":
            text = json.dumps(plain(path), ensure_ascii=False, **LAYOUTS[layout])
            assert json_data(text) is not None
            fast, slow = both(text, path)
            assert fast == slow
            assert fast[0] == parse_yaml(path.read_text(encoding="utf-8"), path)


def test_there_are_enough_broken_files():
    assert len(BROKEN) >= 200


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_broken_files_get_the_same_messages_and_lines(layout, both, monkeypatch):
    monkeypatch.chdir(FOLDER)
    for path, data in BROKEN.items():
        text = json.dumps(data, ensure_ascii=False, **LAYOUTS[layout])
        fast, slow = both(text, path)
        assert fast == slow, path


def test_texts_with_a_slip_get_the_same_messages(both):
    """One character is lost, doubled or another one; CRLF ends lines."""
    random_ = random.Random(1)
    path = mission_path("6T-2R")
    whole = json.dumps(plain(path), indent=1).replace("\n", "\r\n")
    for _ in range(300):
        at = random_.randrange(len(whole))
        text = whole[:at] + random_.choice(["", whole[at] * 2, *'",:{}[]x1-. \n']) + whole[at + 1 :]
        fast, slow = both(text, path)
        assert fast == slow, text[max(0, at - 40) : at + 40]


@pytest.mark.parametrize(
    "text",
    [
        '{"schema": "muster/1", "schema": "muster/1"}',
        '{"a": NaN}',
        '{"a": Infinity}',
        '{"a": 1} {}',
        '["a"]',
        "{a: 1}",
        '{"a": 1, # a comment\n"b": 2}',
        "[" * 100_000,
        '{"a":' * 100_000,
    ],
)
def test_what_is_left_to_the_reader_of_yaml(text):
    assert json_data(text) is None


def test_numbers_mean_the_same():
    digits = ["0", "-0", "1e3", "-1.5E-2", "1" * 299, "1" * 301, "1" * 5000, "1e400"]
    text = f'{{"a": [{", ".join(digits)}]}}'
    assert repr(json_data(text)) == repr({"a": [yaml_reader._resolved(one) for one in digits]})


def test_letters_beyond_the_basic_plane_may_be_escaped(both):
    """As `json.dumps` writes them, and a reader of YAML refuses."""
    data = plain(mission_path("6T-2R")) | {"name": "a rocket \N{ROCKET}"}
    assert parse_yaml(json.dumps(data), FOLDER).name == "a rocket \N{ROCKET}"
    text = json.dumps({"nane": 1} | data, indent=1)
    with pytest.raises(MissionError) as error:
        parse_yaml(text, FOLDER)
    assert [(finding.field, finding.line) for finding in error.value.findings] == [("nane", 2)]


def test_a_large_mission_is_never_given_to_the_reader_of_yaml(monkeypatch):
    monkeypatch.setattr(yaml, "parse", None)
    tasks = [{"id": str(k), "position": [k, 0.5]} for k in range(10_000)]
    data = {"schema": "muster/1", "robots": [{"id": "r", "position": [0, 0]}], "tasks": tasks}
    assert len(parse_yaml(json.dumps(data), FOLDER).tasks) == 10_000
    tasks[7_000]["position"] = [0]
    with pytest.raises(MissionError) as error:
        parse_yaml(json.dumps(data, indent=None).replace('{"id"', '\n{"id"'), FOLDER)
    assert [(finding.field, finding.line) for finding in error.value.findings] == [("tasks[7000].position", 7_003)]


def test_lists_read_at_once_are_those_read_one_by_one(monkeypatch):
    """Records that have the same keys are read key by key; the result and every fault are as of each by itself."""
    texts = {path: json.dumps(data, indent=1) for path, data in BROKEN.items()}
    texts |= {
        path: path.read_text(encoding="utf-8") for path in map(mission_path, mission_names()) if path.suffix == ".yaml"
    }
    monkeypatch.chdir(FOLDER)
    at_once = {path: outcome(text, path) for path, text in texts.items()}
    monkeypatch.setattr(Record, "read_column", lambda self, values: None)
    for path, text in texts.items():
        assert outcome(text, path) == at_once[path], path


def test_a_mission_that_was_read_is_as_one_that_was_made():
    """Tasks that are read hold only what is given; nothing of that is to be seen."""
    mission = parse_yaml(mission_path("6T-2R").read_text(encoding="utf-8"), mission_path("6T-2R"))
    names = [name for name in Mission.__dataclass_fields__ if name != "source"]
    made = Mission(**{name: getattr(mission, name) for name in names})
    for task in mission.tasks:
        again = type(task)(**{name: getattr(task, name) for name in type(task).__dataclass_fields__})
        assert (again, hash(again), repr(again)) == (task, hash(task), repr(task))
        assert replace(task, priority=2.0) == replace(again, priority=2.0)
        assert pickle.loads(pickle.dumps(task)) == task
    assert made == mission
