"""`muster fly`: a plan carried out by drones over MAVLink; without --arm it shows the orders and sends none."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack, closing
from functools import partial
from typing import TYPE_CHECKING

import click

from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.options.common import MissionFile, mission_argument
from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text
from muster.mission.system.interrupts import TO_END, ctrl_c_halts, signals_interrupt
from muster_robots.cli.going_on import GoingOn, as_wanted, going_on, recovered
from muster_robots.cli.last_lines import LastLines, show_final_states
from muster_robots.cli.real_robots import (
    carried_out,
    planned,
    read_given_plan,
    real_options,
    reported,
    require_outputs,
    start_in_time,
)
from muster_robots.cli.run_options import RealRunOptions
from muster_robots.fleet_settings import MavlinkSettings

if TYPE_CHECKING:
    from muster.execution.final_state import FinalState
    from muster_robots.mavlink import MavlinkFleet
    from muster_robots.mavlink.dry_run import Line


@click.command()
@mission_argument
@real_options("mavlink", MavlinkSettings, without=("unknown", "explore"))
def command(mission: MissionFile, options: RealRunOptions) -> int:
    """Carry out a plan of a MISSION with drones on PX4 or ArduPilot, over MAVLink.

    Without --arm nothing flies: telemetry is received, and the orders are shown. Ctrl-C lets drones
    hover. The exit code is 4 if a drone is armed at the end. Read docs/mavlink.md before the first flight.
    """
    from muster.running.claim_locks import robots_claimed
    from muster.running.robot_claims import claims_of_request
    from muster_robots.mavlink import MavlinkFleet

    require_outputs(options, mission.files)
    loaded = mission.load(verbose=options.verbose)
    given, how = read_given_plan(options, loaded), going_on(options, loaded)
    options = as_wanted(options, how)
    settings = options.request.settings
    with ExitStack() as stack:
        stack.enter_context(robots_claimed(claims_of_request(options.request)))
        made = MavlinkFleet(loaded, settings.endpoints, settings, height_m=settings.height_m)
        fleet = stack.enter_context(closing(made))
        stack.enter_context(signals_interrupt())
        last_lines = stack.enter_context(LastLines(lambda: how.judged(fleet.final_states())))
        plan = None if how.again else given or planned(options, loaded, start_in_time(loaded, fleet, options))
        if plan is not None and not options.quiet:
            _warn(loaded, plan, settings.height_m)
        _connect(fleet, how, settings)
        if how.again:
            _require_arm(how, settings)
        elif plan is not None and not settings.arm:
            return _show(loaded, plan, fleet, options.form)
        how.require_nobody_left(fleet.final_states())
        last_lines.begun = True
        return _fly(plan, fleet, how, options)


def _connect(fleet: MavlinkFleet, how: GoingOn, settings: MavlinkSettings) -> None:
    """Hear all drones; where a drone is refused, an interrupted run that has left it there is the reason."""
    try:
        fleet.connect(settings.wait_s, again=how.again)
    except MusterError:
        if how.interrupted is not None:
            how.require_nobody_left(fleet.final_states())
        raise


def _require_arm(how: GoingOn, settings: MavlinkSettings) -> None:
    if not settings.arm:
        asked = "--resume" if how.resumes else "--recover"
        done = "" if how.before is None else f" ({how.path}: {how.before.progress})"
        raise ParameterError(f"{asked} given without --arm{done}; expected both: without --arm nothing is sent")


def _warn(mission: Mission, plan: Plan, height: float | None) -> None:
    """Warn where drones, which do not avoid each other, would meet."""
    from muster import verify
    from muster.execution.reports.itinerary import heights_of_work, itineraries
    from muster.execution.reports.separation import meetings

    for task, own in heights_of_work(mission).items():
        if height is not None and own != height:
            told = f"{task}: flown at {height:g} m (--height), not at {own:g} m (height_m); expected places with z"
            click.echo(f"warning: {told}", err=True)
    ways = itineraries(mission, verify(mission, plan))
    for meeting in meetings([way if height is None else way.at_least(height) for way in ways]):
        click.echo(f"warning: {meeting}", err=True)


def _show(mission: Mission, plan: Plan, fleet: MavlinkFleet, form: str) -> int:
    """Print the orders of each drone, in order, and which drones are armed; returns the exit code."""
    from muster.execution import way_of
    from muster_robots.mavlink.dry_run import lines_of

    rows = lines_of(mission, plan, fleet, way_of(mission))
    if form == "json":
        click.echo(json_text({"would_send": [row.as_dict() for row in rows]}), nl=False)
    else:
        _print_orders(rows)
    armed = [state for state in fleet.final_states() if state.moving]
    show_final_states(armed, asks=True)
    return exit_code_if((Ending.STILL_MOVING, armed))


def _print_orders(rows: Sequence[Line]) -> None:
    from muster.cli.tables.table import print_table

    table = [
        (
            row.robot,
            row.task,
            _degrees(row.lat_deg),
            _degrees(row.lon_deg),
            f"{row.above_home_m:.1f}",
            f"{row.hold_s:g}",
        )
        for row in rows
    ]
    heads = ("robot", "task", "latitude", "longitude", "above home m", "hold s")
    print_table(heads, table, right=heads[2:])
    click.echo("nothing was sent but heartbeats and requests for telemetry; --arm flies it", err=True)


def _degrees(value: float | None) -> str:
    return "-" if value is None else f"{value:.7f}"


def _fly(plan: Plan | None, fleet: MavlinkFleet, how: GoingOn, options: RealRunOptions) -> int:
    def states() -> list[FinalState]:
        return how.judged(fleet.final_states())

    with ctrl_c_halts(TO_END) as halt:
        if how.recovers:
            return recovered(how, fleet, options, halt, lambda: None)
        end = partial(fleet.finish, options.request.settings.at_end, halt.is_set)
        report = carried_out(how.mission, plan, fleet, how, options, halt, states, at_end=end)
    for fault in fleet.faults:
        click.echo(str(fault), err=True)
    return reported(how.mission, report, options, halt, "drones were told to hover", states())
