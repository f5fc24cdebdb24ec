"""Databases of older Musters are brought on; a new one has the tables that the code knows."""

import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest
from sqlalchemy import text

from muster_control.contract import User
from muster_control.store import Store
from muster_control.store.database import Database
from muster_control.store.migrate import MIGRATIONS, migrate, revision, upgrade
from muster_control.store.schema import HEAD, metadata
from muster_control.store.triggers import triggers

LATER = '''
"""Runs have a colour."""
import sqlalchemy as sa
from alembic import op
revision, down_revision = "later", "{head}"
def upgrade() -> None:
    op.add_column("runs", sa.Column("colour", sa.String, nullable=False, server_default="blue"))
{more}
'''


def later(tmp_path, more=""):
    """The migrations, and one that is still to come."""
    folder = tmp_path / "migrations"
    shutil.copytree(MIGRATIONS, folder)
    (folder / "versions" / "later.py").write_text(LATER.format(head=HEAD, more=more))
    return folder


TRIGGERS = {
    "sqlite": "SELECT name, sql FROM sqlite_master WHERE type = 'trigger'",
    "postgresql": "SELECT tgname, pg_get_triggerdef(t.oid) || pg_get_functiondef(tgfoid) FROM pg_trigger t"
    " WHERE NOT tgisinternal",
}


@pytest.fixture(params=["made at once", "by all migrations"])
def new(request, database_url):
    """A new database."""
    database = Database(database_url)
    if request.param == "made at once":
        assert migrate(database)
    else:
        with database.writing() as connection:
            upgrade(connection, database.name)
    yield database
    database.close()


def test_tables_are_those_that_the_code_knows(new):
    from alembic.autogenerate import compare_metadata
    from alembic.migration import MigrationContext

    with new.reading() as connection:
        assert revision(connection) == HEAD
        context = MigrationContext.configure(connection, opts={"compare_server_default": True})
        assert compare_metadata(context, metadata) == []
    assert not migrate(new)


def test_logs_are_guarded_in_the_same_way(new):
    with new.reading() as connection:
        made = connection.execute(text(TRIGGERS[connection.dialect.name])).all()
        words = " ".join(sql for _, sql in made)
    assert len(made) == 6
    for statement in triggers("sqlite" if new.is_sqlite else "postgresql"):
        name = statement.split()[2].removesuffix("()")
        assert name in words
        if new.is_sqlite:
            assert statement in words


def test_an_older_database_is_brought_on(filled, tmp_path):
    """It keeps its rows, its triggers; and a second time there is nothing to do."""
    filled.store.log.append(filled.run, 1.0, [filled.entry(1)])
    folder = later(tmp_path)
    assert migrate(filled.store.database, folder, "later")
    assert not migrate(filled.store.database, folder, "later")
    with filled.store.database.reading() as connection:
        assert connection.execute(text("SELECT colour FROM runs")).scalars().all() == ["blue"]
    assert filled.store.log.append(filled.run, 1.0, [filled.entry(1), filled.entry(2)]) == 1


OF_0002 = (
    "INSERT INTO missions (id, newest, shipped, hidden) VALUES ('yard', 2, false, false)",
    "INSERT INTO mission_versions VALUES ('yard', 1, 'a', '{}', 'ann', '', '2026-01-01 08:00:00')",
    "INSERT INTO mission_versions"
    " VALUES ('yard', 2, 'b', '{\"name\": \"Werft Süd\"}', 'ann', '', '2026-01-02 08:00:00')",
    "INSERT INTO actions (at, who, role, address, verb, data, outcome)"
    " VALUES ('2026-01-01 08:00:00', 'ann', 'command', '', 'login', '{}', 'done')",
)
"""Rows as a Muster of tables 0002 has written them."""


def test_missions_and_actions_of_an_older_muster_are_listed(database_url):
    database = Database(database_url)
    with database.writing() as connection:
        upgrade(connection, database.name, MIGRATIONS, "0002")
        for statement in OF_0002:
            connection.exec_driver_sql(statement)
    database.close()
    store = Store.open(database_url)
    (mission,) = store.missions.list(words=["süd", "yard"])
    assert (mission.name, mission.version, mission.changed_at.day) == ("Werft Süd", 2, 2)
    assert store.missions.get("yard", 1).text == "a"
    new = store.actions.add(User("bo", "command"), "login", {})
    assert [(action.id, action.who) for action in store.actions.list()] == [(new.id, "bo"), (1, "ann")]
    assert new.id > 2**48
    store.close()


def test_a_migration_that_fails_leaves_everything_as_it_was(filled, tmp_path):
    folder = later(tmp_path, "    raise RuntimeError('half-way')")
    with pytest.raises(RuntimeError, match="half-way"):
        migrate(filled.store.database, folder, "later")
    with filled.store.database.reading() as connection:
        assert revision(connection) == HEAD
        assert "colour" not in connection.execute(text("SELECT * FROM runs")).one()._mapping
    filled.store.check()


def test_two_who_open_a_new_database_at_once(database_url):
    with ThreadPoolExecutor(4) as threads:
        stores = list(threads.map(lambda _: Store.open(database_url), range(4)))
    for store in stores:
        store.check()
        store.close()


@pytest.mark.long(keep=1)
def test_alembic_is_imported_only_for_a_database_of_an_older_muster(database_url):
    code = (
        "import sys\nfrom muster_control.store import Store\n"
        "for _ in range(2): Store.open(sys.argv[1]).close()\n"
        "heavy = {'alembic', 'sqlalchemy.orm', 'scipy', 'shapely', 'matplotlib', 'numpy'}\n"
        "print(sorted(heavy & sys.modules.keys()))"
    )
    done = subprocess.run([sys.executable, "-c", code, database_url], capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("[]\n", "")


def test_a_path_with_percent_signs(tmp_path):
    folder = tmp_path / "100% here"
    shutil.copytree(MIGRATIONS, folder)
    database = Database(f"sqlite:///{tmp_path}/new.db")
    assert migrate(database, folder)
    assert not migrate(database)
    database.close()
