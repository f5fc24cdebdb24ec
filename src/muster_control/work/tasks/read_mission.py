"""The task that reads values of a mission's text, valid or not."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from muster.mission.errors import ParameterError
from muster_control.work.editing.edits import data_of, size_of

_MOST_VALUES = 50_000  # so that the answer stays small


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"text", "keys"}` -> `{"data"}`: the values of these top-level keys."""
    data = data_of(arguments["text"])
    found = {key: data[key] for key in arguments["keys"] if key in data}
    if size_of(found) > _MOST_VALUES:
        raise ParameterError(f"the mission has too many values; expected at most {_MOST_VALUES} to be shown here")
    return {"data": found}
