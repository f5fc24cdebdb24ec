"""Creates the tables of a new database; migrates those of an older Muster with Alembic, imported only then."""

from __future__ import annotations

from pathlib import Path

from sqlalchemy import Connection, inspect, text

from muster_control.contract import StoreError
from muster_control.store.database import Database
from muster_control.store.schema import HEAD, metadata
from muster_control.store.triggers import triggers

MIGRATIONS = Path(__file__).parent / "migrations"
_LOCK = 0x4D55_5354  # of PostgreSQL: one program migrates, others wait


def revision(connection: Connection) -> str | None:
    """The migration of a database; None if it has no tables of Muster."""
    if not inspect(connection).has_table("alembic_version"):
        return None
    found: str | None = connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
    return found


def migrate(database: Database, folder: Path = MIGRATIONS, head: str = HEAD) -> bool:
    """Migrate a database to `head` in one transaction; returns whether anything was due.

    Raises
    ------
    StoreError
        if it was made by a newer Muster, or cannot be changed.
    """
    with database.reading() as connection:
        if revision(connection) == head:
            return False
    with database.writing() as connection:
        if not database.is_sqlite:
            connection.execute(text(f"SELECT pg_advisory_xact_lock({_LOCK})"))
        found = revision(connection)
        if found == head:  # another program was quicker
            return False
        if found is None and (folder, head) == (MIGRATIONS, HEAD):
            _make(connection)
        else:
            upgrade(connection, database.name, folder, head)
    return True


def _make(connection: Connection) -> None:
    """Create the tables of the newest migration without Alembic, which is faster."""
    metadata.create_all(connection, checkfirst=False)
    for statement in triggers(connection.dialect.name):
        connection.exec_driver_sql(statement)
    key = "version_num VARCHAR(32) NOT NULL CONSTRAINT alembic_version_pkc PRIMARY KEY"
    connection.execute(text(f"CREATE TABLE alembic_version ({key})"))
    connection.execute(text("INSERT INTO alembic_version VALUES (:head)"), {"head": HEAD})


def upgrade(connection: Connection, name: str, folder: Path = MIGRATIONS, head: str = HEAD) -> None:
    """Run the migrations that are due, within a transaction; see `migrate`."""
    from alembic import command
    from alembic.config import Config
    from alembic.script import ScriptDirectory
    from alembic.util.exc import CommandError

    config = Config(attributes={"connection": connection})
    config.set_main_option("script_location", str(folder).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    found = revision(connection)
    known = {script.revision for script in ScriptDirectory.from_config(config).walk_revisions()}
    if found is not None and found not in known:
        raise StoreError(f"{name}: made by a newer Muster (tables {found}); expected {head} or older: upgrade Muster")
    try:
        command.upgrade(config, head)
    except CommandError as error:
        raise StoreError(f"{name}: its tables cannot be brought from {found} to {head}: {error}") from None
