"""`muster missions`."""

import json

import pytest
from tests.cli.yard import table_rows

from muster.library import mission_names

pytestmark = pytest.mark.usefixtures("folder")


def test_missions(muster):
    code, out, err = muster("missions")
    assert (code, err) == (0, "")
    listed = [row[0] for row in table_rows(out)]
    assert [name for name in listed if name in mission_names()] == mission_names()


def test_missions_in_json(muster):
    code, out, err = muster("missions", "--format", "json")
    data = json.loads(out)
    assert (code, err) == (0, "")
    assert [item["name"] for item in data] == mission_names()
    assert all(set(item) == {"name", "robots", "tasks", "description"} for item in data)
    assert all(item["description"] for item in data)
