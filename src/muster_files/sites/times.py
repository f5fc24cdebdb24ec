"""Windows, deadlines and shifts of a site in the form of a mission file, and the moment from which they count."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime, time
from typing import Any

from muster.mission.errors import Finding
from muster.mission.values.time_types import moment_in
from muster_files.sites.entries import Entry

KEYS = ("opens", "closes", "window", "deadline", "due", "starts", "ends", "shift")
"""The keys of entries that are read here."""
_DAY = "2000-01-01"
"""The day of clock times without a date."""


def task_times(entry: Entry, findings: list[Finding]) -> dict[str, Any]:
    """The keys of a task that say when."""
    values = entry.values
    found: dict[str, Any] = {}
    windows = values.get("window")
    if "opens" in values or "closes" in values:
        if windows is not None:
            findings.append(entry.finding("window", "a window", f"it, or {entry.columns.heading('opens')}, not both"))
        windows = [[values.get("opens"), values.get("closes")]]
    if isinstance(windows, list):
        found |= _pairs(entry, "window" if "window" in values else "opens", windows, ("window", "window_s"), findings)
    for key in ("deadline", "due"):
        if key in values:
            found["deadline_s" if key == "deadline" else "due_s"] = values[key]
            if isinstance(values[key], str):
                found[key] = found.pop(f"{key}_s")
    return found


def robot_times(entry: Entry, findings: list[Finding]) -> dict[str, Any]:
    """The keys of a robot that say when."""
    values = entry.values
    shifts = values.get("shift")
    if "starts" in values or "ends" in values:
        if shifts is not None:
            findings.append(entry.finding("shift", "a shift", f"it, or {entry.columns.heading('starts')}, not both"))
        shifts = [[values.get("starts"), values.get("ends")]]
    if not isinstance(shifts, list):
        return {}
    key = "shift" if "shift" in values else "starts"
    if len(shifts) > 1:
        findings.append(entry.finding(key, shifts, "one shift a robot"))
    found = _pairs(entry, key, shifts[:1], ("shift", "seconds"), findings)
    if "shift" in found:
        return {"shift": found["shift"][0]}
    starts, ends = found.get("seconds", [[None, None]])[0]
    return {"available_from_s": starts or 0.0} | ({} if ends is None else {"available_until_s": ends})


def _pairs(
    entry: Entry, key: str, pairs: Sequence[Sequence[Any]], names: tuple[str, str], findings: list[Finding]
) -> dict[str, Any]:
    """Pairs of ends under the first name where they are clock times, under the second where they are seconds."""
    ends = [end for pair in pairs for end in pair if end is not None]
    if len({isinstance(end, str) for end in ends}) > 1:
        findings.append(entry.finding(key, list(pairs[0]), "clock times or seconds, not both in one window"))
        return {}
    clocks = any(isinstance(end, str) for end in ends)
    return {names[0 if clocks else 1]: [list(pair) for pair in pairs]}


def require_alike(entries: Iterable[Entry], findings: list[Finding]) -> None:
    """Name the bare numbers of a column in which others are clock times: `0830` is no 830 s there."""
    columns: dict[tuple[str, str], list[Entry]] = {}
    for entry in entries:
        for key in entry.values.keys() & set(KEYS):
            columns.setdefault((entry.role, key), []).append(entry)
    found: dict[Finding, None] = {}
    for (_, key), those in columns.items():
        if not any(isinstance(end, str) for entry in those for end in _moments(entry.values[key])):
            continue
        for entry in those:
            if any(isinstance(end, float | int) for end in _moments(entry.values[key])):
                told = entry.feature.values.get(entry.columns.heading(key), entry.values[key])
                expected = 'a clock time, as "08:30", as others of the column are; clock times or seconds, not both'
                found[entry.finding(key, told, expected)] = None
    findings += found


def _moments(value: object) -> Iterator[object]:
    """A moment, or the ends of pairs."""
    if isinstance(value, list):
        yield from (end for pair in value for end in pair)
    else:
        yield value


def of_next_day(entries: Iterable[Entry], starts_at: object) -> list[str]:
    """What is the next day's, as it begins before the clock time at which the mission does, each with that time.

    Shifts, and those windows that are open when the mission begins.
    """
    start = moment_in(starts_at)
    if start is None:
        return []
    found = []
    for entry in entries:
        for first, second in _ends(entry.values):
            if not isinstance(first, str) or moment_in(first) is not None or _clock(first) >= start.time():
                continue
            later = isinstance(second, str) and moment_in(second) is None and _clock(second) > start.time()
            if entry.role == "robot" or later:
                found.append(f"{entry.told} ({first})")
    return found


def chosen_start(entries: Iterable[Entry]) -> tuple[str | None, bool]:
    """The moment at which a mission begins whose files do not say so, and whether one is needed.

    It is the earliest moment at which a window or a shift begins, unless something must have ended before.
    """
    begins: list[str] = []
    others: list[str] = []
    for entry in entries:
        for first, second in _ends(entry.values):
            begins += [first] if isinstance(first, str) else []
            later = isinstance(second, str) and not (isinstance(first, str) and _is_next_day(first, second))
            others += [str(second)] if later else []
    everything = begins + others
    if not everything:
        return None, False
    dates = [moment_in(told) for told in everything]
    if all(date is not None for date in dates):
        zoned = {date.tzinfo is not None for date in dates if date is not None}
        first = None if len(zoned) > 1 else min(date for date in dates if date is not None)
        return (None, True) if first is None else (first.isoformat(), True)
    if any(date is not None for date in dates) or not begins:
        return None, True
    earliest = min(begins, key=_clock)
    if min(map(_clock, others), default=time.max) < _clock(earliest):
        return None, True
    return datetime.combine(datetime.fromisoformat(_DAY), _clock(earliest)).isoformat(timespec="minutes"), True


def _ends(values: Mapping[str, object]) -> Iterator[tuple[object, object]]:
    """When something begins and ends, in pairs; None for what is not said."""
    for key in ("window", "shift"):
        found = values.get(key)
        if isinstance(found, list):
            yield from ((first, second) for first, second in found)
    yield values.get("opens"), values.get("closes")
    yield values.get("starts"), values.get("ends")
    yield None, values.get("deadline")
    yield None, values.get("due")


def _is_next_day(first: str, second: str) -> bool:
    """Whether the second of two clock times is the next day's."""
    return moment_in(first) is None and moment_in(second) is None and _clock(second) < _clock(first)


def _clock(told: str) -> time:
    return time.max if told.startswith("24:") else time.fromisoformat(told)
