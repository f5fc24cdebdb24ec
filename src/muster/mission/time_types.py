"""The types of values about time: windows, clock times, and what may be one name or several."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from itertools import pairwise
from typing import Any, ClassVar

from muster.mission.value_types import INVALID, Fault, JsonSchema, Number, Path, Text, refuse

Window = tuple[float, float | None]
"""When work may begin: seconds from and to; None: open."""

_CLOCK = re.compile(r"([01]?\d|2[0-3]):([0-5]\d)(?::([0-5]\d))?")


@dataclass(frozen=True)
class Windows:
    """One time window `[from, to]` or several, in seconds; `null` leaves an end open. Read to a tuple of windows."""

    filler: ClassVar[tuple[()]] = ()
    expected: ClassVar[str] = "[from, to] in seconds, or a list of such windows in order and apart"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, str) or not isinstance(value, Sequence):
            return refuse(self, value, at, faults)
        rows = [value] if value and not isinstance(value[0], Sequence) else list(value)
        windows = [_window(row) for row in rows]
        right = [window for window in windows if window is not None]
        if len(right) < len(windows) or not _in_order(right):
            return refuse(self, value, at, faults)
        return tuple(right)

    def schema(self) -> JsonSchema:
        end = {"type": ["number", "null"], "minimum": 0}
        pair = {"type": "array", "items": end, "minItems": 2, "maxItems": 2}
        return {"anyOf": [pair, {"type": "array", "items": pair}]}


def _window(row: object) -> Window | None:
    if isinstance(row, str) or not isinstance(row, Sequence) or len(row) != 2:
        return None
    faults: list[Fault] = []
    first, last = (None if end is None else Number(minimum=0).read(end, (), faults) for end in row)
    if faults or (first is not None and last is not None and last < first):
        return None
    return (first or 0.0, last)


def _in_order(windows: Sequence[Window]) -> bool:
    return all(last is not None and last < first for (_, last), (first, _) in pairwise(windows))


@dataclass(frozen=True)
class Names:
    """An id, or a list of ids, each once; read to a tuple."""

    filler: ClassVar[tuple[()]] = ()
    of: str

    @property
    def expected(self) -> str:
        return f"the id of a {self.of}, or a list of such ids"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, str | int):
            name = Text().read(value, at, faults)
            return INVALID if name is INVALID else (name,)
        if not isinstance(value, Sequence):
            return refuse(self, value, at, faults)
        names = [Text().read(item, (*at, k), faults) for k, item in enumerate(value)]
        if len(set(names)) < len(names):
            return refuse(self, value, at, faults)
        return INVALID if INVALID in names else tuple(names)

    def schema(self) -> JsonSchema:
        return {"anyOf": [Text().schema(), {"type": "array", "items": Text().schema()}]}


@dataclass(frozen=True)
class Moment:
    """A date and time of day, `2027-03-01T08:00:00+01:00`."""

    filler: ClassVar[str] = "1970-01-01T00:00"
    expected: ClassVar[str] = "a date and time such as 2027-03-01T08:00:00+01:00"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        text = value.isoformat() if isinstance(value, datetime) else value
        if not isinstance(text, str) or _moment(text) is None:
            return refuse(self, value, at, faults)
        return text

    def schema(self) -> JsonSchema:
        return {"type": "string", "format": "date-time"}


@dataclass(frozen=True)
class ClockTime:
    """A time of day, `10:00` or `10:00:30`, or a date and time."""

    filler: ClassVar[str] = "00:00"
    expected: ClassVar[str] = 'a clock time such as "10:00", or a date and time'

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        right = isinstance(value, str) and (_CLOCK.fullmatch(value) or _moment(value))
        return value if right else refuse(self, value, at, faults)

    def schema(self) -> JsonSchema:
        return {"type": "string"}


@dataclass(frozen=True)
class ClockWindows:
    """`[from, to]` in clock times, or several such; with `single` just one."""

    filler: ClassVar[tuple[()]] = ()
    single: bool = False

    @property
    def expected(self) -> str:
        pair = 'clock times ["10:00", "14:00"]'
        return pair if self.single else f"{pair}, or a list of such windows"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        return value if isinstance(value, Sequence) else refuse(self, value, at, faults)

    def schema(self) -> JsonSchema:
        pair = {"type": "array", "items": {"type": ["string", "null"]}, "minItems": 2, "maxItems": 2}
        return pair if self.single else {"anyOf": [pair, {"type": "array", "items": pair}]}


def seconds_of(clock: object, starts_at: str) -> float | None:
    """Seconds from the start of the mission to a clock time; None where it is none, or lies before the start.

    A time of day is that of the first day, in the zone of `starts_at`; one before the start is the next day's.
    """
    start = _moment(starts_at)
    if start is None or not isinstance(clock, str):
        return None
    found = _CLOCK.fullmatch(clock)
    if found:
        hour, minute, second = (int(part or 0) for part in found.groups())
        moment = start.replace(hour=hour, minute=minute, second=second, microsecond=0)
        return (moment + timedelta(days=int(moment < start)) - start).total_seconds()
    at = _moment(clock)
    if at is None:
        return None
    if at.tzinfo is None or start.tzinfo is None:
        at = at.replace(tzinfo=start.tzinfo)
    seconds = (at - start).total_seconds()
    return seconds if seconds >= 0 else None


def clock_text(seconds: float, starts_at: str) -> str:
    """The clock time so many seconds after the start, `10:00:30`; of later days `+1 10:00:30`."""
    start = _moment(starts_at)
    assert start is not None
    moment = start + timedelta(seconds=round(seconds))
    days = (moment.date() - start.date()).days
    return (f"+{days} " if days else "") + moment.strftime("%H:%M:%S")


def _moment(text: str) -> datetime | None:
    try:
        return datetime.fromisoformat(text)
    except ValueError:
        return None
