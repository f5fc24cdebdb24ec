"""`python -m muster_robots.conformance MODULE[:NAME]`: tests a fleet, and prints what it lacks."""

from __future__ import annotations

import importlib
import importlib.util
import json
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from types import ModuleType

import click

from muster.cli.options.request import settings_from
from muster.cli.tables.table import print_table, sequence
from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.running.fleet_registry import FLEETS
from muster.running.fleet_type import AIR, GROUND, FleetType
from muster_robots.conformance.clauses import CLAUSES
from muster_robots.conformance.kit import Finding, findings
from muster_robots.conformance.stand import Stand

CONFORMS, LACKS, USAGE = 0, 1, 2


def fleet_type_of(target: str) -> FleetType:
    """Return the fleet that is meant by MODULE, MODULE:NAME, a Python file in place of a module, or a fleet's name.

    Raises
    ------
    ParameterError
        If there is no such module, or it has no such fleet, or several.
    """
    if target in FLEETS:
        return FLEETS.named(target)
    name, _, attribute = target.rpartition(":") if ":" in target else (target, "", "")
    module = _imported(name)
    if attribute:
        found = getattr(module, attribute, None)
        if isinstance(found, FleetType):
            return found
        raise ParameterError(f"{target}: {type(found).__name__}; expected a FleetType")
    fleets = {key: value for key, value in vars(module).items() if isinstance(value, FleetType)}
    if len(fleets) != 1:
        raise ParameterError(f"{name}: {', '.join(fleets) or 'no FleetType'}; expected one FleetType, or MODULE:NAME")
    return next(iter(fleets.values()))


def _imported(name: str) -> ModuleType:
    try:
        if not name.endswith(".py"):
            return importlib.import_module(name)
        spec = importlib.util.spec_from_file_location(Path(name).stem, name)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[module.__name__] = module  # dataclasses look their module up
        spec.loader.exec_module(module)
        return module
    except Exception as error:  # code of another package may raise anything
        raise ParameterError(f"{name}: cannot be imported: {type(error).__name__}: {error}") from error


def two_robots(kind: FleetType) -> Mission:
    """Return the mission of a fleet that is tested without one: r_0 at (0, 0) and r_1 3 m north of it."""
    carried = GROUND if GROUND in kind.abilities else AIR
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 3.0 * k), kind=carried) for k in range(2))
    return Mission(name="conformance", robots=robots, tasks=(Task(id="t", position=(1.0, 0.0)),))


def _command(text: str | None) -> Callable[[str], object] | None:
    """Return what runs a command with the id of a robot in place of {robot}."""
    if text is None:
        return None

    def act(robot: str) -> None:
        words = [word.replace("{robot}", robot) for word in shlex.split(text)]
        try:
            subprocess.run(words, check=True, capture_output=True, timeout=30)
        except (OSError, subprocess.SubprocessError) as error:
            raise ParameterError(f"{text}: {error}; expected a command that runs") from error

    return act


@click.command()
@click.argument("target", metavar="MODULE[:NAME]")
@click.option("--setting", multiple=True, metavar="KEY=VALUE", help="A setting of the fleet.")
@click.option(
    "--mission", metavar="MISSION", help="Whose robots are moved; r_0 at (0, 0) and r_1 at (0, 3) without it."
)
@click.option(
    "--reach", "reach_m", default=2.0, metavar="METRES", help="How far east each robot is sent.", show_default=True
)
@click.option(
    "--lease-reach",
    "lease_reach_m",
    default=0.0,
    metavar="METRES",
    help="How far east of its start the first robot may drive, to see whether it stops when orders are not renewed.",
)
@click.option(
    "--silence", metavar="COMMAND", help="Lets {robot} fall silent, such as 'ssh {robot} pkill -STOP driver'."
)
@click.option("--wake", metavar="COMMAND", help="Lets {robot} answer again.")
@click.option("--without", multiple=True, metavar="CLAUSE", help=f"A clause that is left out: {', '.join(CLAUSES)}.")
@click.option("--format", "form", type=click.Choice(["table", "json"]), default="table", show_default=True)
def command(
    target: str,
    setting: tuple[str, ...],
    mission: str | None,
    reach_m: float,
    lease_reach_m: float,
    silence: str | None,
    wake: str | None,
    without: tuple[str, ...],
    form: str,
) -> None:
    """Test a fleet clause by clause: robots are moved. The exit code is 0 if all hold, else 1.

    MODULE is a module or a Python file that has a FleetType, or the name of a registered fleet.
    """
    try:
        kind = fleet_type_of(target)
        settings = kind.checked_settings(settings_from(kind.settings, setting))
        kind.require_installed()
        there = two_robots(kind) if mission is None else _loaded(mission)
        stand = Stand(
            kind=kind,
            settings=settings,
            mission=there,
            reach_m=reach_m,
            lease_reach_m=lease_reach_m,
            silence=_command(silence),
            wake=_command(wake),
        )
        found = list(_told(findings(stand, without)))
    except MusterError as error:
        click.echo(str(error), err=True)
        sys.exit(USAGE)
    _show(found, form)
    sys.exit(CONFORMS if all(one.is_well for one in found) else LACKS)


def _loaded(mission: str) -> Mission:
    import muster

    return muster.load(mission)


def _told(found: Iterable[Finding]) -> Iterator[Finding]:
    """Say how far the test is: it takes minutes with real robots."""
    for one in found:
        click.echo(f"{one.clause}: {one.result}", err=True)
        yield one


def _show(found: Sequence[Finding], form: str) -> None:
    if form == "json":
        rows = [asdict(one) for one in found]
        click.echo(json.dumps({"conforms": all(one.is_well for one in found), "clauses": rows}, indent=2))
        return
    print_table(("clause", "what must hold", "", "seen, or lacking"), [tuple(asdict(one).values()) for one in found])
    lacking = [one.clause for one in found if not one.is_well]
    click.echo(f"lacks {sequence(lacking)}" if lacking else "conforms")


if __name__ == "__main__":
    command()
