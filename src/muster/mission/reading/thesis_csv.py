"""Task-list CSV beside robots CSV, as in [tcf-thesis], section 5.2 and Appendix A1.

Tasks: `index,x,y,type,actuation_cost,prerequisites`, the last as `"[1,18]"` or `1 18`; robots:
`id,type,x,y,work_capacity`, empty or `inf` where unlimited; suitability: a table with robot types in its first column
and task types in its first line. Both lists may have a column `z`, and tasks `duration_s`, `window_s` (`600 1200`,
several as `600 1200; 2000 inf`), `deadline_s`, `due_s` and `robots_needed`, each empty where a task has none.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path as FilePath
from typing import Any, cast

from muster.mission.errors import Finding, MissionError
from muster.mission.model import SCHEMA, Mission
from muster.mission.reading.csv_files import number, read_columns, read_table
from muster.mission.reading.from_data import mission_from
from muster.mission.source import Place, Source
from muster.mission.system.garbage import collector_paused
from muster.mission.value_types import Path, shown

TASK_COLUMNS = ("index", "x", "y", "type", "actuation_cost", "prerequisites")
TIME_COLUMNS = ("duration_s", "window_s", "deadline_s", "due_s", "robots_needed")
ROBOT_COLUMNS = ("id", "type", "x", "y", "work_capacity")
_UNLIMITED = ("", "inf", "infinity", ".inf")


@collector_paused()
def read_csv(tasks: FilePath, robots: FilePath, suitability: FilePath | None = None) -> Mission:
    """Read a mission from a task list, a robot list and, where types matter, a table of suitability.

    Raises
    ------
    MissionError
        with every finding: file, line, field, value, what was expected.
    """
    places: dict[Path, Place] = {("robots",): (str(robots), 1)}
    data, of_tasks = _without_robots(tasks, suitability, places)
    columns = read_columns(robots, ROBOT_COLUMNS, ("z",))
    data["robots"] = _robots(columns.cells)
    lines = _Lines("robots", str(robots), columns.lines, beside=of_tasks)
    return mission_from(data, Source(str(tasks), lines), [])


def read_csv_for(
    robots: Callable[[int], Sequence[Mapping[str, object]]], tasks: FilePath, suitability: FilePath | None = None
) -> Mission:
    """Read a mission from a task list, for robots that are known from elsewhere.

    Parameters
    ----------
    robots
        gives the robots, with their keys of a mission file, by the number of coordinates of a position.

    Raises
    ------
    MissionError
        as `read_csv` does.
    """
    places: dict[Path, Place] = {}
    data, of_tasks = _without_robots(tasks, suitability, places)
    first = next(iter(cast("list[dict[str, Any]]", data["tasks"])), None)
    data["robots"] = list(robots(2 if first is None else len(first["position"])))
    return mission_from(data, Source(str(tasks), of_tasks), [])


def _without_robots(
    tasks: FilePath, suitability: FilePath | None, places: dict[Path, Place]
) -> tuple[dict[str, object], Mapping[Path, Place]]:
    """The data of a mission but for its robots, and these places with those of its tasks."""
    places["suitability",] = (str(suitability), 1)
    columns = read_columns(tasks, TASK_COLUMNS, ("z", *TIME_COLUMNS))
    data: dict[str, object] = {"schema": SCHEMA, "name": tasks.stem}
    data["tasks"] = _tasks(columns.cells)
    if suitability is not None:
        data["suitability"] = suitability_table(suitability, places)
    return data, _Lines("tasks", str(tasks), columns.lines, beside=places)


def is_task_list(tasks: FilePath, robots: FilePath | None) -> bool:
    """Whether the first lines of two files have the columns of these, and no others; without robots, that of one."""
    lists: list[tuple[FilePath, Sequence[str], Sequence[str]]] = [(tasks, TASK_COLUMNS, ("z", *TIME_COLUMNS))]
    lists += [] if robots is None else [(robots, ROBOT_COLUMNS, ("z",))]
    heads = [(_head(path), set(needed), {*needed, *optional}) for path, needed, optional in lists]
    return all(needed <= set(head) <= known and len(set(head)) == len(head) for head, needed, known in heads)


def _head(path: FilePath) -> list[str]:
    """The columns of a file, where it has a first line in UTF-8."""
    try:
        with path.open(encoding="utf-8-sig") as stream:
            return [name.strip() for name in next((line for line in stream if line.strip()), "").split(",")]
    except (OSError, ValueError):
        return []  # whoever reads it says why


class _Lines(Mapping[Path, Place]):
    """The place of each record of a group, made when it is asked for, as few are; beside other places."""

    def __init__(self, group: str, file: str, lines: Sequence[int], *, beside: Mapping[Path, Place]) -> None:
        self._group, self._file, self._lines, self._others = group, file, lines, beside

    def __getitem__(self, path: Path) -> Place:
        match path:
            case (self._group, int(k)) if 0 <= k < len(self._lines):
                return self._file, self._lines[k]
        return self._others[path]

    def __iter__(self) -> Iterator[Path]:
        yield from ((self._group, k) for k in range(len(self._lines)))
        yield from self._others

    def __len__(self) -> int:
        return len(self._lines) + len(self._others)


def _tasks(cells: Mapping[str, list[str]]) -> list[dict[str, object]]:
    values: dict[str, Iterable[object]] = {"id": cells["index"], "position": _positions(cells)}
    values |= {name: _values(cells[name], read) for name, read in _WRITTEN.items() if name in cells}
    return _records(values)


def _robots(cells: Mapping[str, list[str]]) -> list[dict[str, object]]:
    values: dict[str, Iterable[object]] = {"id": cells["id"], "position": _positions(cells)}
    return _records(
        values | {"type": _values(cells["type"], str), "work_capacity": map(_limit, cells["work_capacity"])}
    )


def _records(values: Mapping[str, Iterable[object]]) -> list[dict[str, object]]:
    """A record of each row, with the keys that are given there."""
    rows = zip(*values.values(), strict=True)
    return [{key: value for key, value in zip(values, row, strict=True) if value is not None} for row in rows]


def _values(cells: list[str], read: Callable[[str], object]) -> list[object]:
    """The values in the cells of a column; None for those that are empty."""
    return [read(cell) if cell else None for cell in cells]


def _positions(cells: Mapping[str, list[str]]) -> list[list[object]]:
    axes = [map(number, cells[axis]) for axis in ("x", "y", "z") if axis in cells]
    return [*map(list, zip(*axes, strict=True))]


def _limit(cell: str) -> object:
    return None if cell.lower() in _UNLIMITED else number(cell)


def _windows(cell: str) -> list[list[object]]:
    ends = [re.split(r"[\s,]+", part.strip("[] ")) for part in cell.split(";")]
    return [[_limit(end) for end in pair] for pair in ends]


def _whole(cell: str) -> object:
    return int(cell) if cell.isascii() and cell.isdecimal() else cell


def _prerequisites(cell: str) -> list[str]:
    ids = cell.strip("[] ")
    return re.split(r"[\s,;]+", ids) if ids else []


_WRITTEN: Mapping[str, Callable[[str], object]] = {
    "prerequisites": lambda cell: _prerequisites(cell) or None,  # a record without the key is read faster
    "type": str,
    "actuation_cost": number,
    **dict.fromkeys(TIME_COLUMNS, number),
    "window_s": _windows,
    "robots_needed": _whole,
}
"""How the cells of tasks are read, where they are not empty."""


def suitability_table(path: FilePath, places: dict[Path, Place]) -> dict[str, dict[str, object]]:
    """The scores of robot types for task types in a file; the place of each robot type goes into `places`."""
    columns, rows = read_table(path)
    for k, name in enumerate(columns):
        if name in columns[:k]:
            raise MissionError([Finding(str(path), 1, "suitability", f"{shown(name)} again", "each task type once")])
    table: dict[str, dict[str, object]] = {}
    for line, name, cells in rows:
        if name in table:
            raise MissionError(
                [Finding(str(path), line, "suitability", f"{shown(name)} again", "each robot type once")]
            )
        places["suitability", name] = (str(path), line)
        table[name] = {column: number(cell) for column, cell in zip(columns, cells, strict=True)}
    return table
