"""`python -m tools.figures [STUDY...] [--folder DIR] [--page]`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from muster_studies.effort import Effort
from muster_studies.figures import draw_figures
from muster_studies.registry import Study, study_named
from tools.docs_check import measured
from tools.docs_check.commands import ROOT
from tools.figures.page import command_of, illustrated, page, sheet_of
from tools.figures.sheet import write_sheet

_STORE = "pictures"


def draw(study: Study, folder: Path, sheet: Path) -> None:
    """Draw all figures of a study into a folder of its own, and its contact sheet."""
    place = folder / study.name
    place.mkdir(parents=True, exist_ok=True)
    made = []
    for figure, path in zip(study.figures, draw_figures(study.figures, Effort(quick=True), place), strict=True):
        made.append((f"{figure.number} ({figure.source})" if figure.source else figure.number, path))
        print(path, flush=True)
    write_sheet(sheet, made)


def store(study: Study, sheet: Path) -> None:
    """Keep the command, commit and digest of a contact sheet, by which docs-check knows it."""
    entry = {"command": command_of(study.name), "commit": measured.commit(), "sha256": measured.digest(sheet)}
    measured.store(_STORE, {**(measured.load(_STORE) or {}), sheet.name: entry})


def main() -> int:
    """The command: without `--page` sheets are made below the current folder alone."""
    parser = argparse.ArgumentParser(prog="python -m tools.figures", description="Draw the figures of studies.")
    parser.add_argument("studies", nargs="*", help="of these studies; all by default")
    parser.add_argument("--folder", type=Path, default=Path("figures"), help="where figures are drawn")
    parser.add_argument("--page", action="store_true", help="write docs/figures.md and keep the digests of its sheets")
    given = parser.parse_args()
    base = ROOT if given.page else Path()
    if given.page:
        (ROOT / "docs" / "figures.md").write_text(page(), encoding="utf-8")
    for study in [study_named(name) for name in given.studies] or illustrated():
        sheet = base / "docs" / sheet_of(study.name)
        draw(study, given.folder, sheet)
        if given.page:
            store(study, sheet)
    return 0


if __name__ == "__main__":
    sys.exit(main())
