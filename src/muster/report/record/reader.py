"""Reads a record, also one that breaks off because its writer was killed."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from muster.mission.errors import Finding, InputError
from muster.mission.model import Mission
from muster.mission.reading.from_data import mission_from
from muster.mission.reading.yaml_reader import parse_data
from muster.mission.values.arrays import Floats
from muster.report.record.json_messages import grid_from
from muster.report.record.plan_changes import ReadPlan
from muster.report.record.recording import PlanVersion, Recording, Tracks
from muster.report.record.schemas import MISSION_FILE
from muster.report.record.writer import require_mcap
from muster.state import MissionState, event_of

_STATE = ("x", "y", "z", "heading_rad", "vx", "vy", "vz")
_EXPECTED = "a record that muster has written (MCAP)"
_MAGIC = b"\x89MCAP0\r\n"

Messages = dict[str, list[dict[str, Any]]]


def read_record(path: str | Path, most: int | None = None) -> Recording:
    """Read a record; of one that breaks off, all up to its last whole chunk.

    Parameters
    ----------
    path : str or Path
        The file.
    most : int or None
        Moments times robots, above which moments are left out evenly of the tracks as they are read; None: none is.
        At least half as many are kept.

    Raises
    ------
    InputError
        if the file cannot be read, is no record, or breaks off before the mission was written.
    MissingExtraError
        if the extra `record` is not installed.
    """
    require_mcap()
    file = Path(path)
    try:
        with file.open("rb") as stream:
            if stream.read(len(_MAGIC)) != _MAGIC:
                raise _refusal(file, "no MCAP file")
            stream.seek(0)
            tracks = _TrackRows(most)
            text, messages, complete = _contents(stream, tracks)
    except OSError as error:
        raise _refusal(file, error.strerror or str(error)) from None
    if text is None:
        raise _refusal(file, "holds no mission")
    try:
        return _recording(file, text, messages, tracks, complete)
    except (KeyError, TypeError, ValueError) as error:
        raise _refusal(file, f"a message is wrong: {type(error).__name__} {error}") from None


def _refusal(file: Path, value: str) -> InputError:
    return InputError([Finding(str(file), None, "", value, _EXPECTED)])


def _contents(stream: Any, tracks: _TrackRows) -> tuple[str | None, Messages, bool]:
    """The mission's text, the messages of each topic, and whether the file ends as it should; states go to tracks."""
    from mcap.records import Attachment, Channel, Message

    text: str | None = None
    topics: dict[int, str] = {}
    found: Messages = {}
    ended: list[bool] = []
    for record in whole_records(stream, ended):
        if isinstance(record, Attachment) and record.name == MISSION_FILE:
            text = record.data.decode()
        elif isinstance(record, Channel) and record.message_encoding == "json":
            topics[record.id] = record.topic
            found.setdefault(record.topic, [])
        elif isinstance(record, Message) and topics.get(record.channel_id) == "/muster/state":
            tracks.add(json.loads(record.data))
        elif isinstance(record, Message) and topics.get(record.channel_id, "") in _READ:
            found[topics[record.channel_id]].append(json.loads(record.data))
    return text, found, bool(ended)


_READ = ("/map", "/muster/event", "/muster/plan", "/muster/bid", "/muster/report")


def whole_records(stream: Any, ended: list[bool]) -> Iterator[Any]:
    """The records of an MCAP file, in order, as far as they are whole; `ended` gets an item if none is missing."""
    from mcap.exceptions import McapError
    from mcap.stream_reader import CRCValidationError, StreamReader
    from zstandard import ZstdError

    try:
        yield from StreamReader(stream, validate_crcs=True).records
    except (McapError, CRCValidationError, ZstdError, struct.error, UnicodeDecodeError):
        return
    ended.append(True)


def _recording(file: Path, text: str, messages: Messages, tracks: _TrackRows, complete: bool) -> Recording:
    mission = _mission(file, text)
    events = tuple(event_of(m["time_s"], m["kind"], m["data"]) for m in messages.get("/muster/event", []))
    mission_state = MissionState.after(mission, events)
    read = ReadPlan(str(file))
    plans = [PlanVersion(m["time_s"], read.take(m), read.lines) for m in messages.get("/muster/plan", [])]
    maps, reports = messages.get("/map", []), messages.get("/muster/report", [])
    return Recording(
        file=str(file),
        mission=mission,
        mission_text=text,
        image=grid_from(maps[-1]) if maps else None,
        plans=tuple(plans),
        events=events,
        bids=tuple(messages.get("/muster/bid", [])),
        tracks=tracks.of(tuple(mission_state.robots)),
        report=reports[-1]["report"] if reports else None,
        complete=complete,
    )


def _mission(file: Path, text: str) -> Mission:
    """The mission in a record. A record contains no travel tables, so travel by tables is not in it."""
    data, source, faults = parse_data(text, file, "a mission")
    rules = data.get("rules")
    if data.pop("travel", None) is not None and isinstance(rules, dict):
        rules.pop("travel", None)
    return mission_from(data, source, faults)


class _TrackRows:
    """States as they are read: of each moment its time and an array of the robots that were there."""

    def __init__(self, most: int | None) -> None:
        self._most = most
        self._every, self._seen = 1, 0
        self._rows: list[tuple[float, tuple[str, ...], Floats]] = []
        self._last: Mapping[str, Any] | None = None  # where it was left out

    def add(self, state: Mapping[str, Any]) -> None:
        """Add a moment, unless it is left out."""
        self._seen += 1
        if (self._seen - 1) % self._every:
            self._last = state
            return
        self._keep(state)
        if self._most is not None and len(self._rows) * len(state["robots"]) > self._most:
            self._every *= 2
            del self._rows[1::2]

    def _keep(self, state: Mapping[str, Any]) -> None:
        robots, self._last = tuple(state["robots"]), None
        if self._rows and self._rows[-1][1] == robots:
            robots = self._rows[-1][1]  # one tuple for all
        values = [[values[key] for key in _STATE] for values in state["robots"].values()]
        self._rows.append((state["time_s"], robots, np.array(values, dtype=np.float64).reshape(-1, len(_STATE))))

    def of(self, robots: tuple[str, ...]) -> Tracks:
        """Return the tracks of robots, in this order."""
        if self._last is not None:
            self._keep(self._last)
        column = {robot: k for k, robot in enumerate(robots)}
        rows = np.full((len(self._rows), len(robots), len(_STATE)), np.nan)
        for row, (_, there, values) in zip(rows, self._rows, strict=True):
            row[[column[robot] for robot in there]] = values
        times = np.array([time_s for time_s, _, _ in self._rows], dtype=np.float64)
        return Tracks(robots, times, rows[:, :, :3], rows[:, :, 3], rows[:, :, 4:])
