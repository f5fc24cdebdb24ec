"""`muster replay`: what a record holds: as text, page, picture, file of others, or beside another recording."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE
from muster.cli.options import Verb, format_option, quiet_option
from muster.cli.other_recordings import OTHER_RECORDINGS
from muster.cli.outputs import require_drawable, require_writable
from muster.cli.record_output import draw_record, drawing_options
from muster.cli.report_tables import print_report
from muster.cli.tables import number, print_table
from muster.mission.texts.counting import counted

if TYPE_CHECKING:
    from muster.report.record import Recording

_MOST_EVENTS = 40
_FILE = click.Path(path_type=Path)
_OTHERS = tuple(OTHER_RECORDINGS.usable().values())


def _other_options(verb: Verb) -> Verb:
    for other in reversed(_OTHERS):
        verb = other.add_options(verb)
    return verb


@click.command()
@click.argument("record", type=_FILE)
@drawing_options
@_other_options
@format_option
@quiet_option
def command(
    record: Path,
    html: Path | None,
    plot: Path | None,
    gantt: Path | None,
    form: str,
    quiet: bool,
    verbose: bool,
    **others: Any,
) -> int:
    """Show the RECORD of a mission that was carried out (MCAP), or the poses in a recording of ROS.

    A record that breaks off, because its writer was killed, is shown up to there. With -v all events are listed.
    """
    from muster.report.record import read_record

    given = {"html": html, "plot": plot, "gantt": gantt, **others}
    outputs = (file for other in _OTHERS for file in other.outputs(given))
    inputs = (file for other in _OTHERS for file in other.inputs(given))
    require_writable(None, (html, plot, gantt, *outputs), (record, *inputs), ())
    require_drawable(plot, gantt)
    for other in _OTHERS:
        other.require_consistent(record, given)
    for other in _OTHERS:
        if other.is_recording(record):
            return other.show(record, plot, form, quiet=quiet)
    recording = read_record(record)
    if not recording.complete and not quiet:
        until = f"breaks off at {recording.duration_s:.1f} s"
        click.echo(f"warning: {record}: {until}; what is whole is shown", err=True)
    draw_record(recording, html, plot, gantt)
    answers = [other.answer(recording, given, quiet=quiet) for other in _OTHERS]
    if form == "json":
        from muster.mission.plan import json_text

        of_others = {key: value for answer in answers for key, value in answer.items()}
        click.echo(json_text(_answer(recording) | of_others), nl=False)
    else:
        _print(recording, all_events=verbose)
        for other, answer in zip(_OTHERS, answers, strict=True):
            other.print_answer(answer)
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


def _how_it_ends(recording: Recording) -> str:
    if not recording.complete:
        return "breaks off"
    return "complete" if recording.report is not None else "interrupted"


def _print(recording: Recording, *, all_events: bool) -> None:
    name, duration = recording.mission.name, f"{recording.duration_s:.1f} s"
    amounts = (counted(len(recording.plans), "plan"), counted(len(recording.events), "event"))
    click.echo(f"{name}: {duration}, {', '.join(amounts)}, {_how_it_ends(recording)}\n")
    _print_robots(recording)
    shown = recording.events if all_events else recording.events[:_MOST_EVENTS]
    if shown:
        rows = [(f"{event.time_s:.2f}", event.line) for event in shown]
        print_table(("time [s]", "event"), rows, right=("time [s]",))
    if len(shown) < len(recording.events):
        click.echo(f"... and {counted(len(recording.events) - len(shown), 'event')} more; -v lists all\n")
    if recording.report is None:
        click.echo("no report: the mission did not come to its end")
    else:
        print_report(recording.report, recording.mission, with_tasks=all_events)


def _print_robots(recording: Recording) -> None:
    columns = ("robot", "poses", "travelled [m]")
    rows = [(row["robot"], str(row["poses"]), number(row["travelled_m"])) for row in _robots(recording)]
    print_table(columns, rows, right=columns[1:])
