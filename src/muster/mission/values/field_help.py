"""The fields of a class of the model, for its help: name, type, unit, default and meaning."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import MISSING, Field
from typing import Any

from muster.mission.value_types import Choice, Many, Position

_UNITS = {
    "m": "m",
    "s": "s",
    "mps": "m/s",
    "mps2": "m/s^2",
    "radps": "rad/s",
    "deg": "degrees",
    "px": "pixels",
    "hz": "Hz",
}


def fields_text(fields: Sequence[Field[Any]]) -> str:
    """A section `Parameters`, as docstrings have it."""
    return "\n".join(["Parameters", "----------", *(line for f in fields for line in _lines(f))])


def _lines(f: Field[Any]) -> tuple[str, str]:
    needed = f.default is MISSING and f.default_factory is MISSING
    unless_given = f.default if f.default_factory is MISSING else f.default_factory()
    default = "required" if needed else f"default {_shown(unless_given)}"
    head = f"{f.name} : {', '.join(filter(None, (str(f.type), unit_of(f), default)))}"
    return head, f"    {f.metadata['doc']}{_choices(f.metadata.get('kind'))}"


def _choices(kind: object) -> str:
    """The words of a choice; not of the open one of actions, so that importing the model loads no installed package."""
    one = kind.kind if isinstance(kind, Many) else kind
    return f" ({one.expected})" if isinstance(one, Choice) and isinstance(one.words, tuple) else ""


def unit_of(f: Field[Any]) -> str:
    """As declared; else by the end of the name, as in `speed_mps`; positions are in metres."""
    if f.metadata.get("unit"):
        return str(f.metadata["unit"])
    ending = re.search(r"_([a-z0-9]+)$", f.name)
    if ending is not None and ending[1] in _UNITS:
        return _UNITS[ending[1]]
    kind = f.metadata.get("kind")
    places = isinstance(kind, Position) or (isinstance(kind, Many) and isinstance(kind.kind, Position))
    return "m" if places else ""


def _shown(default: object) -> str:
    plain = isinstance(default, str | int | float | tuple | type(None))
    return repr(default) if plain else f"{type(default).__name__}()"
