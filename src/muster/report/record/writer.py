"""Writes the record of a mission while it is carried out: one MCAP file, append-only.

Messages are written in chunks (mcap.dev, "MCAP Format Specification"): at each plan and report, when `chunk_bytes` are
reached, and when `flush_s` have passed on the clock. A process that is killed leaves all chunks but the current one,
and `read_record` reads them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

from muster.mission.errors import MissingExtraError
from muster.mission.model import Mission, Point
from muster.mission.plan import Plan
from muster.mission.system.clock import Clock, SystemClock
from muster.mission.yaml_writer import yaml_text
from muster.report.record import json_messages
from muster.report.record.plan_changes import PlanChanges
from muster.report.record.publisher import Publisher
from muster.report.record.schemas import MISSION_FILE, SCHEMAS, TOPICS


class RecordWriter(Publisher):
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
        super().__init__(mission, rate_hz)
        self._plan_changes = PlanChanges()
        require_mcap()
        self._clock: Clock = clock or SystemClock()
        self._flush_s, self._flushed = flush_s, self._clock.now()
        self._chunk_bytes, self._waiting_bytes = chunk_bytes, 0
        self._path = Path(path)
        self._file: IO[bytes] = self._path.open("wb")
        try:
            with self._named_errors():
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
        """Complete the file with its index; may be called again."""
        if not self._file.closed:
            with self._named_errors(), self._file:
                self._writer.finish()

    def _plan_data(self, plan: Plan, lines: Mapping[str, Sequence[Point]]) -> Mapping[str, Any]:
        return self._plan_changes.of(plan, lines, self._mission_state)

    def _write_mission(self, mission: Mission) -> None:
        self._writer.add_metadata("muster", {"schema": mission.schema, "mission": mission.name})
        self._writer.add_attachment(0, 0, MISSION_FILE, "application/yaml", yaml_text(mission).encode())
        self._tell_mission()

    def _add(self, topic: str, now: float, data: bytes) -> None:
        time = json_messages.nanoseconds(now)
        self._writer.add_message(self._channels[topic], time, data, time)
        self._waiting_bytes += len(data)
        if self._waiting_bytes >= self._chunk_bytes or self._clock.now() - self._flushed >= self._flush_s:
            self._flush()

    def _flush(self) -> None:
        with self._named_errors():
            self._writer.flush()
        self._flushed, self._waiting_bytes = self._clock.now(), 0

    @contextmanager
    def _named_errors(self) -> Iterator[None]:
        """Add the file's name to errors of writing."""
        try:
            yield
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(self._path)) from None


def require_mcap() -> None:
    """Raise MissingExtraError where mcap is not installed."""
    try:
        import mcap  # noqa: F401
    except ImportError:
        raise MissingExtraError("record", "a record") from None


def _started(file: IO[bytes]) -> tuple[Any, dict[str, int]]:
    """A writer of a file with its channels by topic; it ends chunks only when told to flush."""
    from mcap.writer import Writer

    writer = Writer(file, chunk_size=2**31, enable_data_crcs=True)
    writer.start(library="muster")
    numbers = {
        name: writer.register_schema(name, "jsonschema", json_messages.json_bytes(schema))
        for name, schema in SCHEMAS.items()
    }
    channels = {topic: writer.register_channel(topic, "json", numbers[name]) for topic, name in TOPICS.items()}
    return writer, channels
