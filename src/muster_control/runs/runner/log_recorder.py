"""The recorder of a run: writes events as log entries, and positions as tracks."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Protocol

import numpy as np

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.values.arrays import Floats
from muster.report.record.json_messages import json_bytes
from muster.report.record.plan_changes import PlanChanges
from muster.report.record.routes import RouteLines
from muster.state import MissionState
from muster.state.words import words_of
from muster_control.runs.log.tracks import Row, Steps, Track, packed


class Out(Protocol):
    """Receives entries and stretches of tracks."""

    def entry(self, text: Mapping[str, Any]) -> None: ...
    def stretch(self, from_s: float, until_s: float, data: bytes) -> None: ...


class LogRecorder:
    """Writes a run's log; a `Recorder`.

    Parameters
    ----------
    mission
        the mission of the run.
    out
        receives new entries and stretches.
    state
        what is known of the mission, to look at; once there is an executor its state takes the place of this one.
    seq
        the last entry of the log.
    tracked_s
        the time up to which tracks are written already.
    stretch_s
        seconds of mission time per stretch.
    """

    def __init__(
        self,
        mission: Mission,
        out: Out,
        state: MissionState,
        *,
        seq: int = 0,
        tracked_s: float = 0.0,
        stretch_s: float = 5.0,
    ) -> None:
        self._out, self.state, self.seq = out, state, seq
        self._routes, self._plan_changes = RouteLines(mission), PlanChanges(whole=seq == 0)
        self._track = Track(stretch_s)
        self.tracked_s = tracked_s if seq else -1.0
        self._held: list[Callable[[], None]] | None = None
        self._now = max(0.0, state.now_s)
        self.rows: dict[str, Row] = {}
        self.rows_s = 0.0

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """See `Recorder`."""
        states = np.column_stack([positions, headings, velocities])
        rows = zip(self.state.robots, states.tolist(), strict=True)
        self.rows = {name: row for name, row in rows if all(map(math.isfinite, row))}
        self.rows_s = float(now)
        self._now = max(self._now, self.rows_s)
        if self.rows_s > self.tracked_s + 1e-6:
            self._keep(self._track.add(self.rows_s, self.rows))

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """See `Recorder`."""
        self.write(now, kind, data)

    def on_telemetry(self, now: float, robot: str, telemetry: object) -> None:
        """See `Recorder`; positions come with the steps."""

    def on_plan(self, now: float, plan: Plan) -> None:
        """See `Recorder`; the entry also has the routes as lines from the robots' positions."""
        places = {name: tuple(row[:3]) for name, row in self.rows.items()}
        data = self._plan_changes.of(plan, self._routes.of(plan, self.state, places), self.state)
        if "plan" in data:
            data["stations"] = [station.id for station in self.state.mission.stations]
        self.write(now, "plan", data)

    def on_report(self, report: Mapping[str, Any]) -> None:
        """See `Recorder`."""
        self._keep(self._track.take())
        self.write(self._now, "report", report)

    def hold(self) -> None:
        """Hold entries back until `write_first`."""
        self._held = []

    def write_first(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """Write an entry, then those held back."""
        held, self._held = self._held or [], None
        self.write(now, kind, data)
        for write in held:
            write()

    def write(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """Write the next entry of the log."""
        if self._held is not None:
            self._held.append(partial(self.write, now, kind, data))
            return
        self.seq += 1
        self._now = max(self._now, float(now))
        plain = json.loads(json_bytes(data))
        entry = {"time_s": round(self._now, 9), "kind": kind, "data": plain}
        self._out.entry({"type": "entry", "seq": self.seq, **entry, **words_of(kind, plain)})

    def _keep(self, steps: Steps | None) -> None:
        if steps is None:
            return
        if self._held is not None:
            self._held.append(partial(self._keep, steps))
            return
        self.tracked_s = float(steps.times_s[-1])
        self._out.stretch(float(steps.times_s[0]), self.tracked_s, packed(steps))
