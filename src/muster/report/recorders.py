"""Combines several recorders into one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from muster.execution import Recorder
from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.motion.port import Telemetry


class Recorders:
    """Forwards each call to several recorders, in their order; see `execution.Recorder`.

    Parameters
    ----------
    on_failure
        receives the error of a recorder, such as that of a full disk. That recorder receives no more calls, as robots
        do not wait for a record. None: the error is raised.
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

    def attempt(self, act: Callable[[], None]) -> bool:
        """Do something that may fail like a recorder; return whether it succeeded."""
        try:
            act()
        except Exception as error:
            if self._on_failure is None:
                raise
            self._on_failure(error)
            return False
        return True

    def _each(self, tell: Callable[[Recorder], None]) -> None:
        self._recorders = [one for one in self._recorders if self.attempt(partial(tell, one))]
