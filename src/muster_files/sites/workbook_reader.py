"""Workbooks (XLSX, XLSM) as layers, one a sheet; read by calamine (extra `sites`).

Calamine keeps every cell between the first and the last that are used, and ends the process where there is no memory
for so many. So the last cell is looked for before. It reads as empty what has no value; that is looked for as well.
"""

from __future__ import annotations

import re
import zipfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from muster.mission.system.extras import needs_extra
from muster_files.sites.entries import some_of
from muster_files.sites.features import Layer, refused
from muster_files.sites.file_sizes import MOST_BYTES, MOST_CELLS, MOST_ROWS, open_archive, require_few, unpacked
from muster_files.sites.tables import table_layer
from muster_files.sites.workbook_cells import Marks, column_number, marks_in, sheet_names

_WHAT = "a workbook (XLSX)"
_CELL = re.compile(rb'[<:]c\s[^>]*?\br\s*=\s*["\']([A-Za-z]{1,9})(\d{1,9})')
_ROW = re.compile(rb'[<:]row\s[^>]*?\br\s*=\s*["\'](\d{1,9})')
_SHARED = re.compile(rb"""[<:]c\s[^>]*?\bt\s*=\s*["']s["'][^>]*>\s*<(?:\w+:)?v>\s*(\d{1,9})""")
_TEXTS = re.compile(r"xl/sharedStrings\.xml", re.IGNORECASE)
_TEXT = re.compile(rb"<(?:\w+:)?si[\s>]")
_SHEETS = re.compile(r"xl/worksheets/[^/]+\.xml", re.IGNORECASE)


def read_workbook_layers(path: Path) -> Sequence[Layer]:
    """The sheets of a workbook that hold anything; each in its order, with the numbers of its rows as lines.

    Raises
    ------
    MissionError
        if it is no workbook, or too large.
    MissingExtraError
        without python-calamine.
    """
    with needs_extra("sites", "reading a workbook"):
        import python_calamine
    file = str(path)
    with open_archive(path, _WHAT) as archive:
        marks = _marks(archive, path)
    try:
        workbook = python_calamine.CalamineWorkbook.from_path(file)
        layers = [
            _layer(file, name, workbook.get_sheet_by_name(name), marks.get(name, Marks()))
            for name in workbook.sheet_names
        ]
    except (python_calamine.CalamineError, OSError, ValueError) as error:
        told = " ".join(str(error).split()) or type(error).__name__
        raise refused(file, None, "", f"cannot be read ({told})", _WHAT) from None
    found = [layer for layer in layers if layer.headings]
    if not found:
        raise refused(file, None, "", "empty sheets", "a row of headings, then a row for each task or robot")
    return found


def _layer(file: str, name: str, sheet: Any, marks: Marks) -> Layer:
    layer = table_layer(file, name, marks.rows(sheet), where=f"sheet {name}")
    filled = {feature.line for feature in layer.features}
    merged = [told for told, first, last in marks.merged if not filled.isdisjoint(range(first, last + 1))]
    if not merged:
        return layer
    return replace(layer, notes=(f"merged cells {some_of(merged)}: only the first cell of each has its value",))


def _marks(archive: zipfile.ZipFile, path: Path) -> dict[str, Marks]:
    """The marks of sheets by their names; a workbook with a sheet whose last cell is far out is refused."""
    found: dict[str, Marks] = {}
    lengths = _text_lengths(archive, path)
    shared = 0
    for member in filter(_SHEETS.fullmatch, archive.namelist()):
        data = unpacked(archive, member, path, _WHAT)
        _require_moderate(data, member, path)
        shared += sum(lengths[k] for one in _SHARED.findall(data) if (k := int(one)) < len(lengths))
        require_few(shared, "bytes of texts in cells", str(path), most=MOST_BYTES)
        found[member] = marks_in(data)
    if not any(marks.cells or marks.merged for marks in found.values()):
        return {}
    names = sheet_names(archive, path, _WHAT)
    return {names[member]: marks for member, marks in found.items() if member in names}


def _text_lengths(archive: zipfile.ZipFile, path: Path) -> list[int]:
    """The bytes of each text that cells share: the reader copies it for each cell that has it."""
    member = next((name for name in archive.namelist() if _TEXTS.fullmatch(name)), None)
    return [] if member is None else [len(text) for text in _TEXT.split(unpacked(archive, member, path, _WHAT))[1:]]


def _require_moderate(data: bytes, member: str, path: Path) -> None:
    cells = _CELL.findall(data)
    width = max((column_number(letters) for letters, _ in cells), default=0)
    height = max((int(row) for row in (*(row for _, row in cells), *_ROW.findall(data))), default=0)
    if height > MOST_ROWS or height * width > MOST_CELLS:
        told = f"{height:,} rows of {width:,} cells"
        raise refused(str(path), None, member, told, f"at most {MOST_ROWS:,} rows, and {MOST_CELLS:,} cells")
