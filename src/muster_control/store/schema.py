"""The tables. Every change here needs a migration; a test compares both.

`HEAD` is the newest migration: a database that has it is opened without a look at the others.
"""

from __future__ import annotations

from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    Column,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    Table,
    UniqueConstraint,
)

from muster_control.store.columns import Instant, Number, Text

HEAD = "0004"

metadata = MetaData(
    naming_convention={
        "pk": "pk_%(table_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    }
)


def _always(name: str, kind: Any, *more: Any) -> Column[Any]:
    return Column(name, kind, *more, nullable=False)


def _json() -> JSON:
    return JSON(none_as_null=True)


def _numbered(name: str, *columns: Any) -> Table:
    """A table whose rows are numbered; no number is given twice, also when its row is gone."""
    return Table(name, metadata, Column("id", Integer, primary_key=True), *columns, sqlite_autoincrement=True)


def _of_a_version() -> ForeignKeyConstraint:
    return ForeignKeyConstraint(
        ["mission", "mission_version"], ["mission_versions.mission", "mission_versions.version"]
    )


missions = Table(
    "missions",
    metadata,
    Column("id", Text, primary_key=True),
    _always("newest", Integer),
    _always("shipped", Boolean),
    _always("hidden", Boolean),
    Column("words", Text),
    Column("changed_at", Instant),
    Index(None, "shipped", "hidden", "changed_at", "id"),
)
"""`words` are those by which a mission is found; `changed_at` is of its newest version. Both are always there."""

mission_versions = Table(
    "mission_versions",
    metadata,
    Column("mission", Text, ForeignKey("missions.id"), primary_key=True),
    Column("version", Integer, primary_key=True),
    _always("text", Text),
    _always("summary", _json()),
    _always("author", Text),
    _always("note", Text),
    _always("at", Instant),
)

blobs = Table(
    "blobs",
    metadata,
    Column("sha256", Text, primary_key=True),
    _always("data", LargeBinary),
)

mission_files = Table(
    "mission_files",
    metadata,
    Column("mission", Text, primary_key=True),
    Column("version", Integer, primary_key=True),
    Column("name", Text, primary_key=True),
    _always("sha256", Text, ForeignKey("blobs.sha256")),
    ForeignKeyConstraint(["mission", "version"], ["mission_versions.mission", "mission_versions.version"]),
)

plans = _numbered(
    "plans",
    _always("mission", Text),
    _always("mission_version", Integer),
    _always("version", Integer),
    _always("origin", Text),
    _always("author", Text),
    _always("at", Instant),
    _always("head", _json()),
    _always("body", _json()),
    _of_a_version(),
    UniqueConstraint("mission", "version"),
    Index(None, "mission", "id"),
)

jobs = _numbered(
    "jobs",
    _always("kind", Text),
    _always("state", Text),
    _always("mission", Text),
    _always("mission_version", Integer),
    _always("arguments", _json()),
    _always("author", Text),
    _always("asked_at", Instant),
    Column("begun_at", Instant),
    Column("ended_at", Instant),
    Column("progress", _json()),
    Column("result", _json()),
    _always("error", Text),
    _of_a_version(),
    Index(None, "state"),
    Index(None, "mission", "id"),
)

runs = _numbered(
    "runs",
    _always("mission", Text),
    _always("mission_version", Integer),
    _always("plan", Integer, ForeignKey("plans.id")),
    _always("world", Text),
    _always("settings", _json()),
    Column("speed", Number),
    _always("state", Text),
    _always("time_s", Number),
    _always("author", Text),
    _always("at", Instant),
    Column("ended_at", Instant),
    _always("resumed", Integer),
    _always("remark", Text),
    Column("report", _json()),
    _of_a_version(),
    Index(None, "state"),
    Index(None, "mission", "id"),
)

entries = Table(
    "entries",
    metadata,
    Column("run", Integer, ForeignKey("runs.id"), primary_key=True),
    Column("seq", Integer, primary_key=True),
    _always("time_s", Number),
    _always("kind", Text),
    _always("data", _json()),
    _always("at", Instant),
)

stretches = Table(
    "stretches",
    metadata,
    Column("run", Integer, ForeignKey("runs.id"), primary_key=True),
    Column("seq", Integer, primary_key=True),
    _always("from_s", Number),
    _always("until_s", Number),
    _always("data", LargeBinary),
)

checkpoints = Table(
    "checkpoints",
    metadata,
    Column("run", Integer, ForeignKey("runs.id"), primary_key=True),
    Column("seq", Integer, primary_key=True),
    _always("data", LargeBinary),
    _always("facts", _json()),
)
"""The last checkpoints of each run, from which it is resumed with the entries that follow."""

bodies = Table(
    "bodies",
    metadata,
    Column("run", Integer, ForeignKey("runs.id"), primary_key=True),
    _always("data", _json()),
)
"""Where the bodies of a simulated run are, as of its last entries and tracks."""

actions = Table(
    "actions",
    metadata,
    Column("id", BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=False),
    _always("at", Instant),
    _always("who", Text),
    _always("role", Text),
    _always("address", Text),
    _always("verb", Text),
    _always("data", _json()),
    Column("run", Integer, ForeignKey("runs.id")),
    Column("applied_s", Number),
    _always("outcome", Text),
    Index(None, "run", "id"),
)

request_keys = Table(
    "request_keys",
    metadata,
    Column("user", Text, primary_key=True),
    Column("key", Text, primary_key=True),
    _always("digest", Text),
    _always("made", Integer),
    _always("at", Instant),
)
"""What each request made that came with a key: the id of a run or job."""

pruning = Table(
    "pruning",
    metadata,
    Column("run", Integer, primary_key=True, autoincrement=False),
)
"""Runs whose log may be deleted: a row stands here within the transaction that prunes it alone."""
