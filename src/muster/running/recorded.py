"""The observers of a run, a record file among them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from muster.mission.model import Mission

if TYPE_CHECKING:
    from muster.execution import Recorder


@contextmanager
def recorded(
    mission: Mission,
    record: str | Path | None,
    observers: Sequence[Recorder],
    on_failure: Callable[[Exception], None] | None = None,
) -> Iterator[Recorder | None]:
    """One observer for all of a run, a record file among them if `record` names one; None without any."""
    recorders = list(observers)
    if record is not None:
        from muster.report.record import RecordWriter

        recorders.append(file := RecordWriter(record, mission))
    if not recorders:
        yield None
        return
    from muster.execution.record import Recorders

    observer = Recorders(*recorders, on_failure=on_failure)
    try:
        yield observer
    finally:
        if record is not None:
            observer.attempt(file.close)
