"""All tables of one database together."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import text

from muster_control.contract import StoreError
from muster_control.store.actions import ActionTable
from muster_control.store.database import Database, make_file
from muster_control.store.jobs import JobTable
from muster_control.store.log import LogTable
from muster_control.store.migrate import migrate, revision
from muster_control.store.missions import MissionTable
from muster_control.store.plans import PlanTable
from muster_control.store.request_keys import RequestKeyTable
from muster_control.store.runs import RunTable
from muster_control.store.schema import HEAD


@dataclass(frozen=True)
class Store:
    """A database of mission control. Every method of its tables is one transaction, and may be called by any thread.

    Times are of the clock of this machine. What fails in the database raises StoreError.
    """

    database: Database
    missions: MissionTable
    plans: PlanTable
    jobs: JobTable
    runs: RunTable
    log: LogTable
    actions: ActionTable
    request_keys: RequestKeyTable

    @classmethod
    def open(cls, url: str) -> Store:
        """Open a database; make it, or bring it to the newest tables where that is due.

        A new file of SQLite, and its folder, are for this user alone.

        Parameters
        ----------
        url
            `sqlite:///FILE` or `postgresql://USER@HOST/NAME`.

        Raises
        ------
        StoreError
            if it cannot be opened, or was made by a newer Muster.
        ParameterError
            if the URL is none.
        """
        database = Database(url)
        if database.file is not None:
            make_file(database.file)
        try:
            migrate(database)
        except BaseException:
            database.close()
            raise
        tables = (MissionTable, PlanTable, JobTable, RunTable, LogTable, ActionTable, RequestKeyTable)
        return cls(database, *(table(database) for table in tables))  # type: ignore[arg-type]

    def close(self) -> None:
        """End all connections."""
        self.database.close()

    def check(self) -> None:
        """Raise StoreError unless it can be read and written; a full disk shows only where something is written."""
        with self.database.writing() as connection:
            found = revision(connection)
            connection.execute(text("UPDATE alembic_version SET version_num = version_num"))
        if found != HEAD:
            raise StoreError(f"{self.database.name}: its tables are {found}; expected {HEAD}: restart the server")
