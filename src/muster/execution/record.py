"""Observers of a mission under way, what they are told, and several recorders as one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Protocol

from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.motion.port import Telemetry
from muster.state import ExecutionEvent

Tell = Callable[[ExecutionEvent], None]
"""Receives events that happen now: their time is put in."""


class Observer(Protocol):
    """Receives everything, in the order in which it happens. Times are seconds of the mission's clock."""

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """An event; `data` is plain: texts, numbers, lists and mappings."""
        ...

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        """New telemetry of a robot."""
        ...

    def on_plan(self, now: float, plan: Plan) -> None:
        """The plan from now on: of the whole mission, what is done included."""
        ...


class Recorder(Observer, Protocol):
    """Receives the positions of robots and the report, too; see `muster.report.record.RecordWriter`."""

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """Robots are there: (n, 3) metres, (n,) radians, (n, 3) m/s in the map frame, NaN of those that are not.

        A row for each robot of the mission, then for each that joined.
        """
        ...

    def on_report(self, report: dict[str, Any]) -> None:
        """The mission is over."""
        ...


class NoObserver:
    """An observer and recorder that keeps nothing."""

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        pass

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        pass

    def on_plan(self, now: float, plan: Plan) -> None:
        pass

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        pass

    def on_report(self, report: dict[str, Any]) -> None:
        pass


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
