"""A plan as it leaves the command: judged, written, drawn, printed; and the book of an auction."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan

if TYPE_CHECKING:
    from muster.verification import Verdict


def show_plan(
    mission: Mission,
    plan: Plan,
    ignored: tuple[str, ...],
    objective: str | None,
    fixed: Plan | None = None,
    *,
    form: str,
    output: Path | None,
    plot: Path | None,
    gantt: Path | None,
) -> None:
    """Judge a plan that was made for that objective, some rules ignored; then write and draw and print it.

    Raises
    ------
    MusterError
        if the judge rejects it.
    """
    from muster.cli.plan_tables import print_plan
    from muster.verification import verify

    verdict = verify(mission, plan, ignored, objective, fixed)
    if not verdict.valid:
        details = "; ".join(f"{v.kind} {v.detail}" for v in verdict.violations[:3])
        raise MusterError(f"internal error: the judge rejects the plan of {plan.allocator}: {details}")
    if output is not None:
        plan.save(output)
    _draw(mission, plan, verdict, plot, gantt)
    if form == "json":
        click.echo(plan.text(), nl=False)
    else:
        print_plan(plan, verdict)


def _draw(mission: Mission, plan: Plan, verdict: Verdict, plot: Path | None, gantt: Path | None) -> None:
    from muster.report import plot_gantt, plot_routes, save_figure

    if plot is not None:
        save_figure(plot_routes(mission, plan, verdict), plot)
    if gantt is not None:
        save_figure(plot_gantt(mission, verdict), gantt)


def write_book(plan: Plan, file: Path, quiet: bool) -> bool:
    """Write every bid, which takes a while where there are many; whether all are written."""
    if not quiet and sys.stderr.isatty():
        click.echo(f"writing {file} ...", err=True)
    try:
        if plan.book is not None:
            plan.book.save(file)
    except KeyboardInterrupt:
        click.echo(f"interrupted: {file} does not hold all bids", err=True)
        return False
    return True
