"""Travel tables: CSV with place ids in the first line and column; the cell is the distance from row to column.

Installed packages read other files as travel tables (entry points `muster.travel_tables`).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path as FilePath

from muster.mission.errors import Finding, MissionError
from muster.mission.reading.csv_files import number, read_table
from muster.mission.site import TravelTable
from muster.mission.source import Source
from muster.mission.system.plugins import Registry, function_expected
from muster.mission.value_types import Fault, shown

TableReader = Callable[[FilePath, Sequence[str], Collection[str]], TravelTable | None]
"""Reads a file of another program for these robots and other places; returns None for a file of another kind."""
TRAVEL_TABLES: Registry[TableReader] = Registry(
    "reader of travel tables",
    "muster.travel_tables",
    function_expected("a function of a path, robots and other places"),
)


def read_travel_tables(
    files: Mapping[str, str],
    source: Source,
    faults: list[Fault],
    robots: Sequence[str] = (),
    others: Collection[str] = (),
) -> dict[str, TravelTable]:
    """The travel table of each robot type; `files` are found from the folder of the mission's file.

    A cell is metres, or `inf` where there is no way. `robots` and `others`, tasks and stations, are the places of the
    mission, which a file of another program may not tell apart. What is wrong is appended to `faults`.
    """
    tables: dict[str, TravelTable] = {}
    for kind, name in files.items():
        path = FilePath(source.file).parent / name
        try:
            other = (read(path, robots, others) for read in TRAVEL_TABLES.usable().values())
            tables[kind] = next(filter(None, other), None) or read_travel_table(path)
        except MissionError as error:
            faults.extend(
                Fault(("travel", kind), f"{finding.place}: {finding.value}", finding.expected)
                for finding in error.findings
            )
    return tables


def read_travel_table(path: FilePath) -> TravelTable:
    """One travel table.

    Raises
    ------
    MissionError
        if the file cannot be read or is not a square table of numbers.
    """
    columns, rows = read_table(path)
    names = [name for _, name, _ in rows]
    for k, name in enumerate(columns):
        if name in columns[:k]:
            raise _refusal(path, 1, f"column {name} for the second time", "each place once")
        if name not in names:
            raise _refusal(path, 1, f"column {name} and no such row", "the same places in rows and columns")
    for (line, name, _), column in zip_longest(rows, columns):
        if name != column:
            expected = "no more rows than columns" if column is None else f"row {column}, as the columns are ordered"
            raise _refusal(path, line, f"row {name}", expected)
    for line, name, cells in rows:
        for column, cell in zip(columns, cells, strict=True):
            if not isinstance(number(cell), float):
                raise _refusal(path, line, f"{shown(cell)} from {name} to {column}", "metres, or inf")
    return TravelTable(tuple(names), tuple(tuple(float(cell) for cell in cells) for _, _, cells in rows))


def _refusal(path: FilePath, line: int, value: str, expected: str) -> MissionError:
    return MissionError([Finding(str(path), line, "", value, expected)])
