"""`muster simulate`: a plan carried out by moving robots, with what it cost beside what was planned."""

from __future__ import annotations

import tempfile
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.exits import DONE, INCOMPLETE
from muster.cli.options import format_option, load_mission, mission_argument, quiet_option, require_complete_option
from muster.cli.outputs import require_drawable, require_writable
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text, read_plan

if TYPE_CHECKING:
    from muster.execution.report import Report

_FILE = click.Path(path_type=Path)
_AVOIDANCE = ("orca", "rvo", "hrvo", "none")


@click.command()
@mission_argument
@click.option("--plan", type=_FILE, metavar="PLAN", help="The plan.  [default: one that search makes]")
@click.option("--world", type=click.Choice(["kinematic"]), default="kinematic", show_default=True, help="Where.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of all random choices.")
@click.option(
    "--time-limit", type=click.FloatRange(min=0), default=2.0, show_default=True, metavar="S", help="Of planning."
)
@click.option("--iterations", type=click.IntRange(min=0), metavar="N", help="Of planning, instead of the time limit.")
@click.option(
    "--avoidance", type=click.Choice(_AVOIDANCE), default="orca", show_default=True, help="How robots pass each other."
)
@click.option(
    "--dt", type=click.FloatRange(min=0, min_open=True), default=0.1, show_default=True, metavar="S", help="Step."
)
@click.option(
    "--speed", type=click.FloatRange(min=0, min_open=True), metavar="X", help="X times real time.  [default: at once]"
)
@click.option("--record", type=_FILE, metavar="FILE", help="Write a record of it (.mcap), for `muster replay`.")
@click.option("--html", type=_FILE, metavar="FILE", help="Write a page to look at in a browser, offline.")
@click.option("--plot", type=_FILE, metavar="FILE", help="Draw where the robots went (.png, .svg, .pdf).")
@require_complete_option
@format_option
@quiet_option
def command(
    mission: str,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    plan: Path | None,
    world: str,
    seed: int,
    time_limit: float,
    iterations: int | None,
    avoidance: str,
    dt: float,
    speed: float | None,
    record: Path | None,
    html: Path | None,
    plot: Path | None,
    require_complete: bool,
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Carry out a plan of a MISSION with moving robots, in virtual time, and say what it took.

    Robots keep their speeds and go around each other; the mission's events happen, and what is left is planned again.
    """
    require_writable(None, (record, html, plot), (mission, robots, suitability), (plan,))
    require_drawable(plot)
    loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
    planned = _plan(loaded, plan, seed, time_limit, iterations)
    with tempfile.TemporaryDirectory() if record is None and (html or plot) else nullcontext() as folder:
        file = record if folder is None else Path(folder) / "record.mcap"
        report = _carried_out(loaded, planned, file, seed=seed, dt_s=dt, avoidance=avoidance, speed=speed)
        if file is not None:
            _show(file, html, plot)
    if form == "json":
        click.echo(json_text(report.as_dict()), nl=False)
    else:
        _print(loaded, report)
    return INCOMPLETE if require_complete and report.tasks_lost else DONE


def _plan(mission: Mission, file: Path | None, seed: int, time_limit: float, iterations: int | None) -> Plan:
    from muster import solve

    if file is not None:
        return read_plan(file)
    return solve(mission, seed=seed, time_limit=None if iterations is not None else time_limit, iterations=iterations)


def _carried_out(
    mission: Mission, plan: Plan, file: Path | None, *, seed: int, dt_s: float, avoidance: str, speed: float | None
) -> Report:
    from muster._carrying_out import carry_out

    if file is None:
        return carry_out(mission, plan, seed=seed, dt_s=dt_s, avoidance=avoidance, speed=speed)
    from muster.report.record import RecordWriter

    with RecordWriter(file, mission) as recorder:
        return carry_out(mission, plan, seed=seed, dt_s=dt_s, avoidance=avoidance, speed=speed, recorder=recorder)


def _show(file: Path, html: Path | None, plot: Path | None) -> None:
    from muster.report.record import read_record

    if html is None and plot is None:
        return
    recording = read_record(file)
    if html is not None:
        from muster.report.page import write_page

        write_page(html, recording)
    if plot is not None:
        from muster.report.files import save_figure
        from muster.report.flown import plot_flown

        save_figure(plot_flown(recording), plot)


def _print(mission: Mission, report: Report) -> None:
    from muster.cli.tables import counted, print_table

    unit = "s" if mission.rules.usage == "time" else "m"
    rows = [
        (
            robot.robot,
            f"{robot.usage_planned:.2f}",
            f"{robot.usage_flown:.2f}",
            _excess(robot.usage_planned, robot.usage_flown),
        )
        for robot in report.robots
    ]
    columns = ("robot", f"planned [{unit}]", f"flown [{unit}]", "difference")
    print_table(columns, rows, title=f"{mission.name}: carried out", right=columns[1:])
    least = "-" if report.min_distance_m is None else f"{report.min_distance_m:.2f} m"
    done, lost = len(report.tasks_done), len(report.tasks_lost)
    for name, value in (
        ("mission time", f"{report.mission_time_s:.1f} s"),
        ("tasks done", f"{done} of {done + lost}"),
        ("waiting", f"{report.waiting_s:.1f} s"),
        ("least distance", f"{least}, {counted(report.contacts, 'contact')}"),
        ("planned again", counted(report.reallocations, "time")),
    ):
        click.echo(f"{name:<17} {value}")
    if report.tasks_lost:
        print_table(("task lost", "reason"), report.tasks_lost)


def _excess(planned: float, flown: float) -> str:
    return f"{100 * (flown / planned - 1):+.1f} %" if planned > 0 else "-"
