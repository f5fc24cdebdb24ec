"""Converts clock times of a file to seconds from the start of the mission, before the mission is read."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from muster.mission.time_types import Moment, seconds_of
from muster.mission.value_types import INVALID, Fault, Path, shown

_Seconds = Callable[[object], Any]
_Convert = Callable[[object, _Seconds], list[Any]]

_EXPECTED = 'clock times such as "10:00", or dates and times, not before starts_at'


def clock_to_seconds(data: Any, faults: list[Fault]) -> Mapping[Path, Path]:
    """Replace, within `data`, clock times by seconds; by INVALID, and a fault, those that are wrong.

    Returns
    -------
    the paths of clock times in the file, by the paths at which the seconds are now.
    """
    places: dict[Path, Path] = {}
    for at, record in _records(data):
        for key, (fields, convert) in _KEYS.items():
            if key not in record:
                continue
            given = [name for name in fields if name in record]
            value = record.pop(key)
            if given:
                faults.append(Fault((*at, key), shown(value), f"{given[0]} or {key}, not both"))
                continue
            seconds = _converted(convert, value, data.get("starts_at"), (*at, key), faults)
            for name, item in zip(fields, seconds, strict=True):
                record[name] = item
                places[(*at, name)] = (*at, key)
    return places


def in_clock_times(fault: Fault, places: Mapping[Path, Path]) -> Fault:
    """A fault of a value that was given as a clock time, at its key in the file."""
    at = next((file_at for at, file_at in places.items() if fault.path[: len(at)] == at), None)
    return fault if at is None else replace(fault, path=at)


def _converted(convert: _Convert, value: object, starts_at: object, at: Path, faults: list[Fault]) -> list[Any]:
    """The values of the fields; INVALID, with a fault, where there are none."""
    if Moment().read(starts_at, (), []) is INVALID:
        faults.append(Fault(at, shown(value), "starts_at in the mission, beside clock times"))
        return [INVALID] * len(convert("", lambda _: None))
    wrong: list[object] = []

    def seconds(clock: object) -> Any:
        found = seconds_of(clock, str(starts_at))
        if found is None:
            wrong.append(clock)
        return found

    values = convert(value, seconds)
    if wrong or any(item is INVALID for item in values):
        faults.append(Fault(at, shown(wrong[0] if wrong else value), _EXPECTED))
        return [INVALID] * len(values)
    return values


def _one(value: object, seconds: _Seconds) -> list[Any]:
    return [seconds(value)]


def _two(value: object, seconds: _Seconds) -> list[Any]:
    pair = _pair(value, seconds)
    return [INVALID, INVALID] if pair is None else pair


def _windows(value: object, seconds: _Seconds) -> list[Any]:
    rows = value if isinstance(value, list) and value and isinstance(value[0], list) else [value]
    pairs = [_pair(row, seconds) for row in rows]
    return [INVALID if None in pairs else pairs]


def _pair(value: object, seconds: _Seconds) -> list[Any] | None:
    if not isinstance(value, list) or len(value) != 2:
        return None
    return [None if end is None else seconds(end) for end in value]


_KEYS: Mapping[str, tuple[tuple[str, ...], _Convert]] = {
    "window": (("window_s",), _windows),
    "deadline": (("deadline_s",), _one),
    "due": (("due_s",), _one),
    "shift": (("available_from_s", "available_until_s"), _two),
}


_GROUPS: Mapping[str, tuple[str, ...]] = {
    "robots": (),
    "tasks": (),
    "events": ("robot_joins", "new_task"),
    "found": ("becomes",),
}


def _records(data: object) -> Iterator[tuple[Path, dict[str, Any]]]:
    """Robots and tasks of a mission, also those of its events, and what becomes of tags."""
    for group, keys in _GROUPS.items():
        items = data.get(group) if isinstance(data, dict) else None
        for k, item in enumerate(items if isinstance(items, list) else []):
            if not isinstance(item, dict):
                continue
            if not keys:
                yield (group, k), item
            for key in keys:
                if isinstance(item.get(key), dict):
                    yield (group, k, key), item[key]
