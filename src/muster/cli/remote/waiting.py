"""Waiting for a plan that a server makes: progress on standard error, Ctrl-C stops or cancels the job there."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from muster.cli.interrupt import ctrl_c_halts
from muster.exchange.mission_control import ConflictError
from muster.mission.errors import MusterError
from muster.mission.model import Mission

if TYPE_CHECKING:
    from muster.client import RunningJob
    from muster.exchange.mission_control import PlanEntry


@contextmanager
def _shown(
    mission: Mission, quiet: bool, time_limit: float | None, iterations: int | None
) -> Iterator[Callable[[Mapping[str, Any]], None]]:
    """What shows the progress of a job, which is plain data."""
    from muster.allocation.stop import Progress
    from muster.cli.progress import progress_bar

    with progress_bar(not quiet, mission, time_limit, iterations) as show:

        def on_progress(told: Mapping[str, Any]) -> None:
            if show is not None and told.get("objective") is not None:
                done = round((told.get("share") or 0.0) * (iterations or 0))
                show(Progress(told["elapsed_s"], done, told["weight"], told["objective"]))

        yield on_progress


def planned(
    ask: Callable[[], RunningJob], mission: Mission, *, quiet: bool, time_limit: float | None, iterations: int | None
) -> tuple[PlanEntry, bool]:
    """The plan of the job that `ask` asks for, and whether Ctrl-C stopped the search for it.

    Raises
    ------
    KeyboardInterrupt
        at the second Ctrl-C, or where there is no plan yet, after the job was cancelled and that was said.
    """
    with _shown(mission, quiet, time_limit, iterations) as on_progress:
        with ctrl_c_halts() as halt:  # no exception, so that there is no job of which we do not know
            job = ask()
        try:
            try:
                if halt.is_set():
                    raise KeyboardInterrupt
                return job.wait(on_progress), False
            except KeyboardInterrupt:
                _stop(job)
                return job.wait(on_progress), True
        except KeyboardInterrupt:
            if job.seen.state != "cancelled":
                _cancel(job)
            raise


def _stop(job: RunningJob) -> None:
    """Ask for the best plan so far; one that waits for its turn has none."""
    try:
        if job.stop().state == "cancelled":
            click.echo(f"job {job.id} is cancelled at the server: it had not begun", err=True)
            raise KeyboardInterrupt
    except ConflictError:
        job.look()  # it has just ended


def _cancel(job: RunningJob) -> None:
    try:
        job.cancel()
    except MusterError as error:
        click.echo(f"job {job.id} may go on at the server: {error}", err=True)
    else:
        click.echo(f"job {job.id} is cancelled at the server, which keeps no plan of it", err=True)
