"""The published JSON Schema of mission files, made from the model.

`python -m muster.mission.json_schema` prints it; the file beside this one is kept equal to it by a test.
"""

from __future__ import annotations

import json
import sys

from muster.mission.model import SCHEMA, Mission
from muster.mission.value_types import JsonSchema, Record


def mission_schema() -> JsonSchema:
    """JSON Schema (draft 2020-12) of mission YAML."""
    schema = Record(Mission, "a mission").schema()
    schema["required"] = ["schema", *schema["required"]]
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "$id": SCHEMA, "title": "Muster mission"}
    return head | schema


def schema_text() -> str:
    return json.dumps(mission_schema(), indent=1) + "\n"


if __name__ == "__main__":
    sys.stdout.write(schema_text())
