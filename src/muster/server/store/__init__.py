"""The database of mission control: SQLite in one file, or PostgreSQL. Needs the extra `web`.

| part | what it does |
|---|---|
| `urls` | which database a URL means, and how it is called in messages |
| `database` | connections and transactions; failures become StoreError |
| `failures` | what a failure of the database means for a person |
| `schema` | the tables |
| `columns` | kinds of columns that read the same from both databases |
| `migrate`, `migrations` | bring a database to the newest tables |
| `missions`, `plans`, `jobs`, `runs`, `log`, `actions` | what is done with each group of tables |
| `store` | all of it together |
| `backup`, `prune` | copies, and what is thrown away; imported when asked for |
"""

from muster.mission.errors import MissingExtraError

try:
    import sqlalchemy as _sqlalchemy  # noqa: F401 - only whether it is there
except ImportError as error:
    raise MissingExtraError("web", "a database") from error

from muster.server.store.store import Store

__all__ = ["Store"]
