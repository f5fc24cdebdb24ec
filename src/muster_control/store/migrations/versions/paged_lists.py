"""Ids of actions are moments, and lists are read in pages: by indexes, and missions by when they were changed."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    if op.get_bind().dialect.name == "postgresql":
        op.execute("ALTER TABLE actions ALTER COLUMN id DROP DEFAULT")
        op.execute("DROP SEQUENCE IF EXISTS actions_id_seq")
        op.execute("ALTER TABLE actions ALTER COLUMN id TYPE BIGINT")
    op.drop_index("ix_actions_run", "actions")
    op.create_index("ix_actions_run_id", "actions", ["run", "id"])
    for table in ("plans", "jobs", "runs"):
        op.create_index(f"ix_{table}_mission_id", table, ["mission", "id"])
    _missions()


def _missions() -> None:
    """The words by which a mission is found, and when it was changed."""
    op.add_column("missions", sa.Column("words", sa.String))
    op.add_column("missions", sa.Column("changed_at", sa.DateTime(timezone=True)))
    connection = op.get_bind()
    missions = sa.table("missions", *map(sa.column, ("id", "newest", "words", "changed_at")))
    versions = sa.table(
        "mission_versions", *map(sa.column, ("mission", "version", "at")), sa.column("summary", sa.JSON)
    )
    newest = sa.and_(versions.c.mission == missions.c.id, versions.c.version == missions.c.newest)
    for mission, at, summary in connection.execute(
        sa.select(missions.c.id, versions.c.at, versions.c.summary).join(versions, newest)
    ).all():
        values = {"words": f"{summary.get('name', mission)} {mission}".casefold(), "changed_at": at}
        connection.execute(sa.update(missions).where(missions.c.id == mission).values(values))
    op.create_index("ix_missions_shipped_hidden_changed_at_id", "missions", ["shipped", "hidden", "changed_at", "id"])
