"""Areas in exported plans as they were in the mission: with their holes, and once for all their parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from muster_files.sites.entries import Entry
from muster_files.sites.roles import is_of_plan

_Name = tuple[str, str]
"""A file, and a name in it."""


def joined_areas(entries: Sequence[Entry]) -> list[Entry]:
    """The entries, but holes inside their areas, and in place of tasks over areas those areas alone."""
    areas = {_name(e): e for e in entries if e.role == "survey" and is_of_plan(e.feature, "area")}
    if not areas:
        return list(entries)
    holes: dict[_Name, list[Entry]] = {name: [] for name in areas}
    middles: dict[_Name, Entry] = {}
    area_of = {(file, one): (file, name) for (file, name), e in areas.items() for one in tasks_over(name, e)}
    rest = []
    for entry in entries:
        if is_of_plan(entry.feature, "hole") and (of := (entry.feature.file, str(entry.feature.values["of"]))) in holes:
            holes[of].append(entry)
        elif entry.role == "task" and (whole := area_of.get(_name(entry))) is not None:
            middles.setdefault(whole, entry)
        else:
            rest.append(entry)
    return [
        replace(e, holes=tuple(holes[name]), middle=middles.get(name)) if areas.get(name := _name(e)) is e else e
        for e in rest
    ]


def _name(entry: Entry) -> _Name:
    return entry.feature.file, str(entry.values.get("id") or entry.values.get("name"))


def tasks_over(name: str, entry: Entry) -> Sequence[str]:
    """The tasks that cover an area: one of its name, or its parts."""
    split = entry.values.get("split")
    return [f"{name}.{k}" for k in range(1, split + 1)] if isinstance(split, int) else [name]
