"""A recorder that adds what robots have used to events, so that the log alone is enough for recovery."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from muster.execution import Executor, Recorder
from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.motion.port import Telemetry

_OF_WORK = ("sets_out", "arrives", "starts", "ends", "goes_to_station", "service_begins", "service_ends")


class Gauged:
    """A recorder that adds the robots' usage to events, so that the log alone is enough for recovery."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self.executor: Executor | None = None

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        if kind in _OF_WORK and self.executor is not None:
            data = {**data, "used": self.executor.crew[data["robot"]].used}
            if kind == "ends":
                ledger, task = self.executor.ledger, data["task"]
                data |= {"usage": list(ledger.usage[task]), "arrival_usage": ledger.arrival_usage[task]}
        self._recorder.on_event(now, kind, data)

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        self._recorder.on_telemetry(now, robot, telemetry)

    def on_plan(self, now: float, plan: Plan) -> None:
        self._recorder.on_plan(now, plan)

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        self._recorder.on_step(now, positions, headings, velocities)

    def on_report(self, report: dict[str, Any]) -> None:
        self._recorder.on_report(report)
