"""Several recorders that are told the same."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.motion.port import Telemetry


class Recorders:
    """Tells each what it is told, in the order in which they are given; see `_carrying_out.Recorder`."""

    def __init__(self, *recorders: Any) -> None:
        self._recorders = recorders

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        for recorder in self._recorders:
            recorder.on_event(now, kind, data)

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        for recorder in self._recorders:
            recorder.on_telemetry(now, robot, telemetry)

    def on_plan(self, now: float, plan: Plan) -> None:
        for recorder in self._recorders:
            recorder.on_plan(now, plan)

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        for recorder in self._recorders:
            recorder.on_step(now, positions, headings, velocities)

    def on_report(self, report: dict[str, Any]) -> None:
        for recorder in self._recorders:
            recorder.on_report(report)
