"""The first tables, and the triggers that make the log of a run append-only."""

from typing import Any

import sqlalchemy as sa
from alembic import op

from muster_control.store.triggers import triggers

revision = "0001"
down_revision = None


def upgrade() -> None:
    _missions()
    _plans_and_jobs()
    _runs()
    for statement in triggers(op.get_bind().dialect.name):
        op.execute(statement)


def _always(name: str, kind: Any, *more: Any) -> sa.Column[Any]:
    return sa.Column(name, kind, *more, nullable=False)


def _number() -> sa.Column[Any]:
    return sa.Column("id", sa.Integer, primary_key=True)


def _time(name: str, *, nullable: bool = False) -> sa.Column[Any]:
    return sa.Column(name, sa.DateTime(timezone=True), nullable=nullable)


def _of_a_version(table: str, version: str) -> sa.ForeignKeyConstraint:
    columns = ["mission", version]
    name = f"fk_{table}_{'_'.join(columns)}"
    return sa.ForeignKeyConstraint(columns, ["mission_versions.mission", "mission_versions.version"], name=name)


def _reference(table: str, column: str, to: str) -> sa.ForeignKeyConstraint:
    return sa.ForeignKeyConstraint([column], [to], name=f"fk_{table}_{column}")


def _missions() -> None:
    op.create_table(
        "missions",
        sa.Column("id", sa.String),
        _always("newest", sa.Integer),
        _always("shipped", sa.Boolean),
        _always("hidden", sa.Boolean),
        sa.PrimaryKeyConstraint("id", name="pk_missions"),
    )
    op.create_table(
        "mission_versions",
        sa.Column("mission", sa.String),
        sa.Column("version", sa.Integer),
        _always("text", sa.String),
        _always("summary", sa.JSON),
        _always("author", sa.String),
        _always("note", sa.String),
        _time("at"),
        sa.PrimaryKeyConstraint("mission", "version", name="pk_mission_versions"),
        _reference("mission_versions", "mission", "missions.id"),
    )
    op.create_table(
        "blobs",
        sa.Column("sha256", sa.String),
        _always("data", sa.LargeBinary),
        sa.PrimaryKeyConstraint("sha256", name="pk_blobs"),
    )
    op.create_table(
        "mission_files",
        sa.Column("mission", sa.String),
        sa.Column("version", sa.Integer),
        sa.Column("name", sa.String),
        _always("sha256", sa.String),
        sa.PrimaryKeyConstraint("mission", "version", "name", name="pk_mission_files"),
        _of_a_version("mission_files", "version"),
        _reference("mission_files", "sha256", "blobs.sha256"),
    )


def _plans_and_jobs() -> None:
    op.create_table(
        "plans",
        _number(),
        _always("mission", sa.String),
        _always("mission_version", sa.Integer),
        _always("version", sa.Integer),
        _always("origin", sa.String),
        _always("author", sa.String),
        _time("at"),
        _always("head", sa.JSON),
        _always("body", sa.JSON),
        _of_a_version("plans", "mission_version"),
        sa.UniqueConstraint("mission", "version", name="uq_plans_mission_version"),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "jobs",
        _number(),
        _always("kind", sa.String),
        _always("state", sa.String),
        _always("mission", sa.String),
        _always("mission_version", sa.Integer),
        _always("arguments", sa.JSON),
        _always("author", sa.String),
        _time("asked_at"),
        _time("begun_at", nullable=True),
        _time("ended_at", nullable=True),
        sa.Column("progress", sa.JSON),
        sa.Column("result", sa.JSON),
        _always("error", sa.String),
        _of_a_version("jobs", "mission_version"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_jobs_state", "jobs", ["state"])


def _runs() -> None:
    op.create_table(
        "runs",
        _number(),
        _always("mission", sa.String),
        _always("mission_version", sa.Integer),
        _always("plan", sa.Integer),
        _always("world", sa.String),
        _always("settings", sa.JSON),
        sa.Column("speed", sa.Float),
        _always("state", sa.String),
        _always("time_s", sa.Float),
        _always("author", sa.String),
        _time("at"),
        _time("ended_at", nullable=True),
        _always("resumed", sa.Integer),
        _always("remark", sa.String),
        sa.Column("report", sa.JSON),
        _of_a_version("runs", "mission_version"),
        _reference("runs", "plan", "plans.id"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_runs_state", "runs", ["state"])
    op.create_table(
        "entries",
        sa.Column("run", sa.Integer),
        sa.Column("seq", sa.Integer),
        _always("time_s", sa.Float),
        _always("kind", sa.String),
        _always("data", sa.JSON),
        _time("at"),
        sa.PrimaryKeyConstraint("run", "seq", name="pk_entries"),
        _reference("entries", "run", "runs.id"),
    )
    op.create_table(
        "stretches",
        sa.Column("run", sa.Integer),
        sa.Column("seq", sa.Integer),
        _always("from_s", sa.Float),
        _always("until_s", sa.Float),
        _always("data", sa.LargeBinary),
        sa.PrimaryKeyConstraint("run", "seq", name="pk_stretches"),
        _reference("stretches", "run", "runs.id"),
    )
    op.create_table(
        "actions",
        _number(),
        _time("at"),
        _always("who", sa.String),
        _always("role", sa.String),
        _always("address", sa.String),
        _always("verb", sa.String),
        _always("data", sa.JSON),
        sa.Column("run", sa.Integer),
        sa.Column("applied_s", sa.Float),
        _always("outcome", sa.String),
        _reference("actions", "run", "runs.id"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_actions_run", "actions", ["run"])
    op.create_table("pruning", sa.Column("run", sa.Integer, primary_key=True, autoincrement=False))
