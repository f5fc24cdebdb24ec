"""The recorder of a run: writes events as log entries, and positions as tracks.

A run that is simulated again after a crash produces the same events again. They are compared with the log and not
written twice.
"""

from __future__ import annotations

import json
import math
from collections import deque
from collections.abc import Callable, Collection, Iterable, Mapping
from functools import partial
from typing import Any, Protocol

import numpy as np

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.report.record.json_messages import json_bytes
from muster.report.record.routes import RouteLines
from muster.server.runs.log_lines import line_of
from muster.server.runs.tracks import Floats, Row, Steps, Track, packed
from muster.state import MissionState, event_of

RESUMED = "resumed"


class DivergedError(MusterError):
    """The repeated simulation differs from the log."""


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
    log
        the entries that the log has already: `seq`, `time_s`, `kind`, `data`.
    tracked_s
        the time up to which tracks are written already.
    stretch_s
        seconds of mission time per stretch.
    again
        whether the entries of the log are produced again and compared; otherwise new entries follow them.
    """

    def __init__(
        self,
        mission: Mission,
        out: Out,
        *,
        log: Iterable[Mapping[str, Any]] = (),
        tracked_s: float = 0.0,
        stretch_s: float = 5.0,
        again: bool = True,
    ) -> None:
        entries = list(log)
        self._out = out
        self._mission_state = MissionState(mission)
        self._routes = RouteLines(mission)
        self._said = deque(entries if again else ())
        self._seq = 0 if again or not entries else int(entries[-1]["seq"])
        self._track = Track(stretch_s)
        self._tracked_s = tracked_s
        self._held: list[Callable[[], None]] | None = None
        self._now = float(entries[-1]["time_s"]) if entries and not again else 0.0
        self.rows: dict[str, Row] = {}
        self.rows_s = 0.0
        for entry in entries if not again else ():
            if entry["kind"] not in (RESUMED, "plan", "command", "report"):
                self._mission_state.apply(event_of(entry["time_s"], entry["kind"], entry["data"]))

    def keep_robots(self, robots: Collection[str]) -> None:
        """Forget all other robots: those that joined before a crash and cannot be reached join again."""
        known = self._mission_state.robots
        self._mission_state.robots = {name: known[name] for name in robots}

    @property
    def catching_up(self) -> bool:
        """Whether the log still has entries that were not produced again."""
        self._skip_resumed()
        return bool(self._said)

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """See `Recorder`."""
        states = np.column_stack([positions, headings, velocities])
        rows = zip(self._mission_state.robots, states.tolist(), strict=True)
        self.rows = {name: row for name, row in rows if all(map(math.isfinite, row))}
        self.rows_s = float(now)
        self._now = max(self._now, self.rows_s)
        self._keep(self._track.add(self.rows_s, self.rows))

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """See `Recorder`."""
        self._mission_state.apply(event_of(now, kind, data))
        self.write(now, kind, data)

    def on_telemetry(self, now: float, robot: str, telemetry: object) -> None:
        """See `Recorder`; positions come with the steps."""

    def on_plan(self, now: float, plan: Plan) -> None:
        """See `Recorder`; the entry also has the routes as lines from the robots' positions."""
        places = {name: tuple(row[:3]) for name, row in self.rows.items()}
        lines = self._routes.of(plan, self._mission_state, places)
        stations = [station.id for station in self._mission_state.mission.stations]
        self.write(now, "plan", {"plan": plan.as_dict(), "lines": lines, "stations": stations})

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
        """Write the next entry of the log.

        Raises
        ------
        DivergedError
            if the log has another in its place.
        """
        if self._held is not None:
            self._held.append(partial(self.write, now, kind, data))
            return
        if kind != RESUMED:
            self._skip_resumed()
        self._seq += 1
        self._now = max(self._now, float(now))
        plain = json.loads(json_bytes(data))
        entry = {"seq": self._seq, "time_s": round(self._now, 9), "kind": kind, "data": plain}
        if self._said:
            self._compare(entry, self._said.popleft())
        else:
            self._out.entry({"type": "entry", **entry, "line": line_of(kind, plain)})

    def _skip_resumed(self) -> None:
        """Skip entries of earlier resumes, which are not produced again."""
        while self._said and self._said[0]["kind"] == RESUMED:
            self._said.popleft()
            self._seq += 1

    def _compare(self, made: Mapping[str, Any], said: Mapping[str, Any]) -> None:
        for key in ("seq", "kind", "time_s", "data"):
            if made[key] != said[key]:
                was, now = (f"{one['kind']} at {one['time_s']:g} s" for one in (said, made))
                where = f" ({key} differs)" if was == now else f", not {now}"
                raise DivergedError(f"simulated again, entry {said['seq']} of the log should be {was}{where}")

    def _keep(self, steps: Steps | None) -> None:
        if steps is None:
            return
        if self._held is not None:
            self._held.append(partial(self._keep, steps))
            return
        first, last = float(steps.times_s[0]), float(steps.times_s[-1])
        if last > self._tracked_s + 1e-6:
            self._out.stretch(first, last, packed(steps))
