"""`muster db`: the database of mission control: contents, backups, deletion of old runs."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import click

from muster.cli.exits import DONE
from muster.cli.options.common import Finite, format_option, quiet_option
from muster.mission.system.platforms import require_posix

_FILE = click.Path(path_type=Path, dir_okay=False)


def _database(_: click.Context, __: click.Parameter, value: str | None) -> str:
    from muster_control.settings import usual_database

    return value or usual_database()


_db_option = click.option(
    "--db",
    "url",
    envvar="MUSTER_DB",
    callback=_database,
    metavar="URL",
    help="sqlite:///FILE or postgresql://USER@HOST/NAME; also MUSTER_DB.  [default: a file of yours]",
)


@click.group()
def command() -> None:
    """Manage the database of mission control: back it up, restore it, delete old runs.

    All of them work while a server runs.
    """
    require_posix("mission control")


@command.command("info")
@_db_option
@format_option
@quiet_option
def info(url: str, form: str, quiet: bool, verbose: bool) -> int:
    """Show what the database contains."""
    from muster_control.store.database_info import database_info

    found = database_info(url)
    if form == "json":
        import json

        click.echo(json.dumps(asdict(found), indent=1))
        return DONE
    from muster.cli.tables.table import print_table

    rows = [(name.replace("_", " "), str(count)) for name, count in found.rows.items()]
    click.echo(f"{found.database}: tables {found.tables}, {found.bytes / 2**20:.1f} MiB")
    print_table(("what", "how many"), rows, right=("how many",))
    return DONE


@command.command("backup")
@click.argument("file", type=_FILE)
@_db_option
@quiet_option
def backup(file: Path, url: str, quiet: bool, verbose: bool) -> int:
    """Copy the database into a new FILE.

    The copy is an SQLite file, also of a PostgreSQL database, and `muster db restore` puts it into either. It holds the
    state of one moment, also while a server writes.
    """
    from muster_control.store.backup import backup as copy

    copy(url, file)
    if not quiet:
        click.echo(f"wrote {file}: {file.stat().st_size} bytes", err=True)
    return DONE


@command.command("restore")
@click.argument("file", type=_FILE)
@_db_option
@quiet_option
def restore(file: Path, url: str, quiet: bool, verbose: bool) -> int:
    """Put a backup into an empty database.

    A missing SQLite database is created; a PostgreSQL database is created with createdb.
    """
    from muster_control.store.backup import restore as put_back
    from muster_control.store.database_info import database_info

    put_back(file, url)
    if not quiet:
        found = database_info(url)
        amounts = f"{found.rows['missions']} missions, {found.rows['plans']} plans, {found.rows['runs']} runs"
        click.echo(f"restored {found.database}: {amounts}", err=True)
    return DONE


@command.command("prune")
@click.option(
    "--older-than",
    "days",
    type=Finite(0, 36500),
    required=True,
    metavar="DAYS",
    help="What ended, or was made, longer ago than that.",
)
@click.option("--dry-run", is_flag=True, help="Only say what would go.")
@_db_option
@format_option
@quiet_option
def prune(days: float, dry_run: bool, url: str, form: str, quiet: bool, verbose: bool) -> int:
    """Delete old runs that are over, with all that belongs to them.

    These go: runs that are over with their log, tracks and actions; jobs; then plans and versions of missions to which
    nothing refers. The newest plan and version of a mission stay.
    """
    from muster_control.store.prune import prune as delete

    pruned = asdict(delete(url, days, dry_run=dry_run))
    if form == "json":
        import json

        click.echo(json.dumps(pruned, indent=1))
        return DONE
    from muster.cli.tables.table import print_table

    rows = [(name.replace("_", " "), str(count)) for name, count in pruned.items()]
    head = "would go" if dry_run else "gone"
    print_table(("what", head), rows, right=(head,))
    return DONE
