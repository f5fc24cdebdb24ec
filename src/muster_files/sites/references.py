"""What names in a file mean: what that file calls so, else an id of the mission, else what another file calls so."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from muster.mission.errors import Finding
from muster_files.sites.entries import Entry, some_of
from muster_files.sites.plan_areas import tasks_over
from muster_files.sites.roles import is_of_plan

_OF_TASKS = ("prerequisites", "same_robot_as", "other_robot_than", "starts_with")
_OF_ROBOTS = ("only_robots",)
_GROUP_OF = {**dict.fromkeys(_OF_TASKS, "tasks"), "delivers": "tasks", **dict.fromkeys(_OF_ROBOTS, "robots")}
"""The keys of tasks that hold ids, and of what."""

_Meanings = dict[str, dict[int, list[str]]]
"""By name, for each thing that is called so, its ids: several of areas in several parts."""


class References:
    """The names of all files.

    Parameters
    ----------
    known
        the ids of the mission by group, those of the mission to which files are added included.
    """

    def __init__(self, known: Mapping[str, Iterable[str]]) -> None:
        self._known = {group: set(ids) for group, ids in known.items()}
        self._names: dict[tuple[str, str], tuple[_Meanings, _Meanings]] = {}

    def add(self, group: str, entry: Entry, name: str) -> None:
        """Say that a thing has got this id."""
        own = entry.values.get("id") or entry.values.get("name")
        for file in (entry.feature.file, ""):
            first, second = self._names.setdefault((group, file), ({}, {}))
            for told in {name, *([] if own is None else [str(own)])}:
                first.setdefault(told, {}).setdefault(id(entry), []).append(name)
            parts = tasks_over(name, entry) if is_of_plan(entry.feature, "area") else ()
            for told in {*parts, *([] if entry.also is None else [entry.also])}:
                second.setdefault(told, {}).setdefault(id(entry), []).append(name)

    def resolve(self, entry: Entry, record: dict[str, Any], findings: list[Finding]) -> None:
        """Put ids in place of the names in a record; names with nothing but spaces between them are several."""
        for key, group in _GROUP_OF.items():
            given = record.get(key)
            if isinstance(given, str):
                found = self._ids(entry, key, given, findings)
                record[key] = found[0] if found is not None and len(found) == 1 else given
            elif isinstance(given, list) and all(isinstance(name, str) for name in given):
                names = [part for name in given for part in self._split(entry, group, name)]
                ids = [one for name in names for one in self._ids(entry, key, name, findings) or [name]]
                record[key] = list(dict.fromkeys(ids))

    def _split(self, entry: Entry, group: str, name: str) -> Sequence[str]:
        return [name] if self._meanings(entry, group, name) or name in self._known.get(group, ()) else name.split()

    def _ids(self, entry: Entry, key: str, name: str, findings: list[Finding]) -> list[str] | None:
        """What a name means; None where nothing has it, and, with a finding, where several things have it."""
        meanings = self._meanings(entry, _GROUP_OF[key], name)
        if len(meanings) > 1:
            ids = some_of([one for several in meanings.values() for one in several])
            findings.append(entry.finding(key, f"{name} (ambiguous)", f"a name that stands once, or an id: {ids}"))
        return next(iter(meanings.values())) if len(meanings) == 1 else None

    def _meanings(self, entry: Entry, group: str, name: str) -> dict[int, list[str]]:
        for told in self._names.get((group, entry.feature.file), ()):
            if name in told:
                return told[name]
        if name in self._known.get(group, ()):
            return {0: [name]}
        return next((told[name] for told in self._names.get((group, ""), ()) if name in told), {})
