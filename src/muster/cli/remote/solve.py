"""`muster solve --server`: planned there, judged and shown here."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.exits import DONE, INCOMPLETE, INTERRUPTED
from muster.cli.options import MissionFile, settings_of
from muster.cli.outputs import require_csv, require_drawable, require_writable
from muster.cli.remote.uploads import kept
from muster.cli.remote.waiting import planned
from muster.cli.results import show_plan, write_book
from muster.mission.plan import plan_from, read_plan

if TYPE_CHECKING:
    from muster.client import Client


def run(
    control: Client,
    *,
    mission: MissionFile,
    allocator: str,
    objective: str | None,
    ignore: tuple[str, ...],
    seed: int,
    time_limit: float | None,
    iterations: int | None,
    threads: int | None,
    bound: str | None,
    bid: str | None,
    placement: str | None,
    winner: str | None,
    settings: tuple[str, ...],
    start: Path | None,
    require_complete: bool,
    form: str,
    output: Path | None,
    book: Path | None,
    plot: Path | None,
    gantt: Path | None,
    quiet: bool,
    verbose: bool,
) -> int:
    """Send the mission, wait for its plan, judge and show it."""
    require_writable(output, (book, plot, gantt), mission.files, (start,))
    require_csv(book)
    require_drawable(plot, gantt)
    words = {"threads": threads, "bid": bid, "placement": placement, "winner": winner}
    parameters = settings_of(settings, words)
    loaded = mission.load(verbose=verbose)
    first = None if start is None else read_plan(start)
    there = kept(control, loaded, verbose=verbose)
    first_id = None if first is None else control.plans.upload(there.mission, first.as_dict()).id
    ask = partial(
        control.plan,
        there,
        allocator=allocator,
        objective=objective,
        ignore=list(ignore),
        seed=seed,
        time_limit=time_limit,
        iterations=iterations,
        bound=bound,
        parameters=parameters,
        start=first_id,
    )
    entry, interrupted = planned(ask, loaded, quiet=quiet, time_limit=time_limit, iterations=iterations)
    plan = plan_from(entry.plan, f"plan {entry.id}")
    show_plan(loaded, plan, ignore, objective, form=form, output=output, plot=plot, gantt=gantt)
    if book is not None and not write_book(plan, book, quiet):
        return INTERRUPTED
    if interrupted:
        if not quiet:
            click.echo("interrupted: this is the best plan so far", err=True)
        return INTERRUPTED
    if verbose:
        click.echo(f"plan {entry.id} of the server, in {plan.elapsed_s or 0.0:.3f} s", err=True)
    return INCOMPLETE if require_complete and not plan.complete else DONE
