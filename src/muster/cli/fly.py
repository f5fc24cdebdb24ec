"""`muster fly`: a plan carried out by drones over MAVLink; without --arm it shows the orders and sends none."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from contextlib import ExitStack, closing
from typing import TYPE_CHECKING, Literal

import click

from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.options import Finite, MissionFile, mission_argument
from muster.cli.real_robots import (
    LastLines,
    RealRunOptions,
    carried_out,
    planned,
    read_given_plan,
    real_options,
    reported,
    require_outputs,
    show_final_states,
    start_in_time,
)
from muster.mission.errors import ParameterError
from muster.mission.interrupts import TO_END, ctrl_c_halts, signals_interrupt
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text

if TYPE_CHECKING:
    from muster.bridges.mavlink import MavlinkFleet
    from muster.bridges.mavlink.autopilots import AtEnd
    from muster.bridges.mavlink.dry_run import Line


@click.command()
@mission_argument
@click.option(
    "--endpoint",
    "endpoints",
    multiple=True,
    required=True,
    metavar="ROBOT=ENDPOINT",
    help="udp:HOST:PORT (listens), udpout:HOST:PORT (calls), serial:DEVICE[:BAUD]; #SYSTEM after it, of several on it.",
)
@click.option("--arm", is_flag=True, help="Arm and fly. Without it nothing is sent but heartbeats and requests.")
@click.option("--offboard", is_flag=True, help="Send way points one by one instead of uploading missions.")
@click.option(
    "--local-frame",
    type=click.Choice(["north", "forward"]),
    default="north",
    show_default=True,
    help="With --offboard and no origin: what a drone calls north is north, or forward at power-up (no compass).",
)
@click.option(
    "--height", type=Finite(0.5, 500), metavar="M", help="Height of flight above home, for a mission in the plane."
)
@click.option(
    "--low-battery",
    type=Finite(1, 99),
    default=25,
    show_default=True,
    metavar="%",
    help="Battery level below which a drone returns.",
)
@click.option(
    "--wait",
    type=Finite(0.1, 600),
    default=10,
    show_default=True,
    metavar="S",
    help="Seconds to wait for drones to answer.",
)
@click.option(
    "--at-end",
    type=click.Choice(["hold", "return", "land"]),
    default="hold",
    show_default=True,
    help="When all is done; return and land wait until drones have landed.",
)
@real_options
def command(
    mission: MissionFile,
    endpoints: tuple[str, ...],
    arm: bool,
    offboard: bool,
    local_frame: Literal["north", "forward"],
    height: float | None,
    low_battery: float,
    wait: float,
    at_end: AtEnd,
    options: RealRunOptions,
) -> int:
    """Carry out a plan of a MISSION with drones on PX4 or ArduPilot, over MAVLink.

    Without --arm nothing flies: telemetry is received, and the orders are shown. Ctrl-C lets drones
    hover. The exit code is 4 if a drone is armed at the end. Read docs/mavlink.md before the first flight.
    """
    from muster.bridges.mavlink import MavlinkFleet
    from muster.bridges.fleet_settings import FlightSettings
    from muster.running.claim_locks import robots_claimed
    from muster.running.robot_claims import claims_of

    require_outputs(options, mission.files)
    loaded = mission.load(verbose=options.verbose)
    given = read_given_plan(options, loaded)
    claims = claims_of("mavlink", {"endpoints": _by_robot(endpoints)})
    settings = Settings(arm=arm, offboard=offboard, local_frame=local_frame, low_battery=low_battery / 100)
    with ExitStack() as stack:
        stack.enter_context(robots_claimed(claims))
        fleet = stack.enter_context(closing(MavlinkFleet(loaded, _by_robot(endpoints), settings, height_m=height)))
        stack.enter_context(signals_interrupt())
        last_lines = stack.enter_context(LastLines(fleet.final_states))
        start = start_in_time(loaded, fleet, options)
        plan = given or planned(options, loaded, start)
        if not options.quiet:
            _warn(loaded, plan, height)
        fleet.connect(wait)
        if not arm:
            return _show(loaded, plan, fleet, options.form)
        last_lines.begun = True
        return _fly(loaded, plan, fleet, at_end, options)


def _by_robot(endpoints: tuple[str, ...]) -> dict[str, str]:
    named: dict[str, str] = {}
    for text in endpoints:
        robot, _, endpoint = text.partition("=")
        if not endpoint or robot in named:
            raise ParameterError(f"--endpoint: {text}; expected ROBOT=ENDPOINT, once for each robot")
        named[robot] = endpoint
    return named


def _warn(mission: Mission, plan: Plan, height: float | None) -> None:
    """Warn where drones, which do not avoid each other, would meet."""
    from muster import verify
    from muster.exchange.altitudes import heights_of_work
    from muster.exchange.itinerary import itineraries
    from muster.exchange.separation import meetings

    for task, own in heights_of_work(mission).items():
        if height is not None and own != height:
            told = f"{task}: flown at {height:g} m (--height), not at {own:g} m (height_m); expected places with z"
            click.echo(f"warning: {told}", err=True)
    ways = itineraries(mission, verify(mission, plan))
    for meeting in meetings([way if height is None else way.at_least(height) for way in ways]):
        click.echo(f"warning: {meeting}", err=True)


def _show(mission: Mission, plan: Plan, fleet: MavlinkFleet, form: str) -> int:
    """Print the orders of each drone, in order, and which drones are armed; returns the exit code."""
    from muster.bridges.mavlink.dry_run import lines_of
    from muster.execution import way_of

    rows = lines_of(mission, plan, fleet, way_of(mission))
    if form == "json":
        click.echo(json_text({"would_send": [row.as_dict() for row in rows]}), nl=False)
    else:
        _print_orders(rows)
    armed = [state for state in fleet.final_states() if state.moving]
    show_final_states(armed, asks=True)
    return exit_code_if((Ending.STILL_MOVING, armed))


def _print_orders(rows: Sequence[Line]) -> None:
    from muster.cli.tables import print_table

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


def _fly(mission: Mission, plan: Plan, fleet: MavlinkFleet, at_end: AtEnd, options: RealRunOptions) -> int:
    with ctrl_c_halts(TO_END) as halt:
        report = carried_out(mission, plan, fleet, options, halt, at_end=lambda: _end(fleet, at_end, halt))
    for fault in fleet.faults:
        click.echo(str(fault), err=True)
    return reported(mission, report, options, halt, "drones were told to hover", fleet.final_states())


def _end(fleet: MavlinkFleet, at_end: AtEnd, halt: threading.Event) -> None:
    """Give the order of --at-end to all drones; without one they hover."""
    if at_end != "hold" and not halt.is_set():
        fleet.end(at_end)
        fleet.await_landing(halt.is_set)
        if halt.is_set():  # Ctrl-C meanwhile
            fleet.stop()
