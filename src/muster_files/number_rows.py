"""Rows of numbers in text files, separated by spaces."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path as FilePath
from typing import NamedTuple

from muster.mission.errors import Finding, MissionError
from muster.mission.reading.csv_files import number
from muster.mission.value_types import shown


class Row(NamedTuple):
    """A line of a file: its number from 1, and its words."""

    line: int
    words: Sequence[str]


def row_numbers(words: Iterable[str]) -> list[float] | None:
    """The words as finite numbers; None where one is none."""
    values = [number(word) for word in words]
    found = [value for value in values if isinstance(value, float) and math.isfinite(value)]
    return found if len(found) == len(values) else None


def read_row(path: FilePath, row: Row, columns: Sequence[str], field: str = "") -> list[float]:
    """The numbers of a row, one for each column; `field` names in messages what the row belongs to.

    Raises
    ------
    MissionError
        if they are more or fewer, or one is no finite number.
    """
    values = row_numbers(row.words)
    if values is None or len(values) != len(columns):
        raise MissionError([Finding(str(path), row.line, field, shown(" ".join(row.words)), ", ".join(columns))])
    return values


REMARKS = ("#", "//", "%", "!", ";")
"""What a remark begins with, at the beginning of a line; within a line it is `#` or `//` alone."""


def text_rows(text: str) -> list[Row]:
    """The lines of a text that hold something but a remark, without remarks at their ends."""
    lines = ((k, without_remark(line).split()) for k, line in enumerate(text.splitlines(), 1))
    return [Row(line, words) for line, words in lines if words]


def without_remark(line: str) -> str:
    """A line without a remark at its end; empty where it is one."""
    if line.lstrip().startswith(REMARKS):
        return ""
    ends = [at for mark in REMARKS[:2] if (at := line.find(f" {mark}")) >= 0]
    return line[: min(ends)] if ends else line


def node_number(word: str) -> str:
    """The number of a node as other lines may name it: without zeros before it; any other word as it is."""
    return str(int(word)) if is_whole(word) else word


def is_whole(word: str) -> bool:
    """Whether a word is a whole number of at least 0, in digits."""
    return word.isascii() and word.isdigit() and len(word) < 16
