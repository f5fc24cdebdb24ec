"""Way points as text (`QGC WPL 110`) as a mission of one robot, as a plan file is.

A line is an item: its number, whether it is current, the frame, the command, four parameters, latitude, longitude,
height, and whether the vehicle goes on by itself. The first item is home where it is a way point in the absolute frame;
else the vehicle starts where it takes off. The file does not say what vehicle it is for: one that takes off, lands or
flies above home is a drone.

Source: MAVLink developer guide, "Plain-Text File Format".
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from muster.mission.import_ledger import Fate, LedgerBook, passed_over, read_as
from muster.mission.reading.csv_files import number
from muster.mission.texts.text_files import LARGEST_FILE, read_text
from muster.planning.mission_readers import Noted
from muster_files.number_rows import Row, text_rows
from muster_files.qgc import plan_format as qgc
from muster_files.qgc.commands import TAKEOFFS, name_of, param_of
from muster_files.qgc.fences import Fences
from muster_files.qgc.fields import Degrees, PlanFields
from muster_files.qgc.flight import Command, Flight, flight_of
from muster_files.qgc.flight_missions import FlownFile, mission_of
from muster_files.sites.file_sizes import require_few

_VERSIONS = ("110", "120")
_COLUMNS = ("number", "current", "frame", "command", *(f"parameter {k}" for k in range(1, 5)))
_COLUMNS += ("latitude", "longitude", "height", "autocontinue")
_ABSOLUTE = (qgc.FRAME_GLOBAL, qgc.FRAME_GLOBAL_INT)
_MOST_LINES = 100_000
_CURRENT = passed_over("says which item is flown next", minor=True)
_READ, _HOME = read_as("itself"), read_as("home")
_HOME_PARAMETER = passed_over("is of home, where nothing is done", minor=True)


def read_wpl(path: Path, origin: Sequence[float] | None = None) -> Noted:
    """Return the mission of a file of way points, with what became of each of its fields.

    Raises
    ------
    MissionError
        with file, line, field, value, what was expected.
    MissingExtraError
        if pymap3d is not installed.
    """
    head, *rows = text_rows(read_text(path, LARGEST_FILE)) or [Row(1, ())]
    fields = PlanFields(path, head.line)
    if " ".join(head.words[:2]) != qgc.WAY_POINTS_HEAD or head.words[2:] not in [[version] for version in _VERSIONS]:
        raise fields.refused_as("", " ".join(head.words) or "empty", f"{qgc.WAY_POINTS_HEAD} {' or '.join(_VERSIONS)}")
    require_few(len(rows), "lines", str(path), most=_MOST_LINES)
    commands = [_command(path, row, k) for k, row in enumerate(rows)]
    if not commands:
        raise fields.refused_as("", "no items", "a line for each item")
    home = _home(commands[0]) or _takeoff(commands)
    document = _Document(rows, commands, has_home=_home(commands[0]) is not None)
    flight = flight_of(commands[1:] if document.has_home else commands, {}, home)
    kind = "air" if _flies(flight, home) else "ground"
    return mission_of(path, [_flown(path, home, kind, flight, document)], origin)


def _flown(path: Path, home: Degrees, kind: str, flight: Flight, document: _Document) -> FlownFile:
    vehicle = "a drone" if kind == "air" else "a robot on the ground"
    notes = [f"{path}: the file does not say what vehicle it is for: it is taken for {vehicle}"]
    speeds = sorted({*flight.speeds})
    if not speeds or flight.late:
        notes.append(f"{path}: no speed is set before the first way point: speed_mps is 1")
        speeds.insert(0, min([1.0, *speeds]))
    if len(speeds) > 1:
        notes.append(f"{path}: the slowest of its speeds is taken, {speeds[0]:g} m/s")
    speed = None if speeds[0] == 1.0 else speeds[0]
    return FlownFile(path.stem, PlanFields(path), home, kind, speed, flight, (), Fences(), tuple(notes), document)


def _command(path: Path, row: Row, k: int) -> Command:
    """The command of a line, which is the `k`-th from 0."""
    fields = PlanFields(path, row.line)
    values = [number(word) for word in row.words]
    wrong = next((word for word, value in zip(row.words, values, strict=True) if not isinstance(value, float)), None)
    if wrong is not None or len(values) != len(_COLUMNS):
        told = f"{len(values)} fields" if wrong is None else wrong
        raise fields.refused_as("", told, f"{len(_COLUMNS)} numbers: {', '.join(_COLUMNS)}")
    index, _, frame, command, *params, on = [float(value) for value in values if isinstance(value, float)]
    for name, value in (("number", index), ("frame", frame), ("command", command)):
        if not math.isfinite(value) or value % 1 or value < 0:
            raise fields.refused(name, value, "a whole number of at least 0")
    if index != k:
        raise fields.refused("number", index, f"{k}: items in their order")
    if on != 1:
        raise fields.refused("autocontinue", on, "1: no wait for a pilot")
    names: dict[int | str, str] = dict(enumerate(_COLUMNS[4:11]))
    names |= {"command": "command", "frame": "frame", "place": "latitude"}
    given = [None if math.isnan(value) else value for value in params]
    return Command(fields, int(index), int(index), int(command), int(frame), given, names)


def _home(first: Command) -> Degrees | None:
    """The place of the first item, where it is home: a way point at an absolute height, at which nothing is done."""
    if first.command != qgc.NAV_WAYPOINT or first.frame not in _ABSOLUTE:
        return None
    if any(first.params[:4]) or not any(first.params[4:6]):  # a way point of the flight, or home that is not set
        return None
    return first.fields.place(first.params[4:], "latitude")


def _takeoff(commands: Sequence[Command]) -> Degrees:
    """The place where the vehicle takes off, at height 0, as the file does not say where home is."""
    for command in commands:
        if command.command in TAKEOFFS and any(command.params[4:6]):
            lat, lon, _ = command.fields.place([*command.params[4:6], 0.0], "latitude")
            return lat, lon, 0.0
    raise commands[0].wrong("command", commands[0].command, "home: a way point in frame 0; or a take-off with a place")


def _flies(flight: Flight, home: Degrees) -> bool:
    return flight.takes_off or flight.lands_at is not None or any(s.place[2] > home[2] for s in flight.stops.values())


class _Document:
    """The words of a file."""

    def __init__(self, rows: Sequence[Row], commands: Sequence[Command], *, has_home: bool) -> None:
        self._items = list(zip(rows, commands, strict=True))
        self.has_home = has_home

    def enter(self, book: LedgerBook) -> None:
        """Give the ledger every word."""
        book.add("QGC WPL", _READ, "line 1", 3)
        for k, (row, command) in enumerate(self._items):
            for column in range(len(row.words)):
                name, fate = self._fate(command, column, is_home=self.has_home and k == 0)
                book.add(name, fate, f"line {row.line}")

    def _fate(self, command: Command, column: int, *, is_home: bool) -> tuple[str, Fate]:
        name, k = name_of(command.command), column - 4
        if is_home:
            return f"home {_COLUMNS[column]}", _HOME if 4 <= k < 7 or column in (2, 3) else _HOME_PARAMETER
        if 0 <= k < 7:
            return name if command.whole else f"{name} {param_of(command.command, k)}", command.fate(k)
        if column == 1:
            return "current", _CURRENT
        return name if command.whole else f"{name} {_COLUMNS[column]}", command.whole or _READ
