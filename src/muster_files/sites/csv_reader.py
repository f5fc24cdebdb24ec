"""CSV of spreadsheets as a layer: with commas, semicolons, tabs or bars; in UTF-8 or UTF-16, marked or not."""

from __future__ import annotations

import codecs
import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice, pairwise
from pathlib import Path

from muster_files.formula_cells import text_in
from muster_files.sites.features import Feature, Layer, refused
from muster_files.sites.file_sizes import MOST_CELLS, read_bytes, require_few
from muster_files.sites.tables import MOST_TITLES, Row, table_layer

_SEPARATORS = ";\t,|"
_OF_STOPS = frozenset(("robot", "order", "task", "arrives_s", "starts_s", "ends_s"))
"""Headings of the table of stops that Muster exports."""
_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))


def read_csv_layers(path: Path) -> Sequence[Layer]:
    """The table of a file as one layer.

    Raises
    ------
    MissionError
        with the line at which it is no such table.
    """
    file = str(path)
    text = decoded(read_bytes(path), file)
    stated = _stated_separator(text)
    layer = table_layer(file, "", _rows(text, file, stated), separator=stated)
    if not layer.headings:
        raise refused(file, 1, "", "empty", "a row of headings, then a row for each task or robot")
    return [_without_stops(layer)]


def _without_stops(layer: Layer) -> Layer:
    """A table of Muster's own stops with each task once; what it says of stations and loads is of the plan alone."""
    if not {*layer.headings} >= _OF_STOPS:
        return layer
    first: dict[object, Feature] = {}
    for feature in layer.features:
        feature.source.pass_over("is a stop of a plan: its task is read once")
        if "task" in feature.values:
            own = {heading: value for heading, value in feature.values.items() if heading != "load"}
            first.setdefault(feature.values["task"], replace(feature, values=own))
    headings = tuple(heading for heading in layer.headings if heading != "load")
    return replace(layer, headings=headings, features=tuple(first.values()))


def decoded(data: bytes, file: str) -> str:
    """The text in UTF-8 or UTF-16."""
    mark, encoding = next(((mark, name) for mark, name in _MARKS if data.startswith(mark)), (b"", ""))
    encoding = encoding or _unmarked(data[:200])
    try:
        text = data[len(mark) :].decode(encoding)
    except UnicodeDecodeError as error:
        line = 1 + data.count(b"\n", 0, error.start + len(mark))
        expected = "a text in UTF-8 or UTF-16; in a spreadsheet, save as CSV UTF-8"
        told = f"byte {error.start + len(mark)} is not {encoding.upper()}"
        raise refused(file, line, "", told, expected) from None
    if "\0" in text:
        line = 1 + text.count("\n", 0, text.index("\0"))
        raise refused(file, line, "", "a character of code 0", "a text, as CSV is")
    return text


def _unmarked(start: bytes) -> str:
    """UTF-16 without a mark has a zero beside each Latin letter."""
    zeros = [start[k::2].count(0) * 4 > len(start) for k in (0, 1)]
    return "utf-16-be" if zeros[0] and not zeros[1] else "utf-16-le" if zeros[1] and not zeros[0] else "utf-8"


def _stated_separator(text: str) -> str:
    """The separator that the first line states (`sep=;`); empty where it states none."""
    told = next((line.strip().strip('"') for line in io.StringIO(text) if line.strip()), "")
    return told[4:] if told[:4].casefold() == "sep=" and len(told) == 5 else ""


def _rows(text: str, file: str, stated: str) -> Iterator[Row]:
    filled = (line for line in io.StringIO(text) if line.strip())
    separator = stated or _separator(list(islice(filled, MOST_TITLES + 2)))
    require_few(text.count(separator), "cells", file, most=MOST_CELLS)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    begins, skips = 1, bool(stated)
    try:
        for cells in reader:
            if skips and any(map(str.strip, cells)):
                skips = False
            else:
                yield begins, [text_in(cell) for cell in cells]
            begins = reader.line_num + 1
    except csv.Error as error:
        raise refused(file, begins, "", str(error), "CSV: a cell with separators or quotes in quotes") from None


def _separator(lines: Sequence[str]) -> str:
    """The separator that stands as often in one line as in the next, outside of quotes, and there most often.

    Else that of the first line with several. So titles above the headings, and decimal commas below, are passed over.
    """
    outside = ["".join(line.split('"')[::2]) for line in lines]
    for line, following in pairwise(outside):
        alike = [sign for sign in _SEPARATORS if line.count(sign) == following.count(sign) > 0]
        if alike:
            return max(alike, key=line.count)
    most = [max(_SEPARATORS, key=line.count) for line in outside]
    several = [sign for sign, line in zip(most, outside, strict=True) if line.count(sign) > 1]
    first = [sign for sign, line in zip(most[:1], outside, strict=False) if sign in line]
    return next(iter([*several, *first]), ",")
