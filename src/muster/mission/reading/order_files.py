"""Files of orders for a fleet on duty: events in order of time, a line each, read as time goes on.

JSON lines hold an event of a mission file each: `{"at_s": 12.5, "new_task": {"id": "o1", "position": [3, 4]}}`. CSV
holds new tasks, with the columns `at_s,id,x,y` and those of `OPTIONAL`.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

from muster.mission.errors import Finding, MissionError
from muster.mission.events import Event
from muster.mission.reading.csv_files import number
from muster.mission.records import Record, path_text
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import Fault, shown

NEEDED = ("at_s", "id", "x", "y")
OPTIONAL = ("z", "type", "actuation_cost", "duration_s", "deadline_s", "due_s", "priority", "prerequisites", "requires")
_LISTS = ("prerequisites", "requires")
_TEXTS = ("id", "type")
OF_TASKS = ("new_task", "cancel_task", "move_task", "delay_task")
"""What a line may tell: what happens to robots is no order."""
_EVENT = Record(Event, "an event")


@dataclass(frozen=True)
class OrderFile:
    """The events of a file, each time it is iterated over; it is checked as a whole when this is made.

    Raises
    ------
    MissionError
        with file, line, field, value and what was expected, for the first line that is wrong.
    """

    path: Path

    def __post_init__(self) -> None:
        for _ in self:
            pass

    def __iter__(self) -> Iterator[Event]:
        last_s = 0.0
        for line, data in self._lines():
            event = self._event(line, data)
            if event.at_s < last_s:
                raise self._error(line, "at_s", f"{event.at_s:g}", f"at least {last_s:g}: lines are in order of time")
            last_s = event.at_s
            yield event

    def _lines(self) -> Iterator[tuple[int, object]]:
        """The data of each line, with its number."""
        read = self._csv if self.path.suffix.lower() == ".csv" else self._json_lines
        try:
            with self.path.open(encoding="utf-8-sig", newline="") as file:
                yield from read(file)
        except UnicodeDecodeError as error:
            raise self._error(None, "", f"byte {error.start} of a part is not UTF-8", "a text in UTF-8") from None
        except OSError as error:
            raise self._error(None, "", error.strerror or str(error), "a file to read") from None

    def _json_lines(self, file: TextIO) -> Iterator[tuple[int, object]]:
        for line, text in enumerate(file, 1):
            if text.strip():
                try:
                    yield line, json.loads(text)
                except (ValueError, RecursionError):
                    raise self._error(line, "", shown(text.strip()), "an event as JSON") from None

    def _csv(self, file: TextIO) -> Iterator[tuple[int, object]]:
        reader = csv.reader(file, strict=True)
        try:
            head = [name.strip() for name in next(reader, [])]
            self._check_head(head)
            for cells in reader:
                if len(cells) not in (0, len(head)):
                    raise self._error(reader.line_num, "", f"{len(cells)} cells", f"{len(head)}, one for each column")
                if cells:
                    yield reader.line_num, _new_task(dict(zip(head, map(str.strip, cells), strict=True)))
        except csv.Error as error:
            raise self._error(reader.line_num, "", str(error), "CSV") from None

    def _check_head(self, head: Sequence[str]) -> None:
        known = (*NEEDED, *OPTIONAL)
        expected = f"the columns {','.join(NEEDED)}, and if wanted {','.join(OPTIONAL)}"
        for name in NEEDED:
            if name not in head:
                raise self._error(1, name, "missing column", expected)
        for name in head:
            if name not in known or head.count(name) > 1:
                wrong = "unknown column" if name not in known else "repeated column"
                raise self._error(1, name, wrong, expected + did_you_mean(name, known))

    def _event(self, line: int, data: object) -> Event:
        faults: list[Fault] = []
        event: Event = _EVENT.read(data, (), faults)
        if faults:
            raise self._error(line, path_text(faults[0].path), faults[0].value, faults[0].expected)
        if all(getattr(event, kind) is None for kind in OF_TASKS):
            told = ", ".join(key for key in data if key != "at_s") if isinstance(data, Mapping) else ""
            raise self._error(line, told, "no order", f"one of {', '.join(OF_TASKS)}")
        return event

    def _error(self, line: int | None, field: str, value: str, expected: str) -> MissionError:
        return MissionError([Finding(str(self.path), line, field, value, expected)])


def _new_task(cells: Mapping[str, str]) -> dict[str, Any]:
    """The event of a row; an empty cell is no value."""
    told = {name: _value(name, text) for name, text in cells.items() if text and name not in ("at_s", "x", "y", "z")}
    position = [number(cells[axis]) for axis in ("x", "y", "z") if cells.get(axis)]
    return {"at_s": number(cells["at_s"]), "new_task": {**told, "position": position}}


def _value(name: str, text: str) -> object:
    if name in _LISTS:
        return text.split()
    return text if name in _TEXTS else number(text)
