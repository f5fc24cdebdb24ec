"""The triggers that make the log of a run append-only, as of migration 0001; changes need a migration.

A log takes an entry at its end alone, and none is changed or taken out, whoever asks. Refused are UPDATE, DELETE unless
it prunes (see `schema.pruning`), and INSERT of an entry that is there (also as INSERT OR REPLACE) or leaves a gap.
"""

from __future__ import annotations

_LOGS = ("entries", "stretches")
_PRUNED = "EXISTS (SELECT 1 FROM pruning WHERE run = OLD.run)"


def triggers(dialect: str) -> list[str]:
    """The statements that make them, in the words of `sqlite` or `postgresql`."""
    of_log = _sqlite_triggers if dialect == "sqlite" else _postgresql_triggers
    return [statement for log in _LOGS for statement in of_log(log)]


def _sqlite_triggers(log: str) -> list[str]:
    follows = f"(SELECT coalesce(max(seq), 0) + 1 FROM {log} WHERE run = NEW.run)"  # noqa: S608 - names of tables
    refuse = f"BEGIN SELECT RAISE(ABORT, '{log}: the log of a run only grows'); END"
    return [
        f"CREATE TRIGGER {log}_insert BEFORE INSERT ON {log} WHEN NEW.seq IS NOT {follows} {refuse}",
        f"CREATE TRIGGER {log}_update BEFORE UPDATE ON {log} {refuse}",
        f"CREATE TRIGGER {log}_delete BEFORE DELETE ON {log} WHEN NOT {_PRUNED} {refuse}",
    ]


def _postgresql_triggers(log: str) -> list[str]:
    refuse = f"RAISE EXCEPTION '{log}: the log of a run only grows'"
    follows = f"(SELECT coalesce(max(seq), 0) + 1 FROM {log} WHERE run = NEW.run)"  # noqa: S608 - names of tables

    def function(name: str, body: str) -> str:
        return f"CREATE FUNCTION {log}_{name}() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN {body} END $$"

    def trigger(name: str, event: str, each: str = "ROW") -> str:
        return f"CREATE TRIGGER {log}_{name} BEFORE {event} ON {log} FOR EACH {each} EXECUTE FUNCTION {log}_{name}()"

    return [
        function("grows", f"IF NEW.seq IS DISTINCT FROM {follows} THEN {refuse}; END IF; RETURN NEW;"),
        function("stays", f"{refuse};"),
        function("is_pruned", f"IF NOT {_PRUNED} THEN {refuse}; END IF; RETURN OLD;"),
        trigger("grows", "INSERT"),
        trigger("stays", "UPDATE OR TRUNCATE", "STATEMENT"),
        trigger("is_pruned", "DELETE"),
    ]
