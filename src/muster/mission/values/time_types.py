"""The kinds of value that say when: a moment, and the time windows of a task."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from itertools import pairwise
from typing import Any, ClassVar

from muster.mission.value_types import INVALID, Fault, JsonSchema, Number, Path, refuse, shown

Window = tuple[float, float | None]
"""When work may begin, seconds from the start of the mission: from, until; None: no end."""

_SECONDS = Number(minimum=0)


@dataclass(frozen=True)
class Moment:
    """A date and a time of day, by ISO 8601, with a zone or without."""

    filler: ClassVar[None] = None
    expected: ClassVar[str] = "a date and a time, as 2027-03-01T08:00:00+01:00"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        text = value.isoformat() if isinstance(value, datetime) else value
        return refuse(self, value, at, faults) if moment_in(text) is None else text

    def schema(self) -> JsonSchema:
        return {"type": "string", "minLength": len("2027-03-01T08")}


def moment_in(value: object) -> datetime | None:
    """The date and time in a text of ISO 8601; None where it is no such text."""
    if not isinstance(value, str) or len(value) <= len("2027-03-01"):
        return None
    try:
        return datetime.fromisoformat(value)
    except ValueError:
        return None


@dataclass(frozen=True)
class Windows:
    """`[from, until]`, or a list of such pairs; null where an end is open.

    The order of the pairs does not matter; windows that overlap are refused, as one of them is a mistake.
    """

    filler: ClassVar[tuple[Window, ...]] = ()
    expected: ClassVar[str] = "[from, until] in seconds, or a list of such pairs; null where an end is open"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, str) or not isinstance(value, Sequence):
            return refuse(self, value, at, faults)
        pairs = [((*at, k), pair) for k, pair in enumerate(value)]
        if is_pair(value):
            pairs = [(at, value)]
        windows = [self._window(pair, where, faults) for where, pair in pairs]
        if INVALID in windows:
            return INVALID
        windows.sort(key=lambda window: window[0])
        for (first, closes), (second, _) in pairwise(windows):
            if closes is None or second < closes:
                both = f"[{first:g}, {'null' if closes is None else f'{closes:g}'}] and one from {second:g}"
                faults.append(Fault(at, both, "windows that do not overlap"))
                return INVALID
        return tuple(windows)

    def _window(self, pair: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(pair, str) or not isinstance(pair, Sequence) or len(pair) != 2:
            return refuse(self, pair, at, faults)
        opens = 0.0 if pair[0] is None else _SECONDS.read(pair[0], (*at, 0), faults)
        closes = None if pair[1] is None else _SECONDS.read(pair[1], (*at, 1), faults)
        if opens is INVALID or closes is INVALID:
            return INVALID
        if closes is not None and closes < opens:
            faults.append(Fault((*at, 1), shown(pair[1]), f"null, or a number of at least {opens:g}, when it opens"))
            return INVALID
        return opens, closes

    def file_form(self, value: tuple[Window, ...]) -> Any:
        """One window as a pair, several as a list of pairs."""
        return value[0] if len(value) == 1 else value

    def schema(self) -> JsonSchema:
        return pair_or_pairs({"type": "number", "minimum": 0})


def moment_after(seconds: float, starts_at: str) -> datetime:
    """The date and time so many seconds after the start."""
    return datetime.fromisoformat(starts_at) + timedelta(seconds=seconds)


def clock_text(seconds: float, starts_at: str) -> str:
    """The clock time so many seconds after the start, `10:00:30`; of later days `+1 10:00:30`."""
    start = datetime.fromisoformat(starts_at)
    since_midnight = 3600 * start.hour + 60 * start.minute + start.second + round(seconds)
    days, second = divmod(since_midnight, 86400)  # no date: the year of some has more than four digits
    return (f"+{days} " if days else "") + f"{second // 3600:02}:{second // 60 % 60:02}:{second % 60:02}"


def is_pair(value: Sequence[object]) -> bool:
    """Whether a list is one window, and not a list of windows."""
    return len(value) == 2 and not any(isinstance(item, list | tuple) for item in value)


def pair_or_pairs(end: JsonSchema) -> JsonSchema:
    """JSON Schema of a pair of such values, each of which may be null, or a list of such pairs."""
    pair: JsonSchema = {
        "type": "array",
        "items": {"anyOf": [end, {"type": "null"}]},
        "minItems": 2,
        "maxItems": 2,
    }
    return {"anyOf": [pair, {"type": "array", "items": pair}]}
