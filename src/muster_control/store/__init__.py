"""The database of mission control: SQLite in one file, or PostgreSQL. Needs the extra `web`.

| part | what it does |
|---|---|
| `urls` | the database of a URL, and its name in messages |
| `database` | connections and transactions; failures become StoreError |
| `failures` | failures of the database as messages for people |
| `schema` | the tables |
| `columns` | types of columns that are equal in both databases |
| `migrate`, `migrations` | bring a database to the newest tables |
| `missions`, `plans`, `jobs`, `runs`, `log`, `actions`, `request_keys` | operations on each group of tables |
| `store` | all tables of a database |
| `backup`, `prune` | copies, and deletion of old rows; imported when needed |
"""

from muster.mission.errors import MissingExtraError

try:
    import sqlalchemy as _sqlalchemy  # noqa: F401 - only whether it is there
except ImportError as error:
    raise MissingExtraError("web", "a database") from error

from muster_control.store.store import Store

__all__ = ["Store"]
