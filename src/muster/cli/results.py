"""Output of a plan: file, pictures, table; and the book of an auction."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.mission.model import Mission
from muster.mission.plan import Plan

if TYPE_CHECKING:
    from muster.verification import Verdict


def show_plan(
    mission: Mission,
    plan: Plan,
    verdict: Verdict,
    *,
    form: str,
    output: Path | None,
    plot: Path | None,
    gantt: Path | None,
) -> None:
    """Write, draw and print a plan that was judged."""
    from muster.cli.tables.plan import print_plan
    from muster.cli.tables.schedule import print_schedule

    if output is not None:
        plan.save(output)
    _draw(mission, plan, verdict, plot, gantt)
    if form == "json":
        click.echo(plan.text(), nl=False)
    else:
        print_plan(plan, verdict)
        print_schedule(mission, verdict)


def _draw(mission: Mission, plan: Plan, verdict: Verdict, plot: Path | None, gantt: Path | None) -> None:
    from muster.report import plot_gantt, plot_routes, save_figure

    if plot is not None:
        save_figure(plot_routes(mission, plan, verdict), plot)
    if gantt is not None:
        save_figure(plot_gantt(mission, verdict), gantt)


def write_book(plan: Plan, file: Path, quiet: bool) -> bool:
    """Write every bid; returns whether all are written. Many bids take a while."""
    if not quiet and sys.stderr.isatty():
        click.echo(f"writing {file} ...", err=True)
    try:
        if plan.book is not None:
            plan.book.save(file)
    except KeyboardInterrupt:
        click.echo(f"interrupted: {file} does not hold all bids", err=True)
        return False
    return True
