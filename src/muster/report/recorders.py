"""Several recorders that are told the same."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from muster.execution import Recorder
from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.motion.port import Telemetry


class Recorders:
    """Tells each what it is told, in the order in which they are given; see `execution.Recorder`.

    Parameters
    ----------
    on_failure
        is told of an error, such as that of a full disk: who raised it is told nothing more, as nobody waits for a
        record where robots move. None: the error goes on to who tells.
    """

    def __init__(self, *recorders: Recorder, on_failure: Callable[[Exception], None] | None = None) -> None:
        self._recorders, self._on_failure = list(recorders), on_failure

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        self._each(lambda recorder: recorder.on_event(now, kind, data))

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        self._each(lambda recorder: recorder.on_telemetry(now, robot, telemetry))

    def on_plan(self, now: float, plan: Plan) -> None:
        self._each(lambda recorder: recorder.on_plan(now, plan))

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        self._each(lambda recorder: recorder.on_step(now, positions, headings, velocities))

    def on_report(self, report: dict[str, Any]) -> None:
        self._each(lambda recorder: recorder.on_report(report))

    def forgiving(self, act: Callable[[], None]) -> bool:
        """Do something that may fail as telling may; returns whether it did not."""
        try:
            act()
        except Exception as error:
            if self._on_failure is None:
                raise
            self._on_failure(error)
            return False
        return True

    def _each(self, tell: Callable[[Recorder], None]) -> None:
        self._recorders = [one for one in self._recorders if self.forgiving(partial(tell, one))]
