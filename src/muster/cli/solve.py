"""`muster solve`: plan a mission."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.allocation.auction_terms import BIDS, PLACEMENTS, WINNERS
from muster.cli.exits import DONE, INCOMPLETE, INTERRUPTED
from muster.cli.options import (
    MissionFile,
    format_option,
    ignore_option,
    mission_argument,
    objective_option,
    quiet_option,
    require_complete_option,
    settings_of,
)
from muster.cli.outputs import require_csv, require_drawable, require_writable
from muster.cli.remote.server_option import server_option
from muster.cli.results import show_plan, write_book
from muster.mission.errors import ParameterError
from muster.mission.interrupts import on_ctrl_c
from muster.mission.plan import Plan, read_plan
from muster.planning.options import DEFAULT_ALLOCATOR

if TYPE_CHECKING:
    from muster.allocation.allocator import Allocator
    from muster.allocation.problem import Problem
    from muster.allocation.stop import Stop

_FILE = click.Path(path_type=Path)


@click.command()
@mission_argument
@click.option(
    "-a",
    "--allocator",
    default=DEFAULT_ALLOCATOR,
    show_default=True,
    metavar="A",
    help="The algorithm; --list-allocators says which there are.",
)
@click.option(
    "--list-allocators",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=lambda *a: _list(*a),
    help="List the allocators.",
)
@objective_option
@ignore_option
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of all random choices.")
@click.option(
    "--time-limit", type=click.FloatRange(min=0), metavar="S", help="Seconds.  [default: 5, without --iterations]"
)
@click.option(
    "--iterations", type=click.IntRange(min=0), metavar="N", help="Stop after so many; then a seed gives one plan."
)
@click.option("--threads", type=click.IntRange(min=1), metavar="N", help="Searches side by side.  [default: 1]")
@click.option("--ray", metavar="ADDRESS", help="Work on the parts of a large team on a Ray cluster (docs/search.md).")
@click.option(
    "--bound",
    is_flag=False,
    flag_value="quick",
    callback=lambda *a: _bound(*a),
    metavar="[quick|exact]",
    help="Prove how good the plan is: at once, or by an exact solver (small missions; needs the extra exact).",
)
@click.option("--bid", type=click.Choice(BIDS), help="What robots bid.  [default: the objective]")
@click.option("--placement", type=click.Choice(PLACEMENTS), help="Where a task goes in a route.  [default: insert]")
@click.option("--winner", type=click.Choice(WINNERS), help="Which bid wins.  [default: lowest]")
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", help="A parameter of the allocator.")
@click.option("--start", type=_FILE, metavar="PLAN", help="A plan to go on from.")
@click.option(
    "--fixed", type=_FILE, metavar="PLAN", help="A plan whose routes stay, as the beginnings of the new ones."
)
@click.option("--rewire", is_flag=True, help="Fill waiting with later tasks of the same robot: sooner, for some usage.")
@require_complete_option
@format_option
@click.option("-o", "--output", type=_FILE, metavar="FILE", help="Write the plan.")
@click.option("--book", type=_FILE, metavar="FILE", help="Write every bid of an auction (.csv).")
@click.option("--plot", type=_FILE, metavar="FILE", help="Draw the routes (.png, .svg, .pdf).")
@click.option("--gantt", type=_FILE, metavar="FILE", help="Draw the time chart (.png, .svg, .pdf).")
@quiet_option
@server_option
def command(
    mission: MissionFile,
    allocator: str,
    objective: str | None,
    ignore: tuple[str, ...],
    seed: int,
    time_limit: float | None,
    iterations: int | None,
    threads: int | None,
    ray: str | None,
    bound: str | None,
    bid: str | None,
    placement: str | None,
    winner: str | None,
    settings: tuple[str, ...],
    start: Path | None,
    fixed: Path | None,
    rewire: bool,
    require_complete: bool,
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
    from muster.allocation.allocator import make_parameters
    from muster.allocation.fixed import keeping
    from muster.allocation.problem import Problem
    from muster.allocation.proofs import prove, require_provable
    from muster.allocation.registry import allocator_named
    from muster.allocation.stop import Stop, usual_time_limit
    from muster.cli.progress import progress_bar

    require_writable(output, (book, plot, gantt), mission.files, (start, fixed))
    require_csv(book)
    require_drawable(plot, gantt)
    if quiet:
        logging.getLogger("muster").setLevel(logging.ERROR)
    chosen = allocator_named(allocator)
    if book is not None and not chosen.auctions:
        raise ParameterError(f"--book: {allocator} keeps no book; expected {_auctions()}")
    terms = _given(chosen, threads=threads, ray=ray, bid=bid, placement=placement, winner=winner)
    params = make_parameters(chosen, settings_of(settings, terms))
    loaded = mission.load()
    first = None if start is None else read_plan(start)
    problem = Problem.compile(loaded, objective, ignore)
    beginnings = None if fixed is None else read_plan(fixed)
    problem = (problem if beginnings is None else keeping(problem, beginnings)).ready()
    if bound is not None:
        require_provable(problem, bound)
    limit = usual_time_limit(chosen.anytime, time_limit, iterations)
    with progress_bar(not quiet and chosen.anytime, loaded, limit, iterations) as on_progress:
        stop = Stop(iterations=iterations, time_limit=limit, on_progress=on_progress)
        with _ctrl_c_interrupts(stop):
            plan = chosen.solve(problem, stop, seed=seed, params=params, start=first)
            if rewire and not stop.interrupted:
                plan = _rewired(problem, plan)
            proof = None
            if bound is not None and not stop.interrupted:
                proof = prove(problem, plan, bound, stop, time_limit)
                plan = proof.plan
    with _ctrl_c_interrupts(stop):
        show_plan(loaded, plan, ignore, objective, beginnings, form=form, output=output, plot=plot, gantt=gantt)
    if book is not None and not write_book(plan, book, quiet):
        return INTERRUPTED
    if stop.interrupted:
        if not quiet:
            click.echo("interrupted: this is the best plan so far", err=True)
        return INTERRUPTED
    if verbose:
        click.echo(f"{stop.iterations_done} iterations in {plan.elapsed_s:.3f} s", err=True)
    if proof is not None and (verbose if plan.lower_bound is not None else not quiet):
        click.echo(f"{'no ' if plan.lower_bound is None else ''}lower bound: {proof.why}", err=True)
    return INCOMPLETE if require_complete and not plan.complete else DONE


def _rewired(problem: Problem, plan: Plan) -> Plan:
    from muster.allocation.rewiring import rewire

    return rewire(problem, plan).plan


def _bound(_: click.Context, __: click.Parameter, value: str | None) -> str | None:
    """`quick` may be left out, and then what stands next is taken for it: `--bound MISSION` deserves a hint."""
    if value not in (None, "quick", "exact"):
        hint = "--bound alone stands after the mission, or as --bound=quick"
        raise click.BadParameter(f"{value!r} is not one of 'quick', 'exact'; {hint}", param_hint="'--bound'")
    return value


def _list(ctx: click.Context, _: click.Parameter, asked: bool) -> None:
    if not asked or ctx.resilient_parsing:
        return
    from muster.allocation.registry import ALLOCATORS
    from muster.cli.tables import print_table

    rows = [
        (a.name, a.summary, ", ".join(f"{f.name}={_default(f.default)}" for f in fields(a.parameters)) or "-")
        for a in ALLOCATORS.usable().values()
    ]
    print_table(("allocator", "what it is", "parameters and defaults"), rows)
    ctx.exit()


def _default(value: object) -> object:
    return "(objective)" if value is None else value


def _given(allocator: Allocator, **words: str | int | None) -> dict[str, Any]:
    """Parameters that have options of their own, where these are given."""
    from muster.allocation.registry import ALLOCATORS

    given = {name: word for name, word in words.items() if word is not None}
    for name in given:
        takers = [a.name for a in ALLOCATORS.values() if name in {f.name for f in fields(a.parameters)}]
        if allocator.name not in takers:
            raise ParameterError(f"--{name}: {allocator.name} takes none; expected --allocator {' or '.join(takers)}")
    return given


def _auctions() -> str:
    from muster.allocation.registry import ALLOCATORS

    return " or ".join(allocator.name for allocator in ALLOCATORS.values() if allocator.auctions)


@contextmanager
def _ctrl_c_interrupts(stop: Stop) -> Iterator[None]:
    """The first Ctrl-C ends the search and keeps its plan; the second leaves out reasons; the third ends everything."""

    def interrupt() -> None:
        if stop.hurried:
            raise KeyboardInterrupt
        stop.interrupt()

    with on_ctrl_c(interrupt):
        yield
