"""The published JSON Schema of mission files, made from the model.

`python -m muster.mission.json_schema` prints it, with the actions and rules of installed packages; the file beside this
one has those that ship, and is kept equal to it by a test.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import Field
from typing import Any

from muster.mission.action_keys import ACTION_KEYS, ActionKeys
from muster.mission.cooperation import Prerequisite, PrerequisiteOrId
from muster.mission.model import SCHEMA, Action, Mission
from muster.mission.records import Record, all_keys, instead_of, key_of, required, specified
from muster.mission.value_types import JsonSchema, Kind, Many


def mission_schema() -> JsonSchema:
    """JSON Schema (draft 2020-12) of mission YAML."""
    schema = _definition(Mission)
    schema["required"] = ["schema", *schema["required"]]
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "$id": SCHEMA, "title": "Muster mission"}
    definitions: dict[str, JsonSchema] = {}
    _define_parts(Mission, definitions)
    return head | schema | {"$defs": definitions}


def schema_text() -> str:
    return json.dumps(mission_schema(), indent=1) + "\n"


def _define_parts(of: type[Any], found: dict[str, JsonSchema]) -> None:
    """Add the definition of each class that a value of this one may hold."""
    kinds = [kind for f in all_keys(of) for kind in (f.metadata["kind"], *(kind for _, kind, _ in instead_of(f)))]
    for part in (record.of for kind in kinds for record in _records(kind)):
        if part.__name__ not in found:
            found[part.__name__] = _action() if part is Action else _definition(part)
            _define_parts(part, found)


def _records(kind: Kind) -> Iterator[Record]:
    if isinstance(kind, Record):
        yield kind
    elif isinstance(kind, Many):
        yield from _records(kind.kind)
    elif isinstance(kind, PrerequisiteOrId):
        yield Record(Prerequisite, "a prerequisite")


def _definition(of: type[Any]) -> JsonSchema:
    own = all_keys(of)
    properties = {key_of(f): _schema(f) | _described(f) for f in own}
    need = [key_of(f) for f in own if required(f) and not instead_of(f)]
    rules: list[JsonSchema] = []
    for f in own:
        for key, kind, doc in instead_of(f):
            properties[key] = kind.schema() | {"description": doc}
            rules.append(_one_of(f, key))
    choice: JsonSchema = rules[0] if len(rules) == 1 else {"allOf": rules} if rules else {}
    extra: JsonSchema = of.schema_extra()
    return _object(properties, need) | choice | extra


def _one_of(f: Field[Any], key: str) -> JsonSchema:
    """Exactly one of a required field and the key in its place; at most one, where the field is not required."""
    if required(f):
        given: list[JsonSchema] = [{"required": [f.name]}, {"required": [key]}]
        neither = [{"not": {"anyOf": list(given)}} | f.metadata["unless"]] if "unless" in f.metadata else []
        return {"oneOf": given + neither}
    return {"not": {"required": [f.name, key]}}


def _action() -> JsonSchema:
    """One form for each action."""
    return {"oneOf": [_form(name, keys) for name, keys in ACTION_KEYS.usable().items()]}


def _form(name: str, keys: ActionKeys) -> JsonSchema:
    fields = {f.name: f for f in specified(Action)}
    properties: dict[str, JsonSchema] = {"name": {"const": name}}
    for key in keys.names:
        if key in keys.own:
            properties[key] = keys.own[key].kind.schema() | {"description": keys.own[key].doc}
        else:
            kind = fields[key].metadata["kind"].schema()
            properties[key] = (kind if key in keys.needed else _or_null(kind)) | _described(fields[key])
    need = [key for key in keys.needed if not _has_instead(key, fields)]
    return _object(properties, ["name", *need]) | _choices(keys, fields, properties)


def _has_instead(key: str, fields: dict[str, Field[Any]]) -> bool:
    return key in fields and bool(instead_of(fields[key]))


def _choices(keys: ActionKeys, fields: dict[str, Field[Any]], properties: dict[str, JsonSchema]) -> JsonSchema:
    """Keys that stand for fields of an action: added to its properties, and one of each pair at most."""
    rules: list[JsonSchema] = []
    for name in keys.names:
        if _has_instead(name, fields):
            ((key, kind, doc),) = instead_of(fields[name])
            properties[key] = kind.schema() | {"description": doc}
            pair: list[JsonSchema] = [{"required": [name]}, {"required": [key]}]
            rules.append({"oneOf": pair} if name in keys.needed else {"not": {"required": [name, key]}})
    return {"allOf": rules} if rules else {}


def _object(properties: dict[str, JsonSchema], need: list[str]) -> JsonSchema:
    return {"type": "object", "properties": properties, "required": need, "additionalProperties": False}


def _schema(f: Field[Any]) -> JsonSchema:
    """A key whose default is None may also stand without a value."""
    own: JsonSchema = f.metadata["kind"].schema()
    return _or_null(own) if f.default is None else own


def _or_null(schema: JsonSchema) -> JsonSchema:
    return {"anyOf": [schema, {"type": "null"}]}


def _described(f: Field[Any]) -> JsonSchema:
    shown_default = {"default": f.default} if isinstance(f.default, str | int | float) else {}
    return {"description": f.metadata["doc"]} | shown_default


if __name__ == "__main__":
    sys.stdout.write(schema_text())
