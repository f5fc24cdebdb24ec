"""The results of a comparison in a file: each run is a line of CSV, written as it comes."""

from __future__ import annotations

import csv
import io
import math
import os
import sys
from collections.abc import Iterable, Sequence
from dataclasses import fields
from pathlib import Path
from types import TracebackType
from typing import Any, TextIO

from muster.mission.errors import Finding, InputError, ParameterError
from muster_studies.comparison.performer import Trial
from muster_studies.comparison.run import DONE, STATUSES, Run

COLUMNS = tuple(f.name for f in fields(Run))
_ASKED = ("objective", "parameters", "time_limit_s", "iteration_limit", "clock", "digest")
"""What must be the same where a comparison goes on."""
_TYPES = {f.name: str(f.type) for f in fields(Run)}
_FLAGS = {"true": True, "false": False}
_NEEDED = ("seed", "cut_short")
_NEEDED_OF_DONE = ("value", "weight_completed", "weight_total", "tasks_completed", "tasks_total")


class ResultsFile:
    """A file of runs, to which others are added.

    Raises
    ------
    InputError
        if it is there, and is none of this kind.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._size = path.stat().st_size if path.exists() else 0
        self._runs = _read(path) if self._size else []

    def __enter__(self) -> ResultsFile:
        self._file = self._path.open("a", encoding="utf-8", newline="")
        try:
            _lock(self._file, self._path)
            if self._path.stat().st_size != self._size:
                raise _in_use(self._path, "results that were added meanwhile", "begun again: it goes on from them")
        except InputError:
            self._file.close()
            raise
        if self._size:
            _drop_broken_line(self._path)
        else:
            self._write(COLUMNS)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._file.close()
        self._size = self._path.stat().st_size

    def known(self, blanks: Iterable[Run]) -> dict[Trial, Run]:
        """The runs that the file has of those asked for.

        Parameters
        ----------
        blanks
            for each run asked for its row before it is made.

        Raises
        ------
        InputError
            if the file has one of them that was made otherwise.
        """
        wanted = {(run.mission, run.allocator, run.seed): run for run in blanks}
        found: dict[Trial, Run] = {}
        for line, run in self._runs:
            key = run.mission, run.allocator, run.seed
            if key in wanted:
                self._require_same(run, wanted[key], line)
                found[key] = run
        return found

    def add(self, run: Run) -> None:
        """Write a run; it is in the file when this returns."""
        self._write(tuple(_text(getattr(run, name)) for name in COLUMNS))

    def _write(self, cells: Iterable[str]) -> None:
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerow(cells)
        self._file.write(text.getvalue())
        self._file.flush()

    def _require_same(self, run: Run, asked: Run, line: int) -> None:
        for name in _ASKED:
            had, wants = getattr(run, name), getattr(asked, name)
            if had != wants:
                what = "another mission of this name" if name == "digest" else _text(had) or "none"
                expected = f"{_text(wants) or 'none'}, as asked now; or another file"
                raise InputError([Finding(str(self._path), line, name, what, expected)])


def _read(path: Path) -> list[tuple[int, Run]]:
    """The runs of a file, with their lines; a last line that was not written to its end is left out."""
    text = path.read_text(encoding="utf-8-sig", errors="replace")
    lines = text[: text.rfind("\n") + 1].splitlines()
    reader = csv.reader(lines)
    head = next(reader, [])
    if tuple(head) != COLUMNS:
        raise _no_results(path, head)
    return [(reader.line_num, _run(path, reader.line_num, cells)) for cells in reader]


def _run(path: Path, line: int, cells: list[str]) -> Run:
    if len(cells) != len(COLUMNS):
        raise InputError([Finding(str(path), line, "", f"{len(cells)} cells", f"{len(COLUMNS)}, as in the first line")])
    given = dict(zip(COLUMNS, cells, strict=True))
    if given["status"] not in STATUSES:
        raise InputError([Finding(str(path), line, "status", given["status"] or "nothing", " or ".join(STATUSES))])
    needed = _NEEDED + _NEEDED_OF_DONE if given["status"] == DONE else _NEEDED
    values: dict[str, Any] = {}
    for name, cell in given.items():
        try:
            values[name] = _value(_TYPES[name], cell, is_needed=name in needed)
        except ValueError as error:
            raise InputError([Finding(str(path), line, name, cell or "nothing", str(error))]) from None
    return Run(**values)


def _value(kind: str, cell: str, *, is_needed: bool) -> Any:
    """What a cell holds; ValueError with what is expected where it holds something else."""
    if "str" in kind:
        return cell
    if cell == "" and not is_needed:
        return None
    if "bool" in kind:
        if cell.lower() not in _FLAGS:  # spreadsheets write them in capitals
            raise ValueError("True or False")
        return _FLAGS[cell.lower()]
    try:
        value = int(cell) if "int" in kind else float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError("a whole number" if "int" in kind else "a number")
    return value


def _no_results(path: Path, head: Sequence[str]) -> InputError:
    """The refusal of a file with another first line; of results of another version, by the columns that it lacks."""
    expected = f"results of muster compare: a first line {','.join(COLUMNS[:4])},..."
    found = ",".join(head[:4]) or "no first line"
    lacking = [name for name in COLUMNS if name not in head]
    if tuple(head[:4]) == COLUMNS[:4] and lacking:
        found, expected = f"no column {', '.join(lacking)}", "results of this version of Muster; or another file"
    return InputError([Finding(str(path), 1, "", found, expected)])


def _text(value: object) -> str:
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)


def _lock(file: TextIO, path: Path) -> None:
    """Keep other comparisons from the file, until it is closed; Windows has no such locks."""
    if sys.platform == "win32":
        return
    import fcntl

    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise _in_use(path, "written by another comparison", "a file of its own for each, or to wait") from None


def _in_use(path: Path, what: str, expected: str) -> InputError:
    return InputError([Finding(str(path), None, "", what, expected)])


def _drop_broken_line(path: Path) -> None:
    """Cut off a last line that was not written to its end."""
    with path.open("rb+") as file:
        data = file.read()
        whole = data.rfind(b"\n") + 1
        if whole < len(data):
            file.seek(whole)
            file.truncate()


def require_results_place(path: Path) -> None:
    """Refuse a file of results that cannot be written, before anything is made.

    Raises
    ------
    ParameterError
    """
    if path.suffix.lower() != ".csv":
        raise ParameterError(f"results: {path}; expected a file that ends in .csv")
    if path.is_dir() or not path.parent.is_dir():
        raise ParameterError(f"results: {path}; expected a file in a folder that exists")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise ParameterError(f"results: {path}; expected a place with permission to write")
