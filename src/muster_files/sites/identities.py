"""By what the tasks, robots and stations of a layer are known: ids, or the names beside ids that are mere numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from muster_files.sites.entries import Entry
from muster_files.sites.features import Layer
from muster_files.sites.keys import AT_POINTS

_NUMBER = re.compile(r"(?:node/|way/|relation/)?\d+")
"""An id that programs give: the number of a row, of a feature, or that of OpenStreetMap."""


_ROLES = (*AT_POINTS, "survey")


def identified(layer: Layer, entries: Sequence[Entry], given: Mapping[str, str], notes: list[str]) -> list[Entry]:
    """The entries of a layer, each with one of its id and its name; references may mean it by the other.

    Names are ids where no two of a role are the same and the ids beside them are numbers, unless a user names the ids
    (`given`).
    """
    chosen = {role: _identified(layer, [e for e in entries if e.role == role], given, notes) for role in _ROLES}
    rest = {role: iter(found) for role, found in chosen.items()}
    return [next(rest[entry.role]) if entry.role in rest else entry for entry in entries]


def _identified(layer: Layer, entries: Sequence[Entry], given: Mapping[str, str], notes: list[str]) -> list[Entry]:
    both = [entry for entry in entries if "id" in entry.values and "name" in entry.values]
    if not both:
        return list(entries)
    id_heading, name_heading = (both[0].columns.heading(key) for key in ("id", "name"))
    kept, lost = "id", "name"
    if given.get("id") != id_heading and _are_numbers(both) and _stand_once(entries):
        kept, lost = lost, kept
        told = f"{name_heading} is the id, not the numbers under {id_heading}; --column id={id_heading} takes those"
    else:
        told = f"not read beside {id_heading}: {name_heading}; --column id={name_heading} takes it for the id"
    if any(entry.values["id"] != entry.values["name"] for entry in both):
        line = f"{layer.title}: {told}"
        notes += [line] if line not in notes else []
    return [_known_by(entry, kept, lost) for entry in entries]


def _are_numbers(entries: Sequence[Entry]) -> bool:
    return all(_NUMBER.fullmatch(str(entry.values["id"])) for entry in entries)


def _stand_once(entries: Sequence[Entry]) -> bool:
    names = [entry.values.get("name") for entry in entries]
    return None not in names and len(set(names)) == len(names)


def _known_by(entry: Entry, kept: str, lost: str) -> Entry:
    if not {kept, lost} <= entry.values.keys():
        return entry
    values = {key: value for key, value in entry.values.items() if key != lost}
    by_key = {key: column for key, column in entry.columns.by_key.items() if key != lost}
    return replace(entry, values=values, columns=replace(entry.columns, by_key=by_key), also=str(entry.values[lost]))
