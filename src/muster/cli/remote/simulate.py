"""`muster simulate --server`: carried out there, told and reported here."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE, INCOMPLETE, INTERRUPTED
from muster.cli.interrupt import ctrl_c_halts
from muster.cli.options import MissionFile, load_plan
from muster.cli.outputs import require_drawable, require_writable
from muster.cli.record_output import kept_record
from muster.cli.remote.uploads import kept, kept_plan
from muster.cli.remote.waiting import planned
from muster.cli.report_tables import print_report
from muster.cli.simulate import noise_of
from muster.exchange.mission_control import ConflictError
from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.plan import json_text

if TYPE_CHECKING:
    from muster.client import Client, RunningRun
    from muster.exchange.mission_control import World


def run(
    control: Client,
    *,
    mission: MissionFile,
    plan: Path | None,
    ignore: tuple[str, ...],
    world: World,
    seed: int,
    time_limit: float,
    iterations: int | None,
    avoidance: str,
    dt: float,
    speed: float | None,
    noises: tuple[str, ...],
    record: Path | None,
    html: Path | None,
    plot: Path | None,
    gantt: Path | None,
    require_complete: bool,
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Send the mission, have it planned unless there is a plan, follow the run, and report."""
    require_writable(None, (record, html, plot, gantt), mission.files, (plan,))
    require_drawable(plot, gantt)
    settings: dict[str, Any] = {"seed": seed, "dt_s": dt, "avoidance": avoidance, "ignore": list(ignore)}
    if noises:
        settings["noise"] = {kind: amount for kind, amount in asdict(noise_of(noises)).items() if amount}
    loaded = mission.load(verbose=verbose)
    number = _plan(control, loaded, plan, ignore, seed, time_limit, iterations, quiet=quiet, verbose=verbose)
    with ctrl_c_halts() as halt:  # no exception, so that there is no run of which we do not know
        carried = control.start(number, world=world, speed=speed, **settings)
    interrupted = _followed(carried, halt.is_set(), telling=speed is not None and not quiet)
    if carried.seen.report is None:
        raise MusterError(carried.seen.remark or f"run {carried.id} {carried.seen.state}, without a report")
    with kept_record(record, html, plot, gantt) as file:
        if file is not None:
            file.write_bytes(control.records.mcap(carried.id))
    if form == "json":
        click.echo(json_text(carried.seen.report), nl=False)
    else:
        print_report(carried.seen.report, loaded, with_tasks=verbose)
    if interrupted:
        click.echo(f"interrupted at {carried.seen.time_s:.1f} s of the mission", err=True)
        return INTERRUPTED
    return INCOMPLETE if require_complete and carried.seen.report["tasks_lost"] else DONE


def _plan(
    control: Client,
    mission: Mission,
    file: Path | None,
    ignore: tuple[str, ...],
    seed: int,
    time_limit: float,
    iterations: int | None,
    *,
    quiet: bool,
    verbose: bool,
) -> int:
    """The id of the plan that is carried out."""
    if file is not None:
        given = load_plan(file, mission, ignore, quiet=quiet, verbose=verbose)
        return kept_plan(control, mission, given, verbose=verbose).id
    limit = None if iterations is not None else time_limit
    there = kept(control, mission, verbose=verbose)
    ask = partial(control.plan, there, seed=seed, time_limit=limit, iterations=iterations, ignore=list(ignore))
    entry, interrupted = planned(ask, mission, quiet=quiet, time_limit=limit, iterations=iterations)
    if interrupted:
        click.echo(f"interrupted: plan {entry.id} is kept at the server; nothing was started", err=True)
        raise KeyboardInterrupt
    return entry.id


def _followed(carried: RunningRun, interrupted: bool, *, telling: bool) -> bool:
    """Tell what happens until it is over; whether Ctrl-C ended it, which cancels it there."""
    try:
        if interrupted:
            raise KeyboardInterrupt
        for message in carried.stream():
            if telling and message["type"] == "entry" and message["line"]:
                click.echo(f"{message['time_s']:9.1f} s  {message['line']}", err=True)
    except KeyboardInterrupt:
        interrupted = True
        with suppress(ConflictError):  # it has just ended
            carried.cancel()
    carried.wait()
    return interrupted
