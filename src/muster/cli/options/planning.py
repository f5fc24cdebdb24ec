"""The options of a planning request as options of a verb."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS
from muster.cli.options.common import Verb, grouped, ignore_option, objective_option, settings_of
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.reading.plan_reader import read_plan
from muster.mission.system.interrupts import on_ctrl_c
from muster.mission.value_types import shown
from muster.planning.options import BOUNDS, DEFAULT_ALLOCATOR, HELP, PlanningOptions
from muster.planning.request import Request
from muster.traffic.names import DEFAULT, TRAFFIC, of_run

if TYPE_CHECKING:
    from muster.allocation.stop import Stop

_FILE = click.Path(path_type=Path)
_THREADS_HELP = "Threads that the search works with.  [default: one for each processor; with --iterations 1]"
_PARAMETERS = ("threads", "ray", "bid", "placement", "winner")  # of allocators, with options of their own
_TRAFFIC_OF_PLAN = click.option(
    "--traffic", default=DEFAULT, show_default=True, metavar=f"[{'|'.join(TRAFFIC)}]", help=HELP["traffic"]
)


def planning_options(*, time_limit_s: float | None = None, carries_out: bool = False) -> Callable[[Verb], Verb]:
    """The options of a planning request, as `PlanningOptions`; and the files `start` and `fixed`.

    Parameters
    ----------
    time_limit_s
        of a verb that plans for less than the usual time unless told otherwise.
    carries_out
        whether the verb carries the plan out: it has options of its own for how robots pass each other.
    """
    return lambda verb: _with_planning_options(verb, time_limit_s, carries_out)


def _with_planning_options(verb: Verb, time_limit_s: float | None, carries_out: bool) -> Verb:
    @wraps(verb)
    def with_options(*, settings: tuple[str, ...], **given: Any) -> Any:
        named = {name: given.pop(name) for name in _PARAMETERS}
        parameters = settings_of(settings, named)
        if given.get("coordination") is None:  # else its method takes them
            _require_taken(given["allocator"], named)
        if given["iterations"] is None and given["time_limit"] is None:
            given["time_limit"] = time_limit_s
        names = ("allocator", "objective", "ignore", "seed", "time_limit", "iterations", "bound", "rewire")
        how = {name: given[name] for name in ("avoidance", "law") if given.get(name)}
        traffic = of_run(given["traffic"] or DEFAULT, **how) if carries_out else given.pop("traffic")
        own = {name: given.pop(name) for name in names}
        options = PlanningOptions(parameters=parameters, traffic=traffic, **own)
        return verb(options=options, **given)

    decorated: Any = with_options if carries_out else _TRAFFIC_OF_PLAN(with_options)
    return cast("Verb", grouped(*_declared(time_limit_s))(decorated))


def _declared(time_limit_s: float | None) -> tuple[Callable[[Any], Any], ...]:
    seconds = 5 if time_limit_s is None else time_limit_s
    return (
        click.option(
            "-a",
            "--allocator",
            default=DEFAULT_ALLOCATOR,
            show_default=True,
            metavar="A",
            help=f"{HELP['allocator']} --list-allocators says which there are.",
        ),
        click.option(
            "--list-allocators",
            is_flag=True,
            is_eager=True,
            expose_value=False,
            callback=_list,
            help="List the allocators.",
        ),
        objective_option,
        ignore_option,
        click.option("--seed", type=int, default=0, show_default=True, metavar="N", help=HELP["seed"]),
        click.option(
            "--time-limit",
            type=float,
            metavar="S",
            help=f"{HELP['time_limit']}  [default: {seconds:g}, without --iterations]",
        ),
        click.option("--iterations", type=int, metavar="N", help=HELP["iterations"]),
        click.option("--threads", type=click.IntRange(min=1), metavar="N", help=_THREADS_HELP),
        click.option(
            "--ray", metavar="ADDRESS", help="Work on the parts of a large team on a Ray cluster (docs/search.md)."
        ),
        click.option(
            "--bound",
            is_flag=False,
            flag_value="quick",
            callback=_bound,
            metavar="[quick|exact]",
            help=f"{HELP['bound']} The exact one takes small missions, and needs the extra exact.",
        ),
        click.option("--bid", type=click.Choice(BIDS), help="What robots bid.  [default: the objective]"),
        click.option(
            "--placement", type=click.Choice(PLACEMENTS), help="Where a task goes in a route.  [default: insert]"
        ),
        click.option("--winner", type=click.Choice(WINNERS), help="Which bid wins.  [default: lowest]"),
        click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", help="A parameter of the allocator."),
        click.option("--start", type=_FILE, metavar="PLAN", help="A plan to go on from."),
        click.option(
            "--fixed", type=_FILE, metavar="PLAN", help="A plan whose routes stay, as the beginnings of the new ones."
        ),
        click.option("--rewire", is_flag=True, help=HELP["rewire"]),
    )


def _bound(_: click.Context, __: click.Parameter, value: str | None) -> str | None:
    """Check the bound. `--bound MISSION` reads the mission as the bound, so the message says how to write it."""
    if value not in (None, *BOUNDS):
        hint = "--bound alone stands after the mission, or as --bound=quick"
        raise ParameterError(f"bound: {shown(value)}; expected {' or '.join(BOUNDS)}; {hint}")
    return value


def _list(ctx: click.Context, _: click.Parameter, asked: bool) -> None:
    if not asked or ctx.resilient_parsing:
        return
    from muster.allocation.registry import ALLOCATORS
    from muster.cli.tables.table import print_table

    rows = [
        (a.name, a.summary, ", ".join(f"{f.name}={_default(f.default)}" for f in fields(a.parameters)) or "-")
        for a in ALLOCATORS.usable().values()
    ]
    print_table(("allocator", "what it is", "parameters and defaults"), rows)
    ctx.exit()


def _default(value: object) -> object:
    return "(objective)" if value is None else value


def _require_taken(allocator: str, named: Mapping[str, Any]) -> None:
    """Refuse options of an allocator that has no such parameter, where the allocator is known here."""
    given = [name for name, value in named.items() if value is not None]
    if not given:
        return
    from muster.allocation.registry import ALLOCATORS

    for name in given:
        takers = [a.name for a in ALLOCATORS.values() if name in {f.name for f in fields(a.parameters)}]
        if allocator in ALLOCATORS and allocator not in takers:
            raise ParameterError(f"--{name}: {allocator} takes none; expected --allocator {' or '.join(takers)}")


def request_of(options: PlanningOptions, mission: Mission, start: Path | None, fixed: Path | None) -> Request:
    """The request for a mission, with the plans of --start and --fixed."""
    plans = {name: read_plan(file, mission) for name, file in (("start", start), ("fixed", fixed)) if file is not None}
    return Request.of(options, mission, **plans)


@contextmanager
def ctrl_c_interrupts(stop: Stop) -> Iterator[None]:
    """The first Ctrl-C ends the search and keeps its plan; the second leaves out reasons; the third ends everything."""

    def interrupt() -> None:
        if stop.hurried:
            raise KeyboardInterrupt
        stop.interrupt()

    with on_ctrl_c(interrupt):
        yield
