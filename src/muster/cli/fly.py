"""`muster fly`: a plan carried out by drones over MAVLink; without --arm it only shows what would be sent."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.exits import DONE, INCOMPLETE, INTERRUPTED
from muster.cli.halting import ctrl_c_halts
from muster.cli.options import (
    Finite,
    format_option,
    load_mission,
    mission_argument,
    quiet_option,
    require_complete_option,
    say_of_plan,
)
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text, read_plan

if TYPE_CHECKING:
    from muster.bridges.mavlink import MavlinkFleet
    from muster.execution.executor import Happening

_FILE = click.Path(path_type=Path)
_AT_END = ("hold", "return", "land")


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
@click.option("--plan", type=_FILE, metavar="PLAN", help="The plan.  [default: one that search makes]")
@click.option("--arm", is_flag=True, help="Arm and fly. Without it nothing is sent but heartbeats and requests.")
@click.option("--offboard", is_flag=True, help="Say way points one by one instead of uploading missions.")
@click.option("--height", type=Finite(0.5, 500), metavar="M", help="Of flight above home, for a mission in the plane.")
@click.option("--low-battery", type=Finite(1, 99), default=25, show_default=True, metavar="%", help="Return below it.")
@click.option("--wait", type=Finite(0.1, 600), default=10, show_default=True, metavar="S", help="For drones to answer.")
@click.option("--at-end", type=click.Choice(_AT_END), default="hold", show_default=True, help="When all is done.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of all random choices.")
@click.option(
    "--time-limit", type=click.FloatRange(min=0), default=2.0, show_default=True, metavar="S", help="Of planning."
)
@require_complete_option
@format_option
@quiet_option
def command(
    mission: str,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    endpoints: tuple[str, ...],
    plan: Path | None,
    arm: bool,
    offboard: bool,
    height: float | None,
    low_battery: float,
    wait: float,
    at_end: str,
    seed: int,
    time_limit: float,
    require_complete: bool,
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Carry out a plan of a MISSION with drones on PX4 or ArduPilot, over MAVLink.

    Without --arm nothing flies: the drones are listened to, and it is shown what they would be told. Ctrl-C
    lets them hover. Read docs/mavlink.md before the first flight.
    """
    from muster import solve
    from muster.bridges.mavlink import MavlinkFleet
    from muster.bridges.mavlink.settings import Settings

    loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
    settings = Settings(arm=arm, offboard=offboard, low_battery=low_battery / 100)
    fleet = MavlinkFleet(loaded, _by_robot(endpoints), settings, height_m=height)
    try:
        planned = solve(loaded, seed=seed, time_limit=time_limit) if plan is None else read_plan(plan)
        if plan is not None:
            say_of_plan(planned, plan, loaded, quiet=quiet, verbose=verbose)
        fleet.connect(wait)
        if not arm:
            _show(loaded, planned, fleet, form)
            return DONE
        return _fly(loaded, planned, fleet, seed, at_end, form, quiet=quiet, verbose=verbose, whole=require_complete)
    finally:
        fleet.close()


def _by_robot(endpoints: tuple[str, ...]) -> dict[str, str]:
    named: dict[str, str] = {}
    for text in endpoints:
        robot, _, endpoint = text.partition("=")
        if not endpoint or robot in named:
            raise ParameterError(f"--endpoint: {text}; expected ROBOT=ENDPOINT, once for each robot")
        named[robot] = endpoint
    return named


def _show(mission: Mission, plan: Plan, fleet: MavlinkFleet, form: str) -> None:
    """What each drone would be told, in order."""
    from muster.bridges.mavlink.dry_run import lines_of
    from muster.cli.tables import print_table

    rows = lines_of(mission, plan, fleet)
    if form == "json":
        click.echo(json_text({"would_send": [row.as_dict() for row in rows]}), nl=False)
        return
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


def _fly(
    mission: Mission,
    plan: Plan,
    fleet: MavlinkFleet,
    seed: int,
    at_end: str,
    form: str,
    *,
    quiet: bool,
    verbose: bool,
    whole: bool,
) -> int:
    from muster._live import carry_out_live
    from muster.cli.report_tables import print_report

    with ctrl_c_halts() as halt:
        report = carry_out_live(mission, plan, fleet, seed=seed, on_happening=None if quiet else _tell, halt=halt)
        if not halt.is_set():
            _end(fleet, at_end)
    for fault in fleet.faults:
        click.echo(str(fault), err=True)
    if form == "json":
        click.echo(json_text(report.as_dict()), nl=False)
    else:
        print_report(report.as_dict(), mission, with_tasks=verbose)
    if halt.is_set():
        click.echo(f"interrupted at {report.mission_time_s:.1f} s of the mission: drones were told to hover", err=True)
        return INTERRUPTED
    return INCOMPLETE if whole and report.tasks_lost else DONE


def _end(fleet: MavlinkFleet, at_end: str) -> None:
    """What drones do when all is done. To hover they must be told: way points that are said one by one end now."""
    {"hold": fleet.stop, "return": fleet.go_back, "land": fleet.land}[at_end]()


def _tell(happening: Happening) -> None:
    from muster.report.record.messages import event_line

    click.echo(f"{happening.at_s:9.1f} s  {event_line(happening.kind, happening.data)}", err=True)
