"""Missions: the list, their versions, checking, saving and uploading.

Texts are parsed by workers only. Only missions that can be read are stored.
"""

from __future__ import annotations

import asyncio
import base64
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import PurePath
from typing import Any, Protocol

from muster.mission.errors import MissionError, ParameterError
from muster.mission.ignorable_rules import ignored_rules
from muster.mission.yaml_writer import YAML_SUFFIXES
from muster.planning.mission_readers import converted_suffixes
from muster_control.contract import (
    PAGE_ROWS,
    ConflictError,
    MissionEntry,
    MissionVersion,
    NotFoundError,
    User,
    VersionEntry,
)
from muster_control.services.actions import Actions, Refused, ignore_refusal
from muster_control.services.shipped import AUTHOR, shipped_entries, shipped_summary, shipped_version
from muster_control.services.uploads import (
    as_text,
    check_sizes,
    findings_of,
    mission_input,
    require_file_name,
    site_files,
)
from muster_control.store import Store
from muster_control.store.missions import words_of
from muster_files.sites.readers import READERS

_CONVERTED = (*(f".{name}" for name in READERS), *converted_suffixes())


class Workers(Protocol):
    """The part of the pool of workers that `Missions` needs."""

    async def run(self, task: str, arguments: Mapping[str, Any]) -> dict[str, Any]: ...


