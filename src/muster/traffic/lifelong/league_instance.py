"""Instances of the League of Robot Runners of 2024: a JSON file that names a map, robots and tasks ([chan2024])."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from muster.mission.errors import Finding, InputError
from muster.mission.texts.text_files import read_text
from muster.mission.values.arrays import Bools
from muster.traffic.movingai import read_map

_MOST_REVEALED = 10_000_000


@dataclass(frozen=True, eq=False)
class LeagueInstance:
    """Robots with headings on a grid, and the tasks that are revealed to them.

    Parameters
    ----------
    name : str
        The name of the file.
    blocked : Bools
        Which cells of the map are blocked, (rows, columns).
    starts : list[int]
        The cell of each robot, row * columns + column; all head east.
    tasks : list[list[int]]
        The cells of each task, in the order in which one robot visits them. After the last task the first comes again.
    revealed : int
        How many unfinished tasks are known at any time.
    """

    name: str
    blocked: Bools
    starts: list[int]
    tasks: list[list[int]]
    revealed: int


def read_league(path: Path) -> LeagueInstance:
    """Return the instance of a JSON file; the files that it names are relative to its folder.

    Raises
    ------
    InputError
        if a file is not what it should be, with the field or the line.
    OSError
        if a file cannot be read.
    """
    fields = _object(path)
    blocked = read_map(_file(path, fields, "mapFile"))
    agents, tasks = (_file(path, fields, name) for name in ("agentFile", "taskFile"))
    team = _team_size(path, fields)
    revealed = _tasks_to_reveal(path, fields, team)
    return LeagueInstance(path.name, blocked, _starts(agents, team, blocked), _tasks(tasks, blocked), revealed)


def _object(path: Path) -> dict[str, Any]:
    try:
        fields = json.loads(read_text(path))
    except json.JSONDecodeError as error:
        raise _wrong(path, error.lineno, "", error.msg, "JSON") from None
    except RecursionError:
        raise _wrong(path, 1, "", "nested too deeply", "JSON") from None
    if not isinstance(fields, dict):
        raise _wrong(path, 1, "", type(fields).__name__, "an object with mapFile, agentFile, taskFile and teamSize")
    if fields.get("delayConfig") is not None:
        raise _wrong(path, None, "delayConfig", "given", "an instance without delays, as of 2024")
    if fields.get("agentSize", 1) != 1:
        raise _wrong(path, None, "agentSize", repr(fields["agentSize"]), "1: a robot has one cell, as of 2024")
    return fields


def _file(path: Path, fields: dict[str, Any], name: str) -> Path:
    value = fields.get(name)
    if not isinstance(value, str) or not value or "\0" in value:
        raise _wrong(path, None, name, _shown(value), "the name of a file, relative to this one")
    file = path.parent / value
    if not file.is_file():
        raise _wrong(path, None, name, value, f"a file; there is no {file}")
    return file


def _team_size(path: Path, fields: dict[str, Any]) -> int:
    value: object = fields.get("teamSize")
    if isinstance(value, int) and not isinstance(value, bool) and value >= 1:
        return value
    raise _wrong(path, None, "teamSize", _shown(value), "a whole number of at least 1")


def _tasks_to_reveal(path: Path, fields: dict[str, Any], team: int) -> int:
    value: object = fields.get("numTasksReveal", 1)
    if isinstance(value, int | float) and not isinstance(value, bool) and 0 < value * team <= _MOST_REVEALED:
        return math.ceil(value * team)
    expected = f"a number above 0 that reveals at most {_MOST_REVEALED:,} tasks to {team} robots"
    raise _wrong(path, None, "numTasksReveal", _shown(value), expected)


def _starts(path: Path, team: int, blocked: Bools) -> list[int]:
    lines = _counted_lines(path, "robots")
    if team > len(lines):
        raise _wrong(path, None, "teamSize", str(team), f"at most {len(lines)}: the file has no more robots")
    starts: dict[int, int] = {}
    for number, text in lines[:team]:
        cell = _free_cell(path, number, "start", text, blocked)
        if cell in starts:
            raise _wrong(path, number, "start", text, f"a cell that no other robot has; line {starts[cell]} has it")
        starts[cell] = number
    return list(starts)


def _tasks(path: Path, blocked: Bools) -> list[list[int]]:
    return [
        [_free_cell(path, number, "task", part, blocked) for part in text.rstrip(",").split(",")]
        for number, text in _counted_lines(path, "tasks")
    ]


def _counted_lines(path: Path, what: str) -> list[tuple[int, str]]:
    """Return the lines after the first, which says how many there are, with their numbers; comments are left out."""
    texts = enumerate(read_text(path).splitlines(), 1)
    lines = [(number, text.strip()) for number, text in texts if text.strip() and not text.lstrip().startswith("#")]
    number, first = lines[0] if lines else (1, "missing")
    if not _is_count(first) or int(first) < 1:
        raise _wrong(path, number, f"number of {what}", first, "a whole number of at least 1")
    count = int(first)
    if len(lines) - 1 < count:
        raise _wrong(path, number, f"number of {what}", first, f"at most {len(lines) - 1}: as many lines follow")
    return lines[1 : 1 + count]


def _free_cell(path: Path, line: int, field: str, text: str, blocked: Bools) -> int:
    text = text.strip()
    cell = int(text) if _is_count(text) else -1
    if not 0 <= cell < blocked.size or blocked.flat[cell]:
        columns = blocked.shape[1]
        expected = f"a free cell, row * {columns} + column, below {blocked.size}"
        raise _wrong(path, line, field, text or "empty", expected)
    return cell


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 16


def _shown(value: object) -> str:
    return "missing" if value is None else json.dumps(value)[:60]


def _wrong(path: Path, line: int | None, field: str, value: str, expected: str) -> InputError:
    return InputError([Finding(str(path), line, field, value[:80], expected)])
