"""The progress bar of planning, on standard error and only on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from muster.mission.model import Mission

if TYPE_CHECKING:
    from muster.allocation.stop import Progress

_QUIET_UNTIL_S = 0.5


@contextmanager
def progress_bar(wanted: bool, mission: Mission) -> Iterator[Callable[[Progress], None] | None]:
    """A function that shows the progress it is called with; None without a terminal."""
    if not wanted or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    text = TextColumn("best {task.fields[best]}  tasks {task.fields[done]}/{task.fields[total_tasks]}")
    bar = Bar(
        TextColumn("planning"), BarColumn(), TimeElapsedColumn(), text, console=Console(stderr=True), transient=True
    )
    whole = sum(task.priority for task in mission.tasks)
    unweighted = all(task.priority == 1 for task in mission.tasks)
    line = bar.add_task(
        "", total=1.0, best="-", done="-", total_tasks=f"{whole:g}" if unweighted else f"{whole:g} by weight"
    )

    def show(progress: Progress) -> None:
        if progress.elapsed_s < _QUIET_UNTIL_S:
            return
        bar.start()
        share, best = progress.share or 0.0, f"{progress.objective:.2f}"
        bar.update(line, completed=share, best=best, done=f"{progress.weight:g}")

    try:
        yield show
    finally:
        bar.stop()
