"""`muster auction`: the robots of a team agree who does what, each in a process of its own."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE, INCOMPLETE, INTERRUPTED
from muster.cli.options.common import (
    Finite,
    MissionFile,
    format_option,
    ignore_option,
    mission_argument,
    objective_option,
    quiet_option,
    require_complete_option,
    settings_of,
)
from muster.cli.options.request import request_options
from muster.cli.outputs import require_csv, require_drawable, require_folder, require_writable
from muster.cli.results import show_plan, write_book
from muster.mission.errors import ParameterError
from muster.mission.plan import Plan
from muster.planning.judging import judged
from muster_team.cli.auction_options import result_options, robot_options, simulation_options, terms_options
from muster_team.cli.auction_result import Agreement
from muster_team.runs.negotiation import Negotiation

if TYPE_CHECKING:
    from muster.model.problem import Problem
    from muster_team.negotiators.methods import Method

_FILE = click.Path(path_type=Path)
_OF_ONE_ROBOT = ("listen", "connect", "multicast", "memory", "key_file", "robot_key", "roster", "revocations")
_OF_AN_OPERATOR = {"robot_key", "roster"}  # with --revoke
_OF_A_SIMULATED_NETWORK = ("loss", "duplication", "delay", "jitter", "crashes", "cut")


def _key_option(name: str, make: Callable[[Path], None], text: str) -> Callable[[Any], Any]:
    """An option that makes a key in a new file, in place of all else."""

    def callback(ctx: click.Context, _: click.Parameter, file: Path | None) -> None:
        if file is not None and not ctx.resilient_parsing:
            make(file)
            ctx.exit()

    return click.option(
        name, type=_FILE, is_eager=True, expose_value=False, callback=callback, metavar="FILE", help=text
    )


@click.command()
@mission_argument
@request_options(Negotiation)
@objective_option
@ignore_option
@terms_options
@click.option(
    "--time-limit", type=Finite(0, 1e6), default=60.0, show_default=True, metavar="S", help="To agree within."
)
@robot_options
@_key_option("--new-key", lambda file: _new_key(file), "Make a key for --key-file, and do nothing else.")
@_key_option(
    "--new-robot-key",
    lambda file: _new_robot_key(file),
    "Make a key for --robot-key, print its public key for --roster, and do nothing else.",
)
@simulation_options
@require_complete_option
@format_option
@result_options
@quiet_option
def command(  # noqa: PLR0913  the options of a verb
    mission: MissionFile,
    how: Mapping[str, Any],
    objective: str | None,
    ignore: tuple[str, ...],
    settings: tuple[str, ...],
    require_complete: bool,
    form: str,
    output: Path | None,
    book: Path | None,
    plot: Path | None,
    gantt: Path | None,
    views: Path | None,
    quiet: bool,
    verbose: bool,
    **others: Any,
) -> int:
    """Hold the auction of a MISSION without a centre: each robot is a process, and bids for itself.

    Without --robot the whole team runs on this machine. With --robot this is one robot of a team that runs elsewhere:
    the same MISSION and key, one process on each robot's computer.
    """
    from muster.model.problem import Problem
    from muster_team.auctions.capabilities import refuse_what_is_not_agreed
    from muster_team.negotiators.methods import method_named

    _check_together(others)
    require_writable(output, (book, plot, gantt), mission.files, ())
    require_csv(book)
    require_folder(views, "--views")
    require_drawable(plot, gantt)
    if quiet:
        logging.getLogger("muster").setLevel(logging.ERROR)
    words = {name: others[name] for name in ("bid", "placement", "winner")}
    negotiation = Negotiation(**how, params=settings_of(settings, words))
    chosen, terms = method_named(negotiation.method), negotiation.terms
    loaded = mission.load(verbose=verbose)
    problem = Problem.compile(loaded, objective, ignore)
    refuse_what_is_not_agreed(problem, chosen.can)
    problem = problem.ready()
    if others["revoke"] is not None:
        from muster_team.cli.auction_robot import revocation_line

        click.echo(revocation_line(problem, terms, others))
        return DONE
    agreement = _agree(problem, terms, chosen, negotiation.transport, others, quiet=quiet, verbose=verbose)
    first = next(iter(agreement.views.values()))
    plan = chosen.plan(problem, terms, first, agreement.took_s)
    show_plan(loaded, plan, judged(loaded, plan, ignore, objective), form=form, output=output, plot=plot, gantt=gantt)
    if views is not None:
        _write_views(views, {r: chosen.plan(problem, terms, v, agreement.took_s) for r, v in agreement.views.items()})
    if book is not None and not write_book(plan, book, quiet):
        return INTERRUPTED
    return INCOMPLETE if require_complete and not plan.complete else DONE


def _agree(
    problem: Problem, terms: Any, method: Method, transport: str, others: dict[str, Any], **speech: bool
) -> Agreement:
    """Run the auction: in a simulated network, with the whole team on this machine, or with one robot of it."""
    if others["network_seed"] is not None:
        from muster_team.cli.auction_simulated import agree_in_memory

        return agree_in_memory(problem, terms, method, others, **speech)
    if others["robot"] is not None:
        from muster_team.cli.auction_robot import agree_with_others

        return agree_with_others(problem, terms, method, transport, others, **speech)
    from muster_team.cli.auction_team import agree_here

    return agree_here(problem, terms, method, transport, others["time_limit"], **speech)


def _check_together(others: dict[str, Any]) -> None:
    """Refuse options without the option that they belong to."""
    given = {name for name, value in others.items() if value is not None}
    for names, needed in ((_OF_ONE_ROBOT, "robot"), (_OF_A_SIMULATED_NETWORK, "network_seed")):
        for name in names:
            is_operators = "revoke" in given and name in _OF_AN_OPERATOR
            if name in given and needed not in given and not is_operators:
                word = {"robot": "--robot", "network_seed": "--simulate-network"}[needed]
                raise ParameterError(f"--{name.replace('_', '-')} given; expected it together with {word}")
    both = [name for name in ("robot", "revoke", "network_seed") if name in given]
    if len(both) > 1:
        words = {"robot": "--robot", "revoke": "--revoke", "network_seed": "--simulate-network"}
        raise ParameterError(f"{' and '.join(words[name] for name in both)} given; expected one of them")


def _write_views(folder: Path, plans: dict[str, Plan]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for robot, plan in plans.items():
        plan.save(folder / f"{robot}.json")


def _new_key(file: Path) -> None:
    from muster_team.network.keys import new_key, write_key

    write_key(file, new_key())
    click.echo(f"{file}: a new key; give every robot a copy, and nobody else")


def _new_robot_key(file: Path) -> None:
    from muster_team.network.keys import new_key, write_key
    from muster_team.network.robot_keys import public_key

    key = new_key()
    public = public_key(key)
    write_key(file, key)
    click.echo(f"{file}: a new key, which only this robot may have", err=True)
    click.echo(public.hex())
