"""Reads mission YAML (`schema: muster/1`); every error names its line.

PyYAML finds the structure; scalars are resolved here by the core schema of YAML 1.2, so that `no`, `1:30` or `0777`
mean what they look like.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path as FilePath
from typing import Any

import yaml

from muster.mission.errors import Finding, MissionError
from muster.mission.model import SCHEMA, Mission
from muster.mission.reading.from_data import mission_from
from muster.mission.reading.json_reader import JsonPlaces, json_data
from muster.mission.reading.mistaken_files import PLAN_AS_MISSION, foreign_form, is_plan
from muster.mission.source import Place, Source
from muster.mission.system.garbage import collector_paused
from muster.mission.texts.text_files import read_text
from muster.mission.value_types import Fault, Path, shown

_FORBIDDEN = re.compile(r"[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_LINE_END = re.compile(r"\r\n|[\r\n\x85\u2028\u2029]")
_NULL = re.compile(r"~|null|Null|NULL|")
_TRUE = re.compile(r"true|True|TRUE")
_FALSE = re.compile(r"false|False|FALSE")
_DECIMAL = re.compile(r"[-+]?[0-9]+")
_OCTAL = re.compile(r"0o[0-7]+")
_HEXADECIMAL = re.compile(r"0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_INFINITE = re.compile(r"([-+]?)\.(inf|Inf|INF)")
_NOT_A_NUMBER = re.compile(r"\.(nan|NaN|NAN)")

_LONGEST_WHOLE_NUMBER = 300  # digits; beyond it a number is infinite in float64 anyway
_DEEPEST = 20  # no mission is nested deeper
_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read_yaml(path: FilePath) -> Mission:
    """Read a mission file.

    Raises
    ------
    MissionError
        with every finding: file, line, field, value, what was expected.
    """
    return parse_yaml(read_text(path), path)


@collector_paused()
def parse_yaml(
    text: str, path: FilePath, robots: Callable[[int], Sequence[Mapping[str, object]]] | None = None
) -> Mission:
    """The mission in a text of YAML; `path` names it in messages, and other files are found from there.

    `robots` gives those of a mission that names none, by the number of coordinates of a position.
    """
    data, source, faults = parse_data(text, path, "a mission: schema, robots, tasks")
    if (foreign := foreign_form(data)) is not None:
        raise MissionError([Finding(str(path), None, "", *foreign)])
    if is_plan(data):
        raise MissionError([Finding(str(path), None, "schema", shown(data.get("schema")), PLAN_AS_MISSION)])
    if robots is not None and not data.get("robots"):
        data["robots"] = list(robots(_dimensions(data.get("tasks"))))
    if "schema" not in data:
        faults.append(Fault(("schema",), "missing", SCHEMA))
    return mission_from(data, source, faults)


def _dimensions(tasks: object) -> int:
    """Coordinates of the position of the first task that has one; 2 where none has."""
    rows = [task.get("position") for task in tasks if isinstance(task, dict)] if isinstance(tasks, list) else []
    return next((len(row) for row in rows if isinstance(row, list) and len(row) in (2, 3)), 2)


def parse_data(text: str, path: FilePath, expected: str) -> tuple[dict[str, object], Source, list[Fault]]:
    """The mapping in a text of YAML, where its values stand, and what is wrong with them already.

    `expected` says what the whole should be.

    Raises
    ------
    MissionError
        if it is no mapping, or no YAML.
    """
    if (plain := json_data(text)) is not None:
        return plain, Source(str(path), JsonPlaces(text, str(path))), []
    reading = _Reading(str(path), expected)
    data = reading.document(text)
    return data, Source(str(path), reading.places), reading.faults


class _Reading:
    """A stream of YAML events to plain Python data, with the place of each value.

    From events and not from PyYAML's nodes, because those are made by recursion without a bound.
    """

    def __init__(self, file: str, expected: str) -> None:
        self._file = file
        self._expected = expected
        self._events: Iterator[Any] = iter(())
        self._anchors: dict[str, object] = {}
        self.places: dict[Path, Place] = {}
        self.faults: list[Fault] = []

    def document(self, text: str) -> dict[str, object]:
        try:
            self._events = yaml.parse(text, Loader=_Loader)
            next(self._events)  # the start of the stream
            if isinstance(next(self._events), yaml.StreamEndEvent):
                raise self._refusal(1, "empty", self._expected)
            data = self._value(next(self._events), ())
            next(self._events)  # the end of the document
            beyond = next(self._events)
        except yaml.MarkedYAMLError as error:
            raise self._syntax_refusal(error, text) from None
        except yaml.YAMLError as error:
            at = _FORBIDDEN.search(text)
            line = text.count("\n", 0, at.start()) + 1 if at else None
            raise self._refusal(line, str(error).splitlines()[0], "YAML") from None
        if not isinstance(beyond, yaml.StreamEndEvent):
            raise self._refusal(_line(beyond), "a second document", "one mission a file")
        if not isinstance(data, dict):
            raise self._refusal(self.places[()][1], shown(data), self._expected)
        return data

    def _value(self, event: Any, at: Path) -> object:
        self.places.setdefault(at, (self._file, _line(event)))
        if isinstance(event, yaml.AliasEvent):
            if event.anchor not in self._anchors:
                raise self._refusal(_line(event), f"*{event.anchor}", "an alias of something that stands before it")
            return self._anchors[event.anchor]
        if len(at) > _DEEPEST:
            raise self._refusal(_line(event), "nested too deep", "a mission")
        if not _plain_tag(event.tag):
            self.faults.append(Fault(at, f"the tag {event.tag}", "a value without a tag"))
        if isinstance(event, yaml.SequenceStartEvent):
            data: object = self._sequence(at)
        elif isinstance(event, yaml.MappingStartEvent):
            data = self._mapping(at)
        else:
            data = _resolved(event.value) if event.implicit[0] else event.value
        if event.anchor is not None:
            self._anchors[event.anchor] = data
        return data

    def _sequence(self, at: Path) -> list[object]:
        items: list[object] = []
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            items.append(self._value(event, (*at, len(items))))
        return items

    def _mapping(self, at: Path) -> dict[str, object]:
        data: dict[str, object] = {}
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            key = self._key(event, data, at)
            value = self._value(next(self._events), (*at, key))
            data.setdefault(key, value)
        return data

    def _key(self, event: Any, data: dict[str, object], at: Path) -> str:
        line = _line(event)
        if not isinstance(event, yaml.ScalarEvent):
            raise self._refusal(line, "a key that is no word", "a plain word before the colon")
        resolved = _resolved(event.value) if event.implicit[0] else event.value
        key: str = str(resolved) if type(resolved) is int else event.value  # as ids and types are read
        if key in data:
            place = self._file, line
            self.places[(*at, key, "")] = place
            self.faults.append(Fault((*at, key, ""), "the key for the second time", "each key once"))
        self.places.setdefault((*at, key), (self._file, line))
        return key

    def _syntax_refusal(self, error: yaml.MarkedYAMLError, text: str) -> MissionError:
        """What PyYAML says; and where the thing began that has no end, which is often lines above."""
        at, begin, problem = error.problem_mark or error.context_mark, error.context_mark, error.problem or "not YAML"
        if at is None:
            return self._refusal(None, problem, "YAML")
        lines = _LINE_END.split(text)
        if at.line < len(lines) and lines[at.line][at.column : at.column + 1] == "\t":
            return self._refusal(at.line + 1, "a tab", "spaces, where YAML allows no tab")
        if begin is not None and begin.line != at.line:
            problem += f", {error.context} from line {begin.line + 1}"
        return self._refusal(at.line + 1, problem, "YAML")

    def _refusal(self, line: int | None, value: str, expected: str) -> MissionError:
        return MissionError([Finding(self._file, line, "", value, expected)])


def _line(event: Any) -> int:
    return int(event.start_mark.line) + 1


def _plain_tag(tag: str | None) -> bool:
    return tag is None or tag == "!"


def _resolved(text: str) -> object:
    """A plain scalar by the core schema of YAML 1.2 (section 10.3.2)."""
    if _NULL.fullmatch(text):
        return None
    if _TRUE.fullmatch(text) or _FALSE.fullmatch(text):
        return bool(_TRUE.fullmatch(text))
    if _DECIMAL.fullmatch(text) and len(text) <= _LONGEST_WHOLE_NUMBER:
        return int(text)
    if _OCTAL.fullmatch(text) or _HEXADECIMAL.fullmatch(text):
        return int(text, 0)
    if _FLOAT.fullmatch(text):
        return float(text)
    infinite = _INFINITE.fullmatch(text)
    if infinite:
        return float(f"{infinite[1]}inf")
    return float("nan") if _NOT_A_NUMBER.fullmatch(text) else text
