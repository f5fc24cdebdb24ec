"""What calamine does not say of the cells of workbooks: values that are errors or not stored, and merged cells."""

from __future__ import annotations

import html
import re
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from posixpath import join, normpath
from textwrap import shorten
from typing import Any

from muster_files.sites.cells import NoValue
from muster_files.sites.file_sizes import unpacked
from muster_files.sites.tables import Row
from muster_files.sites.xml_elements import parse_xml

_BOOK, _LINKS = "xl/workbook.xml", "xl/_rels/workbook.xml.rels"
_AFTER_CELLS = re.compile(rb"</(?:\w+:)?sheetData")
_CELL = re.compile(rb"[<:]c\s")
_HEAD = re.compile(rb'[^>]*?\br\s*=\s*["\']([A-Za-z]{1,9})(\d{1,9})')
_TYPE = re.compile(rb'[^>]*?\bt\s*=\s*["\'](\w+)')
_FORMULA = re.compile(rb"[<:]f(?:\s[^>]*)?>([^<]*)")
_VALUE = re.compile(rb"[<:]v(?:\s[^>]*)?>([^<]+)<")
_MARKED = re.compile(rb'[<:]f[\s/>]|\bt\s*=\s*["\']e["\']')
_MERGED = re.compile(rb'[<:]mergeCell\s[^>]*?\bref\s*=\s*["\']([A-Z]{1,3})(\d{1,9}):([A-Z]{1,3})(\d{1,9})')
_LONGEST = 60
_STORED = "a value: open the workbook in the spreadsheet program and save it, so that the values of formulas are stored"
_NO_ERROR = "a value in place of this error of the spreadsheet"


@dataclass(frozen=True)
class Marks:
    """The cells of a sheet without values, by row and column from 1; and the rows over which cells are merged."""

    cells: Mapping[tuple[int, int], NoValue] = field(default_factory=dict)
    merged: tuple[tuple[str, int, int], ...] = ()
    """Each by its name (`A2:A5`), its first and its last row."""

    def rows(self, sheet: Any) -> Iterator[Row]:
        """The rows of a sheet of calamine, with what stands in place of missing values."""
        first = sheet.start[1] if sheet.start is not None else 0
        before = max(0, first - min((column - 1 for _, column in self.cells), default=first))
        last = max((row for row, _ in self.cells), default=0)
        by_row: dict[int, dict[int, NoValue]] = {}
        for (row, column), told in self.cells.items():
            by_row.setdefault(row, {})[column - 1 - first + before] = told
        number = 0
        for number, cells in enumerate(sheet.iter_rows(), 1):
            yield number, _laid_over([None] * before + cells, by_row.get(number, {}))
        for row in range(number + 1, last + 1):
            yield row, _laid_over([], by_row.get(row, {}))


def _laid_over(cells: list[object], over: Mapping[int, NoValue]) -> list[object]:
    if over:
        cells = [*cells, *[None] * (max(over) + 1 - len(cells))]
        for column, told in over.items():
            cells[column] = told
    return cells


def marks_in(data: bytes) -> Marks:
    """The marks of a sheet, of its XML."""
    end = _AFTER_CELLS.search(data)
    merged = []
    for a, first, b, last in _MERGED.findall(data, end.end()) if end is not None else ():
        merged.append((f"{a.decode()}{int(first)}:{b.decode()}{int(last)}", int(first), int(last)))
    return Marks(dict(_without_values(data)) if _MARKED.search(data) else {}, tuple(merged))


def _without_values(data: bytes) -> Iterator[tuple[tuple[int, int], NoValue]]:
    begins = [found.start() for found in _CELL.finditer(data)]
    for begin, end in pairwise([*begins, len(data)]):
        cell = data[begin:end]
        place, kind, formula, value = (expression.search(cell) for expression in (_HEAD, _TYPE, _FORMULA, _VALUE))
        if place is None:
            continue
        at = int(place[2]), column_number(place[1])
        if kind is not None and kind[1] == b"e":
            yield at, NoValue(_told(value[1] if value else b"#?"), _NO_ERROR)
        elif formula is not None and value is None and (kind is None or kind[1] != b"str"):
            yield at, NoValue("=" + _told(formula[1]), _STORED)


def _told(data: bytes) -> str:
    return shorten(html.unescape(data.decode("utf-8", "replace")), _LONGEST, placeholder=" ...")


def column_number(letters: bytes) -> int:
    """The number of a column: A is 1, AA 27."""
    found = 0
    for letter in letters.upper():
        found = 26 * found + letter - 64
    return found


def sheet_names(archive: zipfile.ZipFile, path: Path, what: str) -> dict[str, str]:
    """The names of sheets by the members of the archive that hold them; none, where it does not say so."""
    if not {_BOOK, _LINKS} <= set(archive.namelist()):
        return {}
    book, links = (
        parse_xml(unpacked(archive, name, path, what), str(path), root, what)
        for name, root in ((_BOOK, "workbook"), (_LINKS, "Relationships"))
    )
    sheets = {e.attributes.get("id"): e.attributes.get("name", "") for e in book.within() if e.name == "sheet"}
    targets = {link.attributes.get("Id"): link.attributes.get("Target", "") for link in links.within()}
    return {
        normpath(join("/xl", target)).lstrip("/"): sheets[key]
        for key, target in targets.items()
        if key is not None and key in sheets
    }
