"""The record of one carried-out mission, written while it is carried out: one MCAP file, append-only.

An observer: whoever carries the mission out calls `on_step`, `on_event`, `on_plan` and `on_report`, and knows nothing
of files. Messages go to the file in chunks (mcap.dev, "MCAP Format Specification"): at each plan and report, when
`chunk_bytes` have come together, and when `flush_s` have gone by on the clock. A process that is killed leaves all
chunks but the one in the making, and `read_record` reads them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

import numpy as np
import numpy.typing as npt

from muster.mission.clock import Clock, SystemClock
from muster.mission.errors import MissingExtraError, ParameterError
from muster.mission.model import Mission, Point
from muster.mission.plan import Plan
from muster.mission.yaml_writer import yaml_text
from muster.report.record import messages, scene
from muster.report.record.routes import RouteLines
from muster.report.record.schemas import MISSION_FILE, SCHEMAS, TOPICS
from muster.report.record.situation import ALARMING, Situation

Floats = npt.NDArray[np.float64]


class RecordWriter:
    """Writes the record of a mission.

    Parameters
    ----------
    path
        the file; one that is there is replaced.
    mission
        goes into the record, its map too; travel tables do not.
    rate_hz
        how many steps of a second of the mission are written at most.
    flush_s, chunk_bytes
        how much a killed process may lose: seconds on the clock, bytes before compression.
    clock
        tells when `flush_s` have gone by.

    Raises
    ------
    MissingExtraError
        if the extra `record` is not installed, or the map needs the extra `map`.
    OSError
        if the file cannot be written.
    """

    def __init__(
        self,
        path: str | Path,
        mission: Mission,
        *,
        rate_hz: float = 10.0,
        flush_s: float = 1.0,
        chunk_bytes: int = 64 * 1024,
        clock: Clock | None = None,
    ) -> None:
        if not rate_hz > 0:
            raise ParameterError(f"rate_hz: {rate_hz}; expected a number above 0")
        require_mcap()
        self._situation = Situation(mission)
        self._routes = RouteLines(mission)
        self._places: dict[str, Point] = {}
        self._period_s, self._next_s = 1.0 / rate_hz, 0.0
        self._clock: Clock = clock or SystemClock()
        self._flush_s, self._flushed = flush_s, self._clock.now()
        self._chunk_bytes, self._waiting_bytes = chunk_bytes, 0
        self._file: IO[bytes] = Path(path).open("wb")  # noqa: SIM115 - closed by `close`
        try:
            self._writer, self._channels = _started(self._file)
            self._write_mission(mission)
        except OSError:
            with suppress(OSError):
                self._file.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, _: BaseException | None, __: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """End the file in order, with its index; may be called again."""
        if not self._file.closed:
            with self._file:
                self._writer.finish()

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """Write where the robots are, unless a step was written less than a period ago.

        Parameters
        ----------
        now
            seconds of the mission's clock.
        positions, headings, velocities
            (n, 3) metres, (n,) radians, (n, 3) m/s in the map frame; a row for each robot: those of the mission, then
            those that joined. A robot that is not there has NaN.
        """
        names = list(self._situation.robots)
        if len(positions) != len(names):
            raise ParameterError(f"positions: {len(positions)} rows; expected one for each of {len(names)} robots")
        if now < self._next_s - 1e-9:
            return
        self._next_s = max(self._next_s + self._period_s, now + self._period_s / 2)
        self._write_step(float(now), names, np.column_stack([positions, headings, velocities]))

    def _write_step(self, now: float, names: Sequence[str], states: Floats) -> None:
        there: list[int] = np.flatnonzero(np.isfinite(states).all(axis=1)).tolist()
        present = [names[k] for k in there]
        rows = states[there].tolist()
        self._places = {name: tuple(row[:3]) for name, row in zip(present, rows, strict=True)}
        texts = messages.place_texts(rows)
        self._add("/tf", now, messages.transforms_text(now, present, texts))
        self._add("/poses", now, messages.poses_text(now, texts))
        self._add("/muster/state", now, messages.state_text(now, present, rows))

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """Write what has happened; what each kind means is told in `situation`."""
        self._add("/muster/event", now, messages.json_bytes({"time_s": now, "kind": kind, "data": data}))
        level = messages.WARNING if kind in ALARMING else messages.INFO
        self._write("/log", now, messages.log(now, level, messages.event_line(kind, data)))
        changed = self._situation.take(kind, data)
        if changed is not None:
            self._write("/scene", now, scene.update([self._entity(now, kind, changed)]))

    def on_telemetry(self, now: float, robot: str, telemetry: object) -> None:
        """What robots say of themselves is not written: where they are is in the steps."""

    def on_plan(self, now: float, plan: Plan) -> None:
        """Write a plan, with the bids that led to it where they are known, and the routes as lines."""
        lines = self._routes.of(plan, self._situation, self._places)
        self._write("/muster/plan", now, {"time_s": now, "plan": plan.as_dict(), "lines": lines})
        for award in plan.book.awards if plan.book is not None else ():
            self._write("/muster/bid", now, {"time_s": now, **award.as_dict()})
        order = list(self._situation.robots)
        routes = [scene.route_entity(now, robot, order.index(robot), line) for robot, line in lines.items()]
        self._write("/scene", now, scene.update(routes))
        self._flush()

    def on_report(self, report: Mapping[str, Any]) -> None:
        """Write the report at the mission's end."""
        now = float(report.get("mission_time_s") or 0.0)
        self._write("/muster/report", now, {"time_s": now, "report": report})
        self._flush()

    def _entity(self, now: float, kind: str, name: str) -> dict[str, Any]:
        if kind == "robot_joins":
            robots = self._situation.robots
            return scene.robot_entity(now, robots[name], list(robots).index(name))
        return scene.task_entity(now, self._situation.tasks[name], self._situation.states[name])

    def _write_mission(self, mission: Mission) -> None:
        self._writer.add_metadata("muster", {"schema": mission.schema, "mission": mission.name})
        self._writer.add_attachment(0, 0, MISSION_FILE, "application/yaml", yaml_text(mission).encode())
        if mission.map is not None and mission.map.boundary is None:
            from muster.motion.world import World

            image = World.of(mission).image
            if image is not None:
                self._write("/map", 0.0, messages.grid_message(image))
        robots = [scene.robot_entity(0.0, robot, k) for k, robot in enumerate(mission.robots)]
        tasks = [scene.task_entity(0.0, task, self._situation.states[task.id]) for task in mission.tasks]
        self._write("/scene", 0.0, scene.update([*scene.map_entities(mission.map), *tasks, *robots]))
        self._flush()

    def _write(self, topic: str, now: float, message: Mapping[str, Any]) -> None:
        self._add(topic, now, messages.json_bytes(message))

    def _add(self, topic: str, now: float, data: bytes) -> None:
        time = messages.nanoseconds(now)
        self._writer.add_message(self._channels[topic], time, data, time)
        self._waiting_bytes += len(data)
        if self._waiting_bytes >= self._chunk_bytes or self._clock.now() - self._flushed >= self._flush_s:
            self._flush()

    def _flush(self) -> None:
        self._writer.flush()
        self._flushed, self._waiting_bytes = self._clock.now(), 0


def require_mcap() -> None:
    """Raise MissingExtraError where mcap is not installed."""
    try:
        import mcap  # noqa: F401
    except ImportError:
        raise MissingExtraError("record", "a record") from None


def _started(file: IO[bytes]) -> tuple[Any, dict[str, int]]:
    """A writer of a file, with its channels by topic; it ends chunks when it is told to flush, not by itself."""
    from mcap.writer import Writer

    writer = Writer(file, chunk_size=2**31, enable_data_crcs=True)
    writer.start(library="muster")
    numbers = {
        name: writer.register_schema(name, "jsonschema", messages.json_bytes(schema))
        for name, schema in SCHEMAS.items()
    }
    channels = {topic: writer.register_channel(topic, "json", numbers[name]) for topic, name in TOPICS.items()}
    return writer, channels
