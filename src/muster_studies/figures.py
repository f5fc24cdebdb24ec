"""Figures of studies: the number as printed, what the print shows, how it is drawn; and files of like names."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.report import save_figure
from muster_studies.effort import Effort

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Draw = Callable[[Effort], "Axes | Figure"]
"""Draws a whole figure."""
ALL = "all"
"""In place of numbers: every figure of a study."""


@dataclass(frozen=True, kw_only=True)
class StudyFigure:
    """One figure of a study.

    Parameters
    ----------
    number
        as printed, such as `6.3`; a name where no print has it.
    source
        the publication, a key of docs/references.md; empty where none has it.
    shows
        what the print shows, or what the picture shows where there is no print: one sentence.
    draw
        draws it, the whole figure.
    tables
        the study's tables that it belongs to; `--tables` selects figures by them.
    differs
        what differs from the print besides the numbers; may be empty.
    """

    number: str
    source: str = ""
    shows: str
    draw: Draw
    tables: tuple[str, ...] = ()
    differs: str = ""

    @property
    def file_name(self) -> str:
        """`figure-6.3.png`; `NAME.png` where no print has it."""
        return f"figure-{self.number}.png" if self.source else f"{self.number}.png"


def wanted_figures(figures: Sequence[StudyFigure], effort: Effort) -> tuple[StudyFigure, ...]:
    """Those that an effort names, by their numbers or by tables; all where it names neither.

    Raises
    ------
    ParameterError
        if there is no figure of a number that it names.
    """
    if effort.figures and effort.figures != (ALL,):
        numbers = [figure.number for figure in figures]
        for number in effort.figures:
            if number not in numbers:
                hint = did_you_mean(number, numbers)
                raise ParameterError(f"figure: {number}; expected {' or '.join([ALL, *numbers])}{hint}")
        return tuple(figure for figure in figures if figure.number in effort.figures)
    if effort.tables and not effort.figures:
        return tuple(figure for figure in figures if set(figure.tables) & set(effort.tables))
    return tuple(figures)


def draw_figures(figures: Sequence[StudyFigure], effort: Effort, folder: Path) -> Iterator[Path]:
    """Draw the figures that an effort names into a folder, one after the other; yields each file made.

    Raises
    ------
    ParameterError
        if there is no figure of a number that it names.
    MissingExtraError
        if a part that a figure needs is not installed.
    """
    for figure in wanted_figures(figures, effort):
        path = folder / figure.file_name
        save_figure(figure.draw(effort), path)
        yield path
