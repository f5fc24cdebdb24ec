"""Missions and their versions. Equal files are stored once, by their SHA-256."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields
from datetime import UTC, datetime
from hashlib import sha256
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, Select, and_, func, insert, select, tuple_, update

from muster_control.contract import (
    PAGE_ROWS,
    ConflictError,
    MissionEntry,
    MissionVersion,
    NotFoundError,
    VersionEntry,
)
from muster_control.store.database import DatabaseTable, insert_unless_there
from muster_control.store.schema import blobs, mission_files, mission_versions, missions

_LONGEST_ID = 80


class MissionTable(DatabaseTable):
    def get(self, mission: str, version: int | None = None) -> MissionVersion:
        """A version with its files, by default the newest; of a deleted mission only by number.

        Raises
        ------
        NotFoundError
            if there is no such mission or version.
        """
        with self._database.reading() as connection:
            return _version(connection, mission, _newest(connection, mission) if version is None else version)

    def versions(self, mission: str, limit: int = PAGE_ROWS, before: int | None = None) -> list[VersionEntry]:
        """Versions, the newest first; those below `before`, if given.

        Raises
        ------
        NotFoundError
            if there is no such mission.
        """
        query = _VERSIONS.where(mission_versions.c.mission == mission).limit(limit)
        if before is not None:
            query = query.where(mission_versions.c.version < before)
        with self._database.reading() as connection:
            if not _is_taken(connection, mission):
                raise NotFoundError(f"no mission {mission}")
            return [VersionEntry(**row._mapping) for row in connection.execute(query)]

    def create(
        self,
        name: str,
        text: str,
        files: Mapping[str, bytes],
        summary: Mapping[str, Any],
        author: str,
        note: str = "",
        *,
        shipped: bool = False,
        reserved: Collection[str] = (),
    ) -> MissionVersion:
        """Create a mission. Its id is made from the name, with a number if the id exists or is `reserved`.

        A `shipped` mission has its name as id.

        Raises
        ------
        ConflictError
            if the mission is `shipped`, and there already.
        """
        with self._database.writing() as connection:
            if shipped:
                mission = name
                if _is_taken(connection, mission):
                    raise ConflictError(f"mission {mission} is there already")
            else:
                mission = _free_id(connection, name, reserved)
            listed = _listed(mission, 1, summary)
            connection.execute(insert(missions).values(id=mission, shipped=shipped, hidden=False, **listed))
            _write(connection, mission, listed, text, files, summary, author, note)
            return _version(connection, mission, 1)

    def save(
        self,
        mission: str,
        text: str,
        files: Mapping[str, bytes],
        summary: Mapping[str, Any],
        author: str,
        note: str,
        base_version: int,
    ) -> MissionVersion:
        """Save a new version based on `base_version`.

        Raises
        ------
        ConflictError
            if another version was saved since.
        NotFoundError
            if there is no such mission.
        """
        with self._database.writing() as connection:
            newest = _newest(connection, mission, to_write=True)
            if newest != base_version:
                raise ConflictError(
                    f"mission {mission} was changed meanwhile: its newest version is {newest}, yours was made from "
                    f"{base_version}; look at the newest, and save again"
                )
            listed = _listed(mission, newest + 1, summary)
            connection.execute(update(missions).where(missions.c.id == mission).values(listed))
            _write(connection, mission, listed, text, files, summary, author, note)
            return _version(connection, mission, newest + 1)

    def delete(self, mission: str) -> None:
        """Take it out of the list; its versions, plans and runs stay.

        Raises
        ------
        NotFoundError
            if there is no such mission.
        """
        with self._database.writing() as connection:
            _newest(connection, mission, to_write=True)
            connection.execute(update(missions).where(missions.c.id == mission).values(hidden=True))

    def restore(self, mission: str) -> None:
        """Put it into the list again.

        Raises
        ------
        NotFoundError
            if there never was such a mission.
        """
        with self._database.writing() as connection:
            if not _is_taken(connection, mission):
                raise NotFoundError(f"no mission {mission}")
            connection.execute(update(missions).where(missions.c.id == mission).values(hidden=False))

    def list(
        self, limit: int = PAGE_ROWS, words: Sequence[str] = (), after: tuple[datetime, str] | None = None
    ) -> Sequence[MissionEntry]:
        """Missions that were made here and not deleted, last changed first.

        Parameters
        ----------
        limit
            the greatest number of missions.
        words
            that all stand in the name or id of the mission.
        after
            when the last mission of the page before was changed, and its id.
        """
        query = _ENTRIES.where(*_made_here(words)).order_by(missions.c.changed_at.desc(), missions.c.id.desc())
        if after is not None:
            last = tuple_(*after, types=[missions.c.changed_at.type, missions.c.id.type])
            query = query.where(tuple_(missions.c.changed_at, missions.c.id) < last)
        return self._read(query.limit(limit))

    def with_text(self, text: str) -> str | None:
        """The id of a mission whose newest version has this text; None if there is none."""
        if "\0" in text:  # no text that is stored has one; a file of another kind may
            return None
        query = select(missions.c.id).join(mission_versions, _NEWEST).where(mission_versions.c.text == text)
        with self._database.reading() as connection:
            found: str | None = connection.execute(query.where(~missions.c.hidden).limit(1)).scalar()
        return found

    def count(self, words: Sequence[str] = ()) -> int:
        """How many missions `list` has in all."""
        with self._database.reading() as connection:
            query = select(func.count()).select_from(missions).where(*_made_here(words))
            return int(connection.execute(query).scalar_one())

    def named(self, names: Collection[str]) -> Sequence[MissionEntry]:
        """Those of these missions that are stored and were not deleted."""
        return self._read(_ENTRIES.where(missions.c.id.in_(names), ~missions.c.hidden))

    def _read(self, query: Select[Any]) -> Sequence[MissionEntry]:
        with self._database.reading() as connection:
            return [_entry(row) for row in connection.execute(query)]


def _made_here(words: Sequence[str]) -> list[ColumnElement[bool]]:
    named = (missions.c.words.contains(word, autoescape=True) for word in words)
    return [~missions.c.shipped, ~missions.c.hidden, *named]


_NEWEST = and_(mission_versions.c.mission == missions.c.id, mission_versions.c.version == missions.c.newest)
_ENTRIES = select(missions, mission_versions.c.summary).join(mission_versions, _NEWEST)

_VERSIONS = select(*(mission_versions.c[each.name] for each in fields(VersionEntry))).order_by(
    mission_versions.c.version.desc()
)


def _entry(row: Row[Any]) -> MissionEntry:
    shown = _of_summary(row.summary, row.id)
    return MissionEntry(id=row.id, shipped=row.shipped, version=row.newest, changed_at=row.changed_at, **shown)


def _of_summary(summary: Mapping[str, Any], mission: str) -> dict[str, Any]:
    counts = {key: summary.get(key, 0) for key in ("robots", "tasks", "dimensions")}
    return {"name": summary.get("name", mission), **counts}


def _listed(mission: str, newest: int, summary: Mapping[str, Any]) -> dict[str, Any]:
    """What the list of missions is read by."""
    return {"newest": newest, "words": words_of(mission, summary.get("name", mission)), "changed_at": datetime.now(UTC)}


def words_of(mission: str, name: str) -> str:
    """The text in which words are looked for that name a mission."""
    return f"{name} {mission}".casefold()


def _newest(connection: Connection, mission: str, *, to_write: bool = False) -> int:
    query = select(missions.c.newest).where(missions.c.id == mission, ~missions.c.hidden)
    newest: int | None = connection.execute(query.with_for_update() if to_write else query).scalar()
    if newest is None:
        raise NotFoundError(f"no mission {mission}")
    return newest


def _version(connection: Connection, mission: str, version: int) -> MissionVersion:
    which = (mission_versions.c.mission == mission, mission_versions.c.version == version)
    row = connection.execute(select(mission_versions).where(*which)).one_or_none()
    if row is None:
        raise NotFoundError(f"no mission {mission} of version {version}")
    named = (mission_files.c.mission == mission, mission_files.c.version == version)
    query = select(mission_files.c.name, blobs.c.data).join(blobs, blobs.c.sha256 == mission_files.c.sha256)
    files = connection.execute(query.where(*named).order_by(mission_files.c.name))
    return _without_files(row, {name: bytes(data) for name, data in files})


def _without_files(row: Row[Any], files: Mapping[str, bytes] | None = None) -> MissionVersion:
    return MissionVersion(
        mission=row.mission,
        version=row.version,
        text=row.text,
        author=row.author,
        at=row.at,
        note=row.note,
        files=files or {},
    )


def _write(
    connection: Connection,
    mission: str,
    listed: Mapping[str, Any],
    text: str,
    files: Mapping[str, bytes],
    summary: Mapping[str, Any],
    author: str,
    note: str,
) -> None:
    version = listed["newest"]
    row = {"text": text, "summary": dict(summary), "author": author, "note": note, "at": listed["changed_at"]}
    connection.execute(insert(mission_versions).values(mission=mission, version=version, **row))
    for name, data in files.items():
        digest = _keep(connection, data)
        connection.execute(insert(mission_files).values(mission=mission, version=version, name=name, sha256=digest))


def _keep(connection: Connection, data: bytes) -> str:
    """Store a blob unless it exists; returns its digest."""
    digest = sha256(data).hexdigest()
    insert_unless_there(connection, blobs, {"sha256": digest, "data": data})
    return digest


def _free_id(connection: Connection, name: str, reserved: Collection[str]) -> str:
    plain = slug(name)
    mission, k = plain, 2
    while mission in reserved or _is_taken(connection, mission):
        mission, k = f"{plain}-{k}", k + 1
    return mission


def _is_taken(connection: Connection, mission: str) -> bool:
    return connection.execute(select(missions.c.id).where(missions.c.id == mission)).scalar() is not None


def slug(name: str) -> str:
    """A name for URLs: ASCII letters and digits with `-`, `_` and `.` between them."""
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9._-]+", "-", plain)[:_LONGEST_ID].strip("-._") or "mission"
