"""Converts clock times in a mission file to seconds from its start, before the mission is read.

A task may have `window`, `deadline` and `due` in place of `window_s`, `deadline_s` and `due_s`, a robot `shift` in
place of `available_from_s` and `available_until_s`, or of `shifts_s`. A clock time ("10:00") is in the zone of
`starts_at`; one that is earlier is the next day's, and the second time of a pair is the first such after the first;
"24:00" is the end of a day. A full date and time by ISO 8601 may stand in its place; a window or shift that began
before the start begins at the start.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, time, timedelta
from typing import Any, ClassVar

from muster.mission.value_types import INVALID, Fault, JsonSchema, Path, refuse, shown
from muster.mission.values.raw_records import robots_in, tasks_in
from muster.mission.values.time_types import Windows, is_pair, moment_in, pair_or_pairs

_CLOCK = re.compile(r"([01]?\d|2[0-3]):[0-5]\d(:[0-5]\d(\.\d+)?)?|24:00(:00)?")
_TEXT: JsonSchema = {"type": "string", "pattern": f"^({_CLOCK.pattern})$|^\\d{{4}}"}
_A_TIME = 'a clock time, as "10:00", or a date and a time, as 2027-03-01T10:00'


@dataclass(frozen=True)
class ClockTime:
    """One clock time, or a full date and time."""

    filler: ClassVar[None] = None
    expected: ClassVar[str] = _A_TIME

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        return value if _is_time(value) else refuse(self, value, at, faults)

    def schema(self) -> JsonSchema:
        return _TEXT


@dataclass(frozen=True)
class ClockPairs:
    """`["10:00", "14:00"]`, or a list of such pairs; null where an end is open."""

    filler: ClassVar[None] = None
    expected: ClassVar[str] = f'["10:00", "14:00"], or a list of such pairs, each {_A_TIME}; null where an end is open'

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        pairs = self.pairs(value)
        return refuse(self, value, at, faults) if pairs is None else pairs

    def pairs(self, value: object) -> list[Sequence[Any]] | None:
        """The pairs in a value; None where it is none and no list of pairs."""
        if isinstance(value, str) or not isinstance(value, Sequence):
            return None
        pairs = [value] if is_pair(value) else list(value)
        return pairs if pairs and all(map(_is_pair_of_times, pairs)) else None

    def schema(self) -> JsonSchema:
        return pair_or_pairs(_TEXT)


def _is_time(value: object) -> bool:
    return isinstance(value, str) and (_CLOCK.fullmatch(value) is not None or moment_in(value) is not None)


def _is_pair_of_times(pair: object) -> bool:
    if isinstance(pair, str) or not isinstance(pair, Sequence) or len(pair) != 2:
        return False
    return all(end is None or _is_time(end) for end in pair)


WINDOW = ("window", ClockPairs(), "in place of window_s: clock times, beside starts_at")
DEADLINE = ("deadline", ClockTime(), "in place of deadline_s: a clock time, beside starts_at")
DUE = ("due", ClockTime(), "in place of due_s: a clock time, beside starts_at")
SHIFT = (
    "shift",
    ClockPairs(),
    "in place of available_from_s and available_until_s, or of shifts_s: clock times, beside starts_at",
)

_KEYS_OF_TASKS = frozenset(key for key, _, _ in (WINDOW, DEADLINE, DUE))


def clock_times_to_seconds(data: object, faults: list[Fault]) -> None:
    """Replace, within `data`, clock times by seconds; by INVALID, and a fault, those that are wrong."""
    clock = _Clock(data, faults)
    for at, task in tasks_in(data):
        if _KEYS_OF_TASKS.isdisjoint(task):
            continue
        for (key, kind, _), seconds in ((WINDOW, "window_s"), (DEADLINE, "deadline_s"), (DUE, "due_s")):
            if _stands_alone(task, key, (seconds,), at, faults):
                task[seconds] = clock.seconds(kind, task.pop(key), (*at, key))
    for at, robot in robots_in(data):
        keys = ("available_from_s", "available_until_s")
        if _stands_alone(robot, "shift", (*keys, "shifts_s"), at, faults):
            shifts = clock.seconds(SHIFT[1], robot.pop("shift"), (*at, "shift"))
            if shifts is not INVALID and len(shifts) > 1:
                robot["shifts_s"] = shifts
            else:
                robot.update(zip(keys, (INVALID, INVALID) if shifts is INVALID else shifts[0], strict=True))


def _stands_alone(record: dict[str, Any], key: str, others: Sequence[str], at: Path, faults: list[Fault]) -> bool:
    """Whether a record has a key; with a fault, and without the key, where it has one of the others too."""
    beside = [other for other in others if record.get(other) is not None]
    if key in record and record[key] is None:
        del record[key]
    elif key in record and beside:
        faults.append(Fault((*at, key), shown(record.pop(key)), f"{beside[0]} or {key}, not both"))
    return key in record


class _Clock:
    """The start of a mission, from which clock times are counted."""

    def __init__(self, data: object, faults: list[Fault]) -> None:
        given = data.get("starts_at") if isinstance(data, Mapping) else None
        self._given = given is not None
        self._start: Any = moment_in(given)
        self._faults = faults

    def seconds(self, kind: ClockTime | ClockPairs, value: object, at: Path) -> Any:
        """Seconds from the start; of pairs a list of such pairs."""
        read = kind.read(value, at, self._faults)
        if read is not INVALID and not self._given:
            expected = "starts_at in the mission, beside clock times: starts_at: 2027-03-01T08:00:00+01:00"
            self._faults.append(Fault(at, shown(value), expected))
        if read is INVALID or not isinstance(self._start, datetime):
            return INVALID
        if isinstance(kind, ClockTime):
            return self._later(read, self._start, value, at)
        pairs = [self._pair(pair, value, at) for pair in read]
        return INVALID if INVALID in pairs else self._ordered(pairs, value, at)

    def _pair(self, pair: Sequence[str | None], value: object, at: Path) -> Any:
        begins = self._start if pair[0] is None else self._moment(pair[0], self._start)
        if begins is None:
            return self._refuse_zone(value, at)
        if pair[1] is None:
            return max(0.0, self._since_start(begins)), None
        ends = self._later(pair[1], begins, value, at)
        return INVALID if ends is INVALID else (max(0.0, self._since_start(begins)), ends)

    def _later(self, text: str, after: datetime, value: object, at: Path) -> Any:
        """Seconds from the start to a time, which must not lie before the start."""
        moment = self._moment(text, after)
        if moment is None:
            return self._refuse_zone(value, at)
        if moment < self._start:
            self._faults.append(Fault(at, shown(value), f"a time after starts_at ({self._start.isoformat()})"))
            return INVALID
        return self._since_start(moment)

    def _ordered(self, pairs: list[Any], value: object, at: Path) -> Any:
        """The pairs, where each ends no earlier than it begins and none overlap."""
        wrong: list[Fault] = []
        Windows().read(pairs, (), wrong)
        if wrong:
            expected = "a second time after the first" if wrong[0].path else "windows that do not overlap"
            self._faults.append(Fault(at, shown(value), expected))
        return INVALID if wrong else pairs

    def _moment(self, text: str, after: datetime) -> datetime | None:
        """A full date and time; or the first such time of day that is not before another. None: zones do not fit."""
        if _CLOCK.fullmatch(text) is None:
            moment = moment_in(text)
            if moment is None or (moment.tzinfo is not None and self._start.tzinfo is None):
                return None
            return moment if moment.tzinfo is not None else moment.replace(tzinfo=self._start.tzinfo)
        local = after.astimezone(self._start.tzinfo) if self._start.tzinfo is not None else after
        if text.startswith("24:"):
            return datetime.combine(local.date() + timedelta(days=1), time(), self._start.tzinfo)
        moment = datetime.combine(local.date(), time.fromisoformat(text.rjust(5, "0") if text[1] == ":" else text))
        moment = moment.replace(tzinfo=self._start.tzinfo)
        return moment + timedelta(days=1) if moment < local else moment

    def _refuse_zone(self, value: object, at: Path) -> Any:
        self._faults.append(Fault(at, shown(value), "a time without zone, as starts_at has none"))
        return INVALID

    def _since_start(self, moment: datetime) -> float:
        seconds: float = (moment - self._start).total_seconds()
        return seconds
