"""A plan as a calendar (iCalendar, RFC 5545): an event for each task, with its robots, and for each stop at a station.

Times are in UTC where the mission's start has a zone (form 2 of section 3.3.5), else local ones of nowhere (form 1).
The categories of an event are its robots. Its UID follows from the names of mission, robot and task alone: a later
plan of the same mission replaces the events of an earlier one. Nothing reads the wall clock: DTSTAMP is the mission's
start.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from muster.mission.errors import Finding, MissionError
from muster.mission.goods import shown_amounts
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.stations import station_sign
from muster.planning.export_formats import HEIGHTS, ExportOptions, Files, declares
from muster.verification import Verdict
from muster_files.file_names import file_names
from muster_files.sheets.content import Line, Sheet, Sheets, sheets_of
from muster_files.sheets.instructions import metres

_LINE_BYTES = 75  # RFC 5545, section 3.1, without the line break
_ESCAPED = str.maketrans({"\\": "\\\\", ";": "\\;", ",": "\\,", "\n": "\\n", "\r": None})


@declares(options=(*HEIGHTS, "per_robot"))
def calendar_files(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Files:
    """The calendar of all robots; or one for each robot that has stops, with an event for each of its stops.

    Raises
    ------
    MissionError
        if the mission does not say when it starts, or the plan goes on after the year 9999.
    ParameterError
        if an altitude is for no drone.
    """
    if mission.starts_at is None:
        expected = "starts_at: 2027-03-01T08:00:00+01:00 in the mission, when it begins, for --to ics"
        raise MissionError([Finding(mission.source.file, None, "starts_at", "missing", expected)])
    sheets = sheets_of(mission, verdict, options, plan)
    if not options.per_robot:
        return Files({"plan.ics": _text(sheets, mission.name, _events(sheets))}, sheets.notes)
    names = file_names((sheet.robot.id for sheet in sheets.busy), ".ics")
    idle = tuple(f"{sheet.robot.id}: no stops, no file" for sheet in sheets.robots if not sheet.lines)
    made = {
        name: _text(sheets, f"{mission.name}: {sheet.robot.id}", _stops(sheet))
        for name, sheet in zip(names, sheets.busy, strict=True)
    }
    return Files(made, (*idle, *sheets.notes))


@dataclass(frozen=True)
class _Event:
    """A stop, its robots in mission order with what each has of it, and what tells it from all others."""

    lines: Sequence[tuple[Sheet, Line]]
    key: tuple[str, ...]


def _stops(sheet: Sheet) -> Iterator[_Event]:
    """The stops of one robot; a station's visits are told apart by their number."""
    visits: dict[str, int] = {}
    for line in sheet.lines:
        name = line.visit.name
        visits[name] = visits.get(name, 0) + 1
        kind = ("station", name, str(visits[name])) if line.visit.is_station else ("task", name)
        yield _Event([(sheet, line)], (*kind, sheet.robot.id))


def _events(sheets: Sheets) -> Iterator[_Event]:
    """Tasks, each once with all its robots, and stops at stations, by the order of robots and stops."""
    teams: dict[str, list[tuple[Sheet, Line]]] = {}
    for sheet in sheets.robots:
        for line in sheet.lines:
            if not line.visit.is_station:
                teams.setdefault(line.visit.name, []).append((sheet, line))
    for sheet in sheets.robots:
        for event in _stops(sheet):
            ((_, line),) = event.lines
            if line.visit.is_station:
                yield event
            elif (team := teams[line.visit.name])[0][0] is sheet:
                yield _Event(team, ("task", line.visit.name))


def _text(sheets: Sheets, title: str, events: Iterable[_Event]) -> str:
    """A calendar; lines end in CR LF."""
    lines = ["BEGIN:VCALENDAR", "VERSION:2.0", "PRODID:-//Muster//Muster//EN", "CALSCALE:GREGORIAN"]
    lines.append(f"X-WR-CALNAME:{escaped(title)}")
    for event in events:
        lines += _event(sheets, event)
    lines.append("END:VCALENDAR")
    return "".join(f"{part}\r\n" for line in lines for part in folded(line))


