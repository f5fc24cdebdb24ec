"""`muster solve`: plan a mission."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.backend import Backend, server_option
from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.exits import INTERRUPTED
from muster.cli.options.common import (
    MissionFile,
    accept_partial_option,
    format_option,
    mission_argument,
    quiet_option,
    require_complete_option,
)
from muster.cli.options.planning import ctrl_c_interrupts, planning_options, request_of
from muster.cli.outputs import require_csv, require_drawable, require_writable
from muster.cli.results import show_plan, write_book
from muster.cli.whole_work import whole_work
from muster.mission.errors import ParameterError
from muster.planning.options import PlanningOptions

if TYPE_CHECKING:
    from muster.mission.model import Mission
    from muster.mission.plan import Plan
    from muster.planning.solving import Solution

_FILE = click.Path(path_type=Path)
_OVERRUN, _OVERRUN_S = 0.1, 0.2  # of a time limit, and seconds, about which nothing is said


@click.command()
@mission_argument
@planning_options()
@require_complete_option
@accept_partial_option
@format_option
@click.option("-o", "--output", type=_FILE, metavar="FILE", help="Write the plan.")
@click.option("--book", type=_FILE, metavar="FILE", help="Write every bid of an auction (.csv).")
@click.option("--plot", type=_FILE, metavar="FILE", help="Draw the routes (.png, .svg, .pdf).")
@click.option("--gantt", type=_FILE, metavar="FILE", help="Draw the time chart (.png, .svg, .pdf).")
@quiet_option
@server_option(ray="a server uses no cluster")
def command(  # noqa: PLR0913  the options of a verb
    backend: Backend,
    mission: MissionFile,
    options: PlanningOptions,
    start: Path | None,
    fixed: Path | None,
    require_complete: bool,
    accept_partial: bool,
    form: str,
    output: Path | None,
    book: Path | None,
    plot: Path | None,
    gantt: Path | None,
    quiet: bool,
    verbose: bool,
) -> int:
    """Plan a MISSION: who does what, in which order.

    Every plan is judged by `verify` before it is shown. Ctrl-C ends the search; the best plan so far is kept.
    """
    from muster.cli.progress import progress_bar

    interrupt = whole_work()  # its clock is that of the time limit
    require_writable(output, (book, plot, gantt), mission.files, (start, fixed))
    require_csv(book)
    require_drawable(plot, gantt)
    _require_book(book, options)
    if quiet:
        logging.getLogger("muster").setLevel(logging.ERROR)
    loaded = mission.load(verbose=verbose)
    request = request_of(options, loaded, start, fixed)
    with ctrl_c_interrupts(interrupt):
        with progress_bar(not quiet, loaded) as on_progress:
            solution = backend.plan(request, on_progress, interrupt)
        show_plan(loaded, solution.plan, solution.verdict, form=form, output=output, plot=plot, gantt=gantt)
    if not quiet:
        _warn_of_unseen(loaded, solution.plan)
    if book is not None and not write_book(solution.plan, book, quiet):
        return INTERRUPTED
    plan = solution.plan
    if plan.cut_short and not quiet:
        click.echo(f"{plan.cut_short_line}; expected more time, or --accept-partial", err=True)
    endings = (
        (Ending.INTERRUPTED, interrupt.interrupted),
        (Ending.CUT_SHORT, plan.cut_short and not accept_partial),
        (Ending.LEFT_OUT, require_complete and not plan.complete),
    )
    if interrupt.interrupted:
        if not quiet:
            click.echo("interrupted: this is the best plan so far", err=True)
        return exit_code_if(*endings)
    if options.time_limit is not None and not quiet:
        _say_overrun(interrupt.elapsed_s, options.time_limit, plan)
    _say_why(solution, quiet=quiet, verbose=verbose)
    return exit_code_if(*endings)


def _warn_of_unseen(mission: Mission, plan: Plan) -> None:
    """Print on standard error the raster searches of which the robots that do them do not see all."""
    from muster.planning.explaining import unseen_in_plan

    for one in unseen_in_plan(mission, plan):
        click.echo(f"warning: task {one.task}: spacing_m {one.spacing_m:g}: {one.detail}", err=True)


def _say_overrun(took_s: float, limit_s: float, plan: Plan) -> None:
    """Print on standard error what a time limit was too short for."""
    if took_s > limit_s * (1 + _OVERRUN) + _OVERRUN_S:
        beside_s = took_s - (plan.elapsed_s or 0.0)
        click.echo(
            f"time limit: {limit_s:g} s, all took {took_s:.1f} s: reading, judging and writing {beside_s:.1f} s of it",
            err=True,
        )


def _say_why(solution: Solution, *, quiet: bool, verbose: bool) -> None:
    """With -v why a bound holds; without -q why the bound that was asked for is missing."""
    bounded = solution.plan.lower_bound is not None
    if solution.why and (verbose if bounded else not quiet):
        click.echo(f"{'' if bounded else 'no '}lower bound: {solution.why}", err=True)


def _require_book(book: Path | None, options: PlanningOptions) -> None:
    """Refuse to write the book of an allocator that is known here to keep none."""
    from muster.allocation.registry import ALLOCATORS

    if book is None or options.allocator not in ALLOCATORS:
        return
    auctions = [allocator.name for allocator in ALLOCATORS.usable().values() if allocator.auctions]
    if options.allocator not in auctions:
        raise ParameterError(f"--book: {options.allocator} keeps no book; expected {' or '.join(auctions)}")
