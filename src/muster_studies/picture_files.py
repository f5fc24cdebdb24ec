"""Pictures of studies to files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from muster.report import save_figure
from muster_studies.effort import Effort

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_figures(
    folder: Path, effort: Effort, numbers: Sequence[str], makers: Mapping[str, Callable[[Effort], Figure]]
) -> list[Path]:
    """Draw those of these tables that have a maker of a picture; returns the files made: `figure-7.png`."""
    made = []
    for number in (number for number in numbers if number in makers):
        path = folder / f"{number.lower().replace(' ', '-')}.png"
        save_figure(makers[number](effort), path)
        made.append(path)
    return made
