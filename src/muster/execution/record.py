"""Observers of a mission under way, and what they are told."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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
    """Keeps nothing."""

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        pass

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        pass

    def on_plan(self, now: float, plan: Plan) -> None:
        pass
