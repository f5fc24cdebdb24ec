"""`muster run`: a plan carried out by a registered fleet of real robots, of a bridge or of an installed package."""

from __future__ import annotations

import click

from muster.cli.options.common import MissionFile, mission_argument
from muster.mission.records import key_of, required, specified
from muster.mission.system.interrupts import TO_END, ctrl_c_halts
from muster.running.fleet_registry import FLEETS
from muster_robots.cli.going_on import as_wanted, going_on, left_robots_told
from muster_robots.cli.real_robots import (
    carried_out_from_here,
    read_given_plan,
    real_options,
    require_outputs,
)
from muster_robots.cli.run_options import RealRunOptions


def _list(context: click.Context, _: click.Parameter, asked: bool) -> None:
    if not asked or context.resilient_parsing:
        return
    from muster.cli.tables.table import print_table

    rows = []
    for name, fleet in FLEETS.usable().items():
        rows.append((name, "", "", f"can: {', '.join(fleet.abilities)}"))
        rows += [
            (name, key_of(f), "required" if required(f) else f"{f.default}", f.metadata["doc"])
            for f in specified(fleet.settings)
        ]
    print_table(("fleet", "setting", "default", "what it is"), rows)
    context.exit()


@click.command()
@mission_argument
@click.option("--fleet", required=True, metavar="NAME", help="ros1, ros2, mavlink, or a fleet of an installed package.")
@click.option(
    "--setting",
    multiple=True,
    metavar="KEY=VALUE",
    help="A setting of the fleet; KEY.NAME=VALUE in a mapping, such as endpoints.r_0=udp:0.0.0.0:14550.",
)
@click.option(
    "--list-fleets",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_list,
    help="List the fleets, what they can do, and their settings.",
)
@real_options()
def command(mission: MissionFile, options: RealRunOptions) -> int:
    """Carry out a MISSION with a fleet of real robots, in real time.

    A fleet declares its settings, what a run claims and what it can do. Ctrl-C lets robots stay where they are. The
    exit code is 4 if a robot still flies or drives at the end, and 5 if robots are safe and tasks were lost.
    """
    from muster.running.claimed_fleet import claimed_fleet

    require_outputs(options, mission.files)
    loaded = mission.load(verbose=options.verbose)
    given, how = read_given_plan(options, loaded), going_on(options, loaded)
    options = as_wanted(options, how)
    with (
        ctrl_c_halts(TO_END) as halt,
        left_robots_told(how),
        claimed_fleet(loaded, options.request, halt, again=how.again) as (fleet, at_end),
    ):
        return carried_out_from_here(fleet, given, how, options, halt, at_end)
