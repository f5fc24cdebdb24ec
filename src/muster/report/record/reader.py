"""Reads a record, also one that breaks off because its writer was killed."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from muster.execution.record import ExecutionEvent
from muster.mission.errors import Finding, InputError
from muster.mission.from_data import mission_from
from muster.mission.model import Mission
from muster.mission.yaml_reader import parse_data
from muster.report.record.json_messages import grid_from
from muster.report.record.mission_state import MissionState
from muster.report.record.plan_changes import ReadPlan
from muster.report.record.recording import PlanVersion, Recording, Tracks
from muster.report.record.schemas import MISSION_FILE
from muster.report.record.writer import require_mcap

_STATE = ("x", "y", "z", "heading_rad", "vx", "vy", "vz")
_EXPECTED = "a record that muster has written (MCAP)"
_MAGIC = b"\x89MCAP0\r\n"

Messages = dict[str, list[dict[str, Any]]]


def read_record(path: str | Path) -> Recording:
    """Read a record; of one that breaks off, all up to its last whole chunk.

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
            text, messages, complete = _contents(stream)
    except OSError as error:
        raise _refusal(file, error.strerror or str(error)) from None
    if text is None:
        raise _refusal(file, "holds no mission")
    try:
        return _recording(file, text, messages, complete)
    except (KeyError, TypeError, ValueError) as error:
        raise _refusal(file, f"a message is wrong: {type(error).__name__} {error}") from None


def _refusal(file: Path, value: str) -> InputError:
    return InputError([Finding(str(file), None, "", value, _EXPECTED)])


def _contents(stream: Any) -> tuple[str | None, Messages, bool]:
    """The mission's text, the messages of each topic, and whether the file ends as it should."""
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
        elif isinstance(record, Message) and topics.get(record.channel_id, "") in _READ:
            found[topics[record.channel_id]].append(json.loads(record.data))
    return text, found, bool(ended)


_READ = ("/map", "/muster/state", "/muster/event", "/muster/plan", "/muster/bid", "/muster/report")


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


def _recording(file: Path, text: str, messages: Messages, complete: bool) -> Recording:
    mission = _mission(file, text)
    events = tuple(ExecutionEvent(m["time_s"], m["kind"], m["data"]) for m in messages.get("/muster/event", []))
    mission_state = MissionState.after(mission, ((event.kind, event.data) for event in events))
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
        tracks=_tracks(tuple(mission_state.robots), messages.get("/muster/state", [])),
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


def _tracks(robots: tuple[str, ...], states: Sequence[Mapping[str, Any]]) -> Tracks:
    column = {robot: k for k, robot in enumerate(robots)}
    rows = np.full((len(states), len(robots), len(_STATE)), np.nan)
    for row, state in zip(rows, states, strict=True):
        for robot, values in state["robots"].items():
            row[column[robot]] = [values[key] for key in _STATE]
    times = np.array([state["time_s"] for state in states], dtype=np.float64)
    return Tracks(robots, times, rows[:, :, :3], rows[:, :, 3], rows[:, :, 4:])