def _event(sheets: Sheets, event: _Event) -> Iterator[str]:
    _, line = event.lines[0]
    starts_s = max(line.visit.starts_s for _, line in event.lines)
    ends_s = max(line.visit.ends_s for _, line in event.lines)
    robots = [sheet.robot.id for sheet, _ in event.lines]
    begin, end = _moment(sheets, starts_s), _moment(sheets, ends_s)
    yield "BEGIN:VEVENT"
    yield f"UID:{uid((sheets.mission.name, *event.key))}"
    yield f"DTSTAMP:{_utc(sheets, 0.0)}"
    yield f"DTSTART:{begin}"
    if end != begin:  # section 3.6.1: an event without an end that begins at a time of day takes no time
        yield f"DTEND:{end}"
    name, named = station_sign(line.visit.name) if line.visit.is_station else line.visit.name, ", ".join(robots)
    yield f"SUMMARY:{escaped(f'{name} ({named})')}"
    yield f"CATEGORIES:{','.join(map(escaped, robots))}"
    yield f"LOCATION:{escaped(f'{metres(line.place)} m')}"
    if line.spot is not None:
        yield f"GEO:{line.spot.lat:.7f};{line.spot.lon:.7f}"
    words = "\n".join(_words(sheets, event))
    yield f"DESCRIPTION:{escaped(words)}"
    yield "END:VEVENT"


def _words(sheets: Sheets, event: _Event) -> Iterator[str]:
    """What is to be done, and by whom when."""
    told, (_, first) = sheets.times.text, event.lines[0]
    yield first.doing
    for sheet, line in event.lines:
        waits = f", waits for {', '.join(line.waits_for)}" if line.waits_for else ""
        yield f"{sheet.robot.id}: number {line.order}, arrives {told(line.visit.arrives_s)}{waits}"
        if sheets.mission.has_goods:
            yield f"on board after: {shown_amounts(line.visit.load_after)}"
    yield from first.limits


def _moment(sheets: Sheets, seconds: float) -> str:
    """A date and time, in UTC where the start has a zone."""
    moment = _known(sheets, seconds)
    return f"{_stamp(moment)}" if moment.tzinfo is None else f"{_stamp(moment.astimezone(UTC))}Z"


def _utc(sheets: Sheets, seconds: float) -> str:
    """A date and time in UTC; that of a start without a zone is taken for one."""
    moment = _known(sheets, seconds)
    return f"{_stamp(moment if moment.tzinfo is None else moment.astimezone(UTC))}Z"


def _known(sheets: Sheets, seconds: float) -> datetime:
    moment = sheets.times.moment(float(round(seconds)))
    if moment is None:
        found = f"{sheets.mission.starts_at} and {seconds:.0f} s"
        expected = "a plan that ends before the year 10000, for --to ics"
        raise MissionError([Finding(sheets.mission.source.file, None, "starts_at", found, expected)])
    return moment


def _stamp(moment: datetime) -> str:
    """By section 3.3.5: `20270301T070000`; the year has four digits."""
    return f"{moment.year:04}{moment:%m%dT%H%M%S}"


def uid(parts: Iterable[str]) -> str:
    """An id of an event that follows from names alone."""
    told = "\x1f".join(parts).encode("utf-8")
    return f"{hashlib.sha256(told).hexdigest()[:32]}@muster"


def escaped(text: str) -> str:
    """A text as the value of a property (section 3.3.11), without control characters."""
    return "".join(c for c in text if c in "\n\r\t" or (c >= " " and c != "\x7f")).translate(_ESCAPED)


def folded(line: str) -> Iterator[str]:
    """A line as lines of at most 75 octets in UTF-8, those after the first with a space before (section 3.1)."""
    part, room = "", _LINE_BYTES
    for c in line:
        size = len(c.encode("utf-8"))
        if size > room:
            yield part
            part, room = " ", _LINE_BYTES - 1
        part += c
        room -= size
    yield part