class Missions:
    """The missions of a server. Shipped missions are listed too, and stored when they are first used."""

    def __init__(self, store: Store, pool: Workers, refused: Refused = ignore_refusal) -> None:
        self._table = store.missions
        self._actions = Actions(store, refused)
        self._pool = pool

    async def get(self, mission: str, version: int | None = None) -> MissionVersion:
        """A version with its files, by default the newest; a shipped mission that is not stored has version 0.

        Raises
        ------
        NotFoundError
            if there is no such mission or version.
        """
        return await asyncio.to_thread(self._get, mission, version)

    async def stored(self, mission: str) -> MissionVersion:
        """The newest version, stored in the database if it was not: plans and runs refer to it.

        Raises
        ------
        NotFoundError
            if there is no such mission.
        """
        return await asyncio.to_thread(self._stored, mission)

    async def versions(self, mission: str, limit: int = PAGE_ROWS, before: int | None = None) -> list[VersionEntry]:
        """Versions, newest first; only those below `before`, if given.

        Raises
        ------
        NotFoundError
            if there is no such mission.
        """
        return await asyncio.to_thread(self._versions, mission, limit, before)

    async def check(
        self, text: str, files: Mapping[str, bytes], *, ignore: Sequence[str] = (), time_limit: float | None = None
    ) -> dict[str, Any]:
        """What is wrong with a mission: see `work.tasks.check`.

        Raises
        ------
        ParameterError
            if it is too large, a file may not be called so, or a rule to ignore does not exist.
        WorkError
            if the check takes too much time or memory.
        """
        check_sizes(text, files)
        ignored_rules(ignore)
        asked = {"ignore": list(ignore), "time_limit": time_limit}
        return await self._pool.run("check", {"mission": mission_input(text, files, "mission"), **asked})

    async def floor_plan(self, mission: MissionVersion) -> dict[str, Any]:
        """The floor plan of a mission and its place on the earth: see `work.tasks.floor_plan`.

        Raises
        ------
        WorkError
            if it cannot be read.
        """
        return await self._pool.run("floor_plan", {"mission": mission_input(mission.text, mission.files, "mission")})

    async def edit(self, text: str, change: str, *arguments: object) -> str:
        """A text after one of `work.editing.changes.CHANGES`; nothing is stored.

        Raises
        ------
        WorkError
            if the text cannot be changed in this way.
        ParameterError
        """
        check_sizes(text, {})
        wanted = {"text": text, "change": change, "with": arguments}
        return str((await self._pool.run("edit", wanted))["text"])

    async def read_keys(self, text: str, *keys: str) -> dict[str, Any]:
        """The values of some keys of a mission's text, valid or not.

        Raises
        ------
        WorkError
            if it is no YAML, or too much of it.
        ParameterError
        """
        check_sizes(text, {})
        return dict((await self._pool.run("read_mission", {"text": text, "keys": keys}))["data"])

    async def create(
        self, who: User, text: str, files: Mapping[str, bytes] | None = None, name: str | None = None
    ) -> MissionVersion:
        """Create a mission, named `name` or as its text says.

        Raises
        ------
        MissionError
            with everything that is wrong with it.
        ForbiddenError, ParameterError, WorkError
        """
        async with self._actions.of(who, "mission.create", {"name": name or ""}):
            return await self._create(who, text, files or {}, name)

    async def save(
        self,
        who: User,
        mission: str,
        text: str,
        base_version: int,
        files: Mapping[str, bytes] | None = None,
        note: str = "",
    ) -> MissionVersion:
        """Save a new version based on `base_version`; without `files` it keeps the files of that version.

        Raises
        ------
        ConflictError
            if another version was saved since.
        MissionError
            with everything that is wrong with it.
        NotFoundError, ForbiddenError, ParameterError, WorkError
        """
        async with self._actions.of(who, "mission.save", {"mission": mission, "base_version": base_version}):
            if base_version == 0 and mission in shipped_entries():
                await self.stored(mission)
                base_version = 1  # the same text
            kept = (await self.get(mission, base_version)).files if files is None else files
            summary = await self._summary(text, kept, mission)
            return await asyncio.to_thread(self._table.save, mission, text, kept, summary, who.name, note, base_version)

    async def delete(self, who: User, mission: str) -> None:
        """Hide a mission from the list; its plans and runs stay.

        Raises
        ------
        ConflictError
            if the mission ships with Muster.
        NotFoundError, ForbiddenError
        """
        async with self._actions.of(who, "mission.delete", {"mission": mission}):
            if mission in shipped_entries():
                raise ConflictError(f"mission {mission} comes with Muster; expected one that was made here")
            await asyncio.to_thread(self._table.delete, mission)

    async def restore(self, who: User, mission: str) -> None:
        """List a deleted mission again.

        Raises
        ------
        NotFoundError, ForbiddenError
        """
        async with self._actions.of(who, "mission.restore", {"mission": mission}):
            await asyncio.to_thread(self._table.restore, mission)

    async def upload(
        self,
        who: User,
        filename: str,
        data: bytes,
        beside: Mapping[str, bytes] | None = None,
        *,
        name: str | None = None,
        **options: Any,
    ) -> MissionVersion:
        """Create a mission from a file: YAML as it is; files of sites, of the field and of QGroundControl converted.

        `beside` are further files that the file needs, or those of a site that are added to it. The mission is called
        `name`, in its text too; without that as its text says. `options` are those of the worker task `convert`:
        `robots` and `suitability` (names of files of `beside`), `salesmen`, `depot`, and what `answers_of` returns.
        What was read and chosen becomes the note of the version.

        Raises
        ------
        MissionError
            with everything that is wrong with it.
        ForbiddenError, ParameterError, WorkError
        """
        async with self._actions.of(who, "mission.upload", {"file": filename[:200], "bytes": len(data)}):
            require_file_name(filename)
            path = PurePath(filename)
            site: list[str] = []
            note, ledger = "", None
            if path.suffix.lower() in YAML_SUFFIXES:
                text, kept = as_text(filename, data), dict(beside or {})
                site = site_files(text, kept)
            elif path.suffix.lower() not in _CONVERTED:
                expected = f"a name that ends in {', '.join((*YAML_SUFFIXES, *_CONVERTED))}"
                raise ParameterError(f"{filename}: no mission; expected {expected}")
            if site or path.suffix.lower() in _CONVERTED:
                files = {**(beside or {}), filename: data}
                text, kept, note, ledger = await self._converted(
                    filename, files, options | ({"site": site} if site else {})
                )
            made = await self._create(who, text, kept, name, file=path.stem, note=note)
            return replace(made, ledger=ledger)

    async def _converted(
        self, name: str, files: Mapping[str, bytes], options: Mapping[str, Any]
    ) -> tuple[str, dict[str, bytes], str, dict[str, Any] | None]:
        """The mission that a worker makes of files, those of them that it goes on to need, its notes and its ledger."""
        check_sizes("", files)
        packed = {file: base64.b64encode(content).decode("ascii") for file, content in files.items()}
        made = await self._pool.run("convert", {"name": name, "files": packed, **options})
        needed = {file: files[file] for file in made["needs"]}
        return made["text"], needed, "\n".join(made["notes"]), made.get("ledger")

    async def _create(
        self,
        who: User,
        text: str,
        files: Mapping[str, bytes],
        name: str | None,
        *,
        file: str = "",
        note: str = "",
    ) -> MissionVersion:
        """Store a mission; the text of one that was a file gets the name that it is given."""
        summary = await self._summary(text, files, file or name or "mission")
        called = name or str(summary["name"])
        if name and file:
            text = await self.edit(text, "rename", name)
        return await asyncio.to_thread(
            lambda: self._table.create(called, text, files, summary, who.name, note, reserved=shipped_entries())
        )

    async def _summary(self, text: str, files: Mapping[str, bytes], name: str) -> dict[str, Any]:
        """The summary that the list shows of a mission; raises MissionError if it has errors."""
        check_sizes(text, files)
        found = await self._pool.run("check", {"mission": mission_input(text, files, name), "brief": True})
        if found["errors"] or found["summary"] is None:
            raise MissionError(findings_of(found["errors"]))
        summary: dict[str, Any] = found["summary"]
        return summary

    def _get(self, mission: str, version: int | None) -> MissionVersion:
        if version == 0 and mission in shipped_entries():
            return shipped_version(mission)
        try:
            return self._table.get(mission, version)
        except NotFoundError:
            if version is None and mission in shipped_entries():
                return shipped_version(mission)
            raise

    def _stored(self, mission: str) -> MissionVersion:
        newest = self._get(mission, None)
        if newest.version > 0:
            return newest
        try:
            return self._table.create(
                mission, newest.text, newest.files, shipped_summary(mission), AUTHOR, shipped=True
            )
        except ConflictError:  # another request stored it first
            return self._table.get(mission)

    def _versions(self, mission: str, limit: int, before: int | None) -> list[VersionEntry]:
        try:
            return self._table.versions(mission, limit, before)
        except NotFoundError:
            if mission not in shipped_entries():
                raise
            return [VersionEntry(mission=mission, version=0, author=AUTHOR, at=None)]

    async def list(self, limit: int = PAGE_ROWS, after: str = "", search: str = "") -> Sequence[MissionEntry]:
        """Missions made on this server, last changed first, then the shipped ones.

        Parameters
        ----------
        limit
            the greatest number of missions.
        after
            `place_of` the last mission of the page before.
        search
            words that all stand in the name or id of the mission.

        Raises
        ------
        ParameterError
            if `after` is no such place.
        """
        return await asyncio.to_thread(self._list, limit, _place(after), search.casefold().split())

    async def with_text(self, text: str) -> str | None:
        """The id of a mission whose newest version has this text; None if there is none."""
        return await asyncio.to_thread(self._table.with_text, text)

    async def count(self, search: str = "") -> int:
        """How many of the missions made on this server `list` has in all."""
        return await asyncio.to_thread(self._table.count, search.casefold().split())

    async def dimensions(self, mission: str) -> int:
        """How many dimensions the newest version of a mission has; 2 of one that was deleted."""
        known = [*await asyncio.to_thread(self._table.named, [mission]), shipped_entries().get(mission)]
        return next((entry.dimensions for entry in known if entry is not None), 2)

    def _list(
        self, limit: int, after: tuple[datetime | None, str] | None, words: Sequence[str]
    ) -> Sequence[MissionEntry]:
        changed_at, last = after or (None, "")
        own = list[MissionEntry]()
        if changed_at is not None or not last:
            own += self._table.list(limit, words, None if changed_at is None else (changed_at, last))
            if len(own) == limit:
                return own
            last = ""
        shipped = list(shipped_entries().values())
        behind = next((k for k, entry in enumerate(shipped, start=1) if entry.id == last), 0)
        found = [one for one in shipped[behind:] if all(word in words_of(one.id, one.name) for word in words)]
        stored = {entry.id: entry for entry in self._table.named([one.id for one in found])}
        return [*own, *(stored.get(one.id, one) for one in found[: limit - len(own)])]


def place_of(entry: MissionEntry) -> str:
    """The place of a mission in the list of missions, from which the next page goes on."""
    return f"{'' if entry.shipped or entry.changed_at is None else entry.changed_at.isoformat()}~{entry.id}"


def _place(text: str) -> tuple[datetime | None, str] | None:
    """When the mission at a place was changed, None for a shipped one, and its id; None for the beginning."""
    if not text:
        return None
    moment, tilde, mission = text.partition("~")
    try:
        changed_at = datetime.fromisoformat(moment) if moment else None
    except ValueError:
        tilde = ""
    if not tilde or (changed_at is not None and changed_at.tzinfo is None):
        raise ParameterError(f"after: {text}; expected what the address of the next page has")
    return changed_at, mission
