"""Workbooks (XLSX, XLSM) as layers, one a sheet; read by calamine (extra `sites`).

Calamine keeps every cell between the first and the last that are used, and ends the process where there is no memory
for so many. So the last cell is looked for before.
"""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from muster.exchange.sites.features import Layer, refused
from muster.exchange.sites.file_sizes import open_archive, unpacked
from muster.exchange.sites.tables import MOST_ROWS, Row, table_layer
from muster.mission.errors import MissingExtraError

_WHAT = "a workbook (XLSX)"
_MOST_CELLS = 20_000_000
_CELL = re.compile(rb'[<:]c\s[^>]*?\br\s*=\s*["\']([A-Za-z]{1,9})(\d{1,9})')
_ROW = re.compile(rb'[<:]row\s[^>]*?\br\s*=\s*["\'](\d{1,9})')
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
    try:
        import python_calamine
    except ImportError:
        raise MissingExtraError("sites", "reading a workbook") from None
    file = str(path)
    with open_archive(path, _WHAT) as archive:
        _require_moderate(archive, path)
    try:
        workbook = python_calamine.CalamineWorkbook.from_path(file)
        layers = [_layer(file, name, workbook.get_sheet_by_name(name)) for name in workbook.sheet_names]
    except (python_calamine.CalamineError, OSError, ValueError) as error:
        told = " ".join(str(error).split()) or type(error).__name__
        raise refused(file, None, "", f"cannot be read ({told})", _WHAT) from None
    found = [layer for layer in layers if layer.headings]
    if not found:
        raise refused(file, None, "", "empty sheets", "a row of headings, then a row for each task or robot")
    return found


def _layer(file: str, name: str, sheet: Any) -> Layer:
    rows: Iterator[Row] = enumerate(sheet.iter_rows(), 1)
    return table_layer(file, name, rows, where=f"sheet {name}")


def _require_moderate(archive: zipfile.ZipFile, path: Path) -> None:
    """Refuse a workbook with a sheet whose last cell is far out."""
    for name in filter(_SHEETS.fullmatch, archive.namelist()):
        data = unpacked(archive, name, path, _WHAT)
        cells = _CELL.findall(data)
        width = max((_number(letters) for letters, _ in cells), default=0)
        height = max((int(row) for row in (*(row for _, row in cells), *_ROW.findall(data))), default=0)
        if height > MOST_ROWS or height * width > _MOST_CELLS:
            told = f"{height:,} rows of {width:,} cells"
            raise refused(str(path), None, name, told, f"at most {MOST_ROWS:,} rows, and {_MOST_CELLS:,} cells")


def _number(letters: bytes) -> int:
    """The number of a column: A is 1, AA 27."""
    found = 0
    for letter in letters.upper():
        found = 26 * found + letter - 64
    return found
