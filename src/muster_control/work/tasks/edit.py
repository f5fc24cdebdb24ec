"""The task that edits a mission's text."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.value_types import shown
from muster_control.work.editing.changes import CHANGES


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"text", "change", "with"}` -> `{"text"}`: `change` is one of CHANGES, `with` what it takes beside the text."""
    name = arguments["change"]
    if name not in CHANGES:
        raise ParameterError(f"change: {shown(name)}; expected {', '.join(CHANGES)}")
    return {"text": CHANGES[name](arguments["text"], *arguments["with"])}
