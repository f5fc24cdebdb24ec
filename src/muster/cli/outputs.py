"""Checks of the files that a verb writes, made before the work."""

from __future__ import annotations

import os
from pathlib import Path

from muster.mission.errors import ParameterError


def require_csv(file: Path | None, option: str = "--book") -> None:
    if file is not None and file.suffix.lower() != ".csv":
        raise ParameterError(f"{option}: {file}; expected a file that ends in .csv")


def require_folder(folder: Path | None, option: str) -> None:
    if folder is not None and folder.exists() and not folder.is_dir():
        raise ParameterError(f"{option}: {folder} is a file; expected a folder, or a name for a new one")


def require_writable(
    plan: Path | None,
    others: tuple[Path | None, ...],
    inputs: tuple[str | Path | None, ...],
    plans: tuple[Path | None, ...],
) -> None:
    """Refuse files that cannot be written, or that are read, written twice, or would replace an input.

    The plan may replace one of the plans that are read.
    """
    taken = {Path(name).resolve() for name in inputs if name is not None and Path(name).is_file()}
    read = {file.resolve() for file in plans if file is not None}
    for file, not_onto in ((plan, set[Path]()), *((other, read) for other in others)):
        if file is None:
            continue
        if file.resolve() in taken | not_onto:
            raise ParameterError(f"{file}: given twice; expected a file that is neither read nor written otherwise")
        taken.add(file.resolve())
        if file.is_dir() or not file.parent.is_dir():
            raise ParameterError(f"{file}: cannot be written; expected a file in a folder that exists")
        if not os.access(file if file.exists() else file.parent, os.W_OK):
            raise ParameterError(f"{file}: cannot be written; expected a place with permission to write")


def require_drawable(*files: Path | None) -> None:
    from muster.report.figures.canvas import require_matplotlib
    from muster.report.figures.files import check_suffix

    for file in files:
        if file is not None:
            check_suffix(file)
            require_matplotlib()
