"""`muster replay`: what a record holds; as a page, as a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE
from muster.cli.options import format_option, quiet_option
from muster.cli.outputs import require_drawable, require_writable

if TYPE_CHECKING:
    from muster.report.record import Recording

_MOST_EVENTS = 40
_FILE = click.Path(path_type=Path)


@click.command()
@click.argument("record", type=_FILE)
@click.option("--html", type=_FILE, metavar="FILE", help="Write a page to look at in a browser, offline.")
@click.option("--plot", type=_FILE, metavar="FILE", help="Draw where the robots went (.png, .svg, .pdf).")
@format_option
@quiet_option
def command(record: Path, html: Path | None, plot: Path | None, form: str, quiet: bool, verbose: bool) -> int:
    """Show the RECORD of a mission that was carried out (MCAP).

    A record that breaks off, because what wrote it was killed, is shown up to there. With -v all events are listed.
    """
    from muster.report.record import read_record

    require_writable(None, (html, plot), (record,), ())
    require_drawable(plot)
    recording = read_record(record)
    if not recording.complete and not quiet:
        until = f"breaks off at {recording.duration_s:.1f} s"
        click.echo(f"warning: {record}: {until}; what is whole is shown", err=True)
    if html is not None:
        from muster.report.page import write_page

        write_page(html, recording)
    if plot is not None:
        from muster.report.files import save_figure
        from muster.report.flown import plot_flown

        save_figure(plot_flown(recording), plot)
    if form == "json":
        from muster.mission.plan import json_text

        click.echo(json_text(_answer(recording)), nl=False)
    else:
        _print(recording, all_events=verbose)
    return DONE


def _answer(recording: Recording) -> dict[str, Any]:
    return {
        "mission": recording.mission.name,
        "complete": recording.complete,
        "duration_s": recording.duration_s,
        "robots": _robots(recording),
        "plans": [
            {
                "time_s": version.time_s,
                "allocator": version.plan.allocator,
                "tasks": sum(len(route.tasks) for route in version.plan.routes),
            }
            for version in recording.plans
        ],
        "bids": len(recording.bids),
        "events": [{"time_s": e.time_s, "kind": e.kind, "data": e.data} for e in recording.events],
        "report": recording.report,
    }


def _robots(recording: Recording) -> list[dict[str, Any]]:
    """How many poses of each robot there are, and how far it went from one to the next, metres."""
    import numpy as np

    found = []
    for k, robot in enumerate(recording.tracks.robots):
        places = recording.tracks.positions[:, k]
        places = places[np.isfinite(places).all(axis=1)]
        travelled = float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
        found.append({"robot": robot, "poses": len(places), "travelled_m": travelled})
    return found


def _print(recording: Recording, *, all_events: bool) -> None:
    from muster.cli.tables import counted, print_table
    from muster.report.record.messages import event_line

    name, duration = recording.mission.name, f"{recording.duration_s:.1f} s"
    amounts = (counted(len(recording.plans), "plan"), counted(len(recording.events), "event"))
    click.echo(f"{name}: {duration}, {', '.join(amounts)}, {'complete' if recording.complete else 'breaks off'}\n")
    _print_robots(recording)
    shown = recording.events if all_events else recording.events[:_MOST_EVENTS]
    if shown:
        rows = [(f"{event.time_s:.2f}", event_line(event.kind, event.data)) for event in shown]
        print_table(("time [s]", "event"), rows, right=("time [s]",))
    if len(shown) < len(recording.events):
        click.echo(f"... and {counted(len(recording.events) - len(shown), 'event')} more; -v lists all\n")
    _print_report(recording)


def _print_robots(recording: Recording) -> None:
    from muster.cli.tables import number, print_table

    usage = {row["robot"]: row for row in (recording.report or {}).get("robots", [])}
    columns = ("robot", "poses", "travelled [m]", "usage planned", "usage flown")
    rows = [
        (
            row["robot"],
            str(row["poses"]),
            number(row["travelled_m"]),
            number(usage.get(row["robot"], {}).get("usage_planned")),
            number(usage.get(row["robot"], {}).get("usage_flown")),
        )
        for row in _robots(recording)
    ]
    print_table(columns, rows, right=columns[1:])


def _print_report(recording: Recording) -> None:
    """The figures of the report that are one number or a count."""
    if recording.report is None:
        click.echo("no report: the mission did not come to its end")
        return
    from muster.cli.tables import number

    for key, value in recording.report.items():
        if isinstance(value, list) and key.startswith("tasks"):
            click.echo(f"{key}: {len(value)}")
            for lost in [one for one in value if isinstance(one, dict)]:
                click.echo(f"  {lost.get('task')}: {lost.get('reason')}")
        elif isinstance(value, float):
            click.echo(f"{key}: {number(value)}")
        elif value is None or isinstance(value, int | str):
            click.echo(f"{key}: {'-' if value is None else value}")
