"""The published JSON Schema agrees with the reader."""

import json
import re
from pathlib import Path
from typing import ClassVar

import pytest
import yaml
from hypothesis import given
from jsonschema import Draft202012Validator
from tests.mission.formats import BROKEN, FILE, SHIPPED
from tests.mission.strategies import examples, missions

from muster.library import mission_path
from muster.mission import json_schema
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.yaml_writer import yaml_text


class CoreLoader(yaml.SafeLoader):
    """PyYAML with the scalars of YAML 1.2's core schema, as any editor with a YAML 1.2 parser has them."""

    yaml_implicit_resolvers: ClassVar = {}


for tag, pattern in {
    "null": r"~|null|Null|NULL|",
    "bool": r"true|True|TRUE|false|False|FALSE",
    "int": r"[-+]?[0-9]+",
    "float": r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?",
}.items():
    CoreLoader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(rf"^(?:{pattern})$"), None)


def plain_data(text):
    return yaml.load(text, Loader=CoreLoader)


@pytest.fixture(scope="module")
def validator():
    schema = json.loads(json_schema.schema_text())
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def test_the_schema_that_ships_is_that_of_the_model():
    shipped = Path(json_schema.__file__).with_name("muster-1.schema.json").read_text(encoding="utf-8")
    assert shipped == json_schema.schema_text()


@pytest.mark.long(keep=10)
@pytest.mark.parametrize("name", SHIPPED)
def test_the_schema_accepts_shipped_missions(name, validator):
    assert list(validator.iter_errors(plain_data(mission_path(name).read_text(encoding="utf-8")))) == []


@examples(40)
@given(mission=missions())
def test_the_schema_accepts_what_is_written(validator, mission):
    assert list(validator.iter_errors(plain_data(yaml_text(mission)))) == []


def test_the_schema_accepts_keys_without_value_that_the_reader_accepts(validator):
    text = "schema: muster/1\nrobots: [{id: r_0, position: [0, 0], work_capacity: null, camera: }]\ntasks: []\nmap:\n"
    assert parse_yaml(text, FILE).robots[0].work_capacity is None
    assert list(validator.iter_errors(plain_data(text))) == []


@pytest.mark.parametrize(
    "name",
    [
        *("unknown-key-top", "unknown-key-robot-no-hint", "unknown-key-camera", "goods-wrong", "stations-wrong"),
        *("lat-lon-and-position", "lat-lon-out-of-range", "lat-lon-wrong-origin"),
        *("missing-schema", "missing-robots", "missing-tasks", "missing-position", "no-robots", "wrong-schema-version"),
        *("robots-mapping", "skills-text", "flag-number", "negative-work-capacity", "zero-speed", "unknown-kind"),
        *(
            "capacity-reserve-1",
            "unknown-objective",
            "suitability-score-above-1",
            "action-unknown",
            "only-robots-empty",
        ),
        *("event-without-happening", "event-with-two-happenings", "map-boundary-in-space", "position-of-one-number"),
    ],
)
def test_the_schema_refuses_what_the_reader_refuses(name, validator):
    data = plain_data((BROKEN / f"{name}.yaml").read_text(encoding="utf-8"))
    assert list(validator.iter_errors(data)) != []
