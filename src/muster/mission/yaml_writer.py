"""Missions as YAML: what `reading.yaml_reader` reads back to an equal mission. Defaults are left out."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import Field, replace
from os.path import relpath
from pathlib import Path
from typing import Any, TypeVar

from muster.mission.mission_data import MissionData
from muster.mission.records import key_of, specified
from muster.mission.source import IN_PYTHON
from muster.mission.value_types import Kind

YAML_SUFFIXES = (".yaml", ".yml")
"""How names of mission files in YAML end."""
M = TypeVar("M", bound=MissionData)


def yaml_text(mission: MissionData) -> str:
    """The mission as YAML of `schema: muster/1`; one line a robot and task."""
    lines: list[str] = []
    for name, data in file_data(mission).items():
        if isinstance(data, list) and data:
            lines += [f"{name}:", *(f"  - {flow_text(item)}" for item in data)]
        elif name == "suitability" and isinstance(data, dict):
            lines += [f"{name}:", *(f"  {_word(row)}: {flow_text(scores)}" for row, scores in data.items())]
        else:
            lines.append(f"{name}: {flow_text(data)}")
    return "\n".join(lines) + "\n"


def file_data(mission: MissionData) -> dict[str, Any]:
    """The mission as the plain data of a file; defaults are left out."""
    fields = [f for f in specified(MissionData) if f.name == "schema" or getattr(mission, f.name) != f.default]
    return {f.name: _file_form(f, mission) for f in fields}


def with_files_from(mission: M, folder: Path) -> M:
    """The mission as a file in that folder has it: the names of other files lead to them from there."""
    origin = Path(mission.source.file).parent
    if mission.source is IN_PYTHON or origin.resolve() == folder.resolve():
        return mission

    def moved(name: str | None) -> str | None:
        return name if name is None else relpath(origin / name, folder)

    changes: dict[str, Any] = {}
    if mission.map is not None:
        changes["map"] = replace(mission.map, ros_yaml=moved(mission.map.ros_yaml), image=moved(mission.map.image))
    if mission.travel is not None:
        changes["travel"] = {kind: moved(name) for kind, name in mission.travel.items()}
    return replace(mission, **changes)


def plain(value: Any) -> Any:
    """A value of the model as plain data; defaults of records are left out."""
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if hasattr(value, "__dataclass_fields__"):
        fields = specified(type(value))
        given = {key_of(f): _file_form(f, value) for f in fields if _file_value(f, value) != f.default}
        return given | _further(value)
    return value


def _further(value: Any) -> dict[str, Any]:
    """The keys of a record beside its own."""
    extra = getattr(value, "extra", {})
    keys = value.further_keys(vars(value)) if extra else {}
    return {key: _plain_of(keys[key].kind, item) for key, item in extra.items()}


def _file_value(f: Field[Any], value: Any) -> Any:
    """The value of a field's key in a file."""
    return value.file_values().get(f.name, getattr(value, f.name))


def _file_form(f: Field[Any], value: Any) -> Any:
    """The value of a field's key as plain data."""
    return _plain_of(f.metadata["kind"], _file_value(f, value))


def _plain_of(kind: Kind, item: Any) -> Any:
    form = getattr(kind, "file_form", None)
    return plain(item if form is None or item is None else form(item))


def flow_text(data: Any) -> str:
    """Plain data as YAML on one line, as it may stand anywhere in a mission file."""
    if isinstance(data, dict):
        return "{" + ", ".join(f"{_word(key)}: {flow_text(item)}" for key, item in data.items()) + "}"
    if isinstance(data, list):
        return "[" + ", ".join(flow_text(item) for item in data) + "]"
    if isinstance(data, str):
        return _word(data)
    if isinstance(data, float) and data.is_integer() and abs(data) < 1e15:
        return str(int(data))
    return json.dumps(data)


def _word(text: str) -> str:
    """A text bare where it cannot be taken for anything else, otherwise quoted."""
    bare = text.replace("_", "").replace("-", "").replace("/", "").replace("+", "").replace(".", "")
    plain_word = bare.isascii() and bare.isalnum() and text[0].isalpha()
    if text.isdecimal() and text.isascii() and (text == "0" or text[0] != "0") and len(text) < 18:
        return text
    return (
        text if plain_word and text.lower() not in ("null", "true", "false") else json.dumps(text, ensure_ascii=False)
    )
