"""`muster path --lifelong`: runs of instances of the League of Robot Runners."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path as File
from typing import Any

import click

from muster.cli.exits import DONE
from muster.mission.plan import json_text

_STEPS = 600


@dataclass(frozen=True)
class Settings:
    """Settings of a run; the same ones give the same run."""

    steps: int | None
    checks: int | None
    seed: int


def run(file: File, settings: Settings, form: str, output: File | None, *, quiet: bool) -> int:
    """Run an instance, judge it, print its figures, and write what the league writes.

    Raises
    ------
    KeyboardInterrupt
        if Ctrl-C ended the run: the steps until then are judged, printed and written.
    """
    from muster.mission.system.interrupts import ctrl_c_halts
    from muster.traffic.lifelong.league_faults import league_faults
    from muster.traffic.lifelong.league_instance import read_league
    from muster.traffic.lifelong.league_results import figures_of, league_output
    from muster.traffic.lifelong.league_run import CHECKS, run_league

    instance = read_league(file)
    steps, checks = settings.steps or _STEPS, settings.checks or CHECKS
    with ctrl_c_halts() as halt, _progress(steps, wanted=not quiet) as show:

        def go_on(step: int, finished: int) -> bool:
            show(step, finished)
            return not halt.is_set()

        done = run_league(instance, steps, checks=checks, seed=settings.seed, progress=go_on)
    wrong = league_faults(done)
    if wrong:
        raise AssertionError(f"the judge rejects this run: {wrong[0]}")
    figures = figures_of(done) | {"seed": settings.seed}
    if output is not None:
        output.write_text(json_text(league_output(done)))
    if form == "json":
        click.echo(json_text(figures), nl=False)
    else:
        _print(instance.name, figures)
    if halt.is_set():
        raise KeyboardInterrupt
    return DONE


@contextmanager
def _progress(steps: int, *, wanted: bool) -> Iterator[Callable[[int, int], None]]:
    """Yield a function that shows steps and finished tasks, on standard error and only on a terminal."""
    if not wanted or not sys.stderr.isatty():
        yield lambda step, finished: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    text = TextColumn("step {task.completed}/{task.total}  tasks finished {task.fields[finished]}")
    with Progress(BarColumn(), TimeElapsedColumn(), text, console=Console(stderr=True), transient=True) as bar:
        line = bar.add_task("", total=steps, finished=0)
        yield lambda step, finished: bar.update(line, completed=step, finished=finished)


def _print(name: str, figures: dict[str, Any]) -> None:
    from muster.cli.tables.table import print_table
    from muster.mission.texts.counting import counted

    counts = ("tasks_finished", "tasks_revealed", "tasks_impossible", "sum_of_costs", "makespan")
    rows = [(key.replace("_", " "), f"{figures[key]:,}") for key in counts if key != "tasks_impossible" or figures[key]]
    rows.append(("tasks per step", f"{figures['tasks_per_step']:.3f}"))
    rows += [(f"{which} step [s]", f"{figures[f'{which}_step_s']:.3f}") for which in ("greatest", "mean")]
    print_table(("run", "number"), rows, right=("number",))
    robots, steps = counted(figures["robots"], "robot"), counted(figures["steps"], "step")
    click.echo(f"{name}: {robots}, {steps}, seed {figures['seed']}; judged, no conflict")
