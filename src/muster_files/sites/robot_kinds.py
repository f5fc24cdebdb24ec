"""Whether a robot of a site flies or drives: as a flag, a column, or a word about it says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from pathlib import PurePath

from muster_files.sites.decisions import BY
from muster_files.sites.entries import Entry
from muster_files.sites.features import Layer
from muster_files.sites.key_words import MODELS, TYPES
from muster_files.sites.labels import bare, labels_of, names_of, robots_heading
from muster_files.sites.roles import Roles, role_word
from muster_files.sites.vocabulary import AIR, GROUND, meanings, moves


def with_kind(entry: Entry, layer: Layer, roles: Roles) -> Entry:
    """Return the entry; a robot with how it moves, under `moves`, as far as anything says so."""
    if entry.role != "robot":
        return entry
    kind = roles.kind_given(layer, entry.feature) or _stated(entry) or _by_words(entry, layer)
    values = {key: value for key, value in entry.values.items() if key != "moves"}
    whole = entry.reason == "--robots" or entry.reason.startswith(BY)
    named_by = names_of(layer)[0] if whole else (*labels_of(layer, entry.feature), names_of(layer)[0])[0]
    return replace(entry, values=values if kind is None else {**values, "moves": kind}, named_by=named_by)


def _stated(entry: Entry) -> str | None:
    """Return what the columns of the robot say: `air`, `ground`, or a word that the reader of missions refuses."""
    for key in ("moves", "kind"):
        value = entry.values.get(key)
        if isinstance(value, str) and (kind := moves(value)) is not None:
            return kind
        if isinstance(value, str) and (key == "moves" or not role_word(value)):
            return value
    return None


def _by_words(entry: Entry, layer: Layer) -> str | None:
    """Return what the nearest words about the robot say, of its type, name, layer and file; None if they say both."""
    for text in _texts(entry, layer):
        said = meanings(text)
        if AIR in said or GROUND in said:
            return moves(text)
    return None


@lru_cache(maxsize=1024)
def _is_type(heading: str) -> bool:
    """Return whether a heading is one of types or models, of which a table may have several."""
    return bare(heading) in ("type", "model", "class", "category", "platform", "airframe", *TYPES, *MODELS)


def _texts(entry: Entry, layer: Layer) -> Iterator[str]:
    values = entry.feature.values
    yield from (value for heading, value in values.items() if _is_type(heading) and isinstance(value, str))
    for key in ("type", "name", "id", "kinematics"):
        if isinstance(value := entry.values.get(key), str):
            yield value
    yield robots_heading(layer.headings) or ""
    yield layer.name
    yield PurePath(layer.file).stem
