"""The columns of CSV files with their lines; shared by the readers of task lists, robot lists and tables."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path as FilePath
from typing import NamedTuple

from muster.mission.errors import Finding, MissionError
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.texts.text_files import read_text
from muster.mission.value_types import shown


class Columns(NamedTuple):
    """The cells of a CSV file by column, spaces around them removed; and the line of each row."""

    lines: list[int]
    cells: dict[str, list[str]]


def read_columns(path: FilePath, needed: Sequence[str], optional: Sequence[str] = ()) -> Columns:
    """The columns of a CSV file with a head line.

    Raises
    ------
    MissionError
        if the file cannot be read, a needed column is absent, a column is unknown or a row has too many or few cells.
    """
    lines = _lines(path)
    if not lines:
        raise MissionError([Finding(str(path), 1, "", "empty", f"a head line: {','.join(needed)}")])
    head = [name.strip() for name in lines[0][1]]
    found = _head_findings(path, lines[0][0], head, needed, optional)
    for line, cells in lines[1:]:
        if len(cells) != len(head):
            hint = "; a cell with commas in quotes" if len(cells) > len(head) else ""
            expected = f"{len(head)}, one for each column{hint}"
            found.append(Finding(str(path), line, "", f"{len(cells)} cells", expected))
    if found:
        raise MissionError(found)
    columns = zip(*(cells for _, cells in lines[1:]), strict=True) if lines[1:] else ((),) * len(head)
    by_name = {name: [*map(str.strip, column)] for name, column in zip(head, columns, strict=True)}
    return Columns([line for line, _ in lines[1:]], by_name)


def _head_findings(
    path: FilePath, line: int, head: Sequence[str], needed: Sequence[str], optional: Sequence[str]
) -> list[Finding]:
    if not set(head) & set(needed):
        value = shown(",".join(head))
        raise MissionError([Finding(str(path), line, "", value, f"a head line: {','.join(needed)}")])
    known = [*needed, *optional]
    expected = f"the columns {','.join(needed)}" + (f", and if wanted {','.join(optional)}" if optional else "")
    missing = [name for name in needed if name not in head]
    unknown = [name for name in head if name not in known]
    repeated = [name for name in dict.fromkeys(head) if name in known and head.count(name) > 1]
    return [
        *(Finding(str(path), line, name, "missing column", expected) for name in missing),
        *(Finding(str(path), line, name, "unknown column", expected + did_you_mean(name, known)) for name in unknown),
        *(Finding(str(path), line, name, "repeated column", expected) for name in repeated),
    ]


def read_table(path: FilePath) -> tuple[list[str], list[tuple[int, str, list[str]]]]:
    """A CSV table with names in its first line and column: the columns' names; line, name and cells of each row."""
    lines = _lines(path)
    if not lines:
        raise MissionError([Finding(str(path), 1, "", "empty", "a table with names in its first line and column")])
    columns = [name.strip() for name in lines[0][1][1:]]
    found = [
        Finding(str(path), line, "", f"{len(cells)} cells", f"{len(columns) + 1}: a name and a value for each column")
        for line, cells in lines[1:]
        if len(cells) != len(columns) + 1
    ]
    if found:
        raise MissionError(found)
    return columns, [(line, cells[0].strip(), [c.strip() for c in cells[1:]]) for line, cells in lines[1:]]


def number(text: str) -> object:
    """The number in a cell, or the text itself where there is none (which its kind then refuses)."""
    try:
        return float(text)
    except ValueError:
        return text


def _lines(path: FilePath) -> list[tuple[int, list[str]]]:
    """The lines that hold something, with their numbers."""
    reader = csv.reader(io.StringIO(read_text(path), newline=""), strict=True)
    lines: list[tuple[int, list[str]]] = []
    begins = 1
    try:
        for cells in reader:
            if any(map(str.strip, cells)):
                lines.append((begins, cells))
            begins = reader.line_num + 1
    except csv.Error as error:
        raise MissionError([Finding(str(path), begins, "", str(error), "CSV")]) from None
    return lines
