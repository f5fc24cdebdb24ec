"""Writes pictures to files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.mission.errors import Finding, InputError
from muster.report.figures.canvas import require_matplotlib
from muster.report.figures.figure_data import figure_data

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_METADATA: dict[str, dict[str, Any]] = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
"""By suffix: what keeps the time of writing out of the file, so that the same picture gives the same bytes."""


def check_suffix(path: str | Path) -> None:
    """Raise InputError unless `save_figure` knows the suffix; to be asked before hours of work, not after."""
    suffix = Path(path).suffix
    if suffix.lower() not in _METADATA:
        known = ", ".join(_METADATA)
        raise InputError(
            [Finding(str(path), None, "", f"suffix {suffix!r}" if suffix else "no suffix", f"one of {known}")]
        )


def save_figure(picture: Axes | Figure, path: str | Path) -> None:
    """Write a figure, or the figure that axes are on, as PNG, SVG or PDF, by the path's suffix; 150 dots per inch.

    PNG and SVG hold `figure_data` as their Description, by which two pictures can be compared.

    Raises
    ------
    InputError
        if the suffix is unknown or the file cannot be written.
    MissingExtraError
        if matplotlib is not installed.
    """
    check_suffix(path)
    require_matplotlib()
    from matplotlib import rc_context

    figure: Any = picture.figure.canvas.figure  # the outermost one, also from a subfigure
    suffix = Path(path).suffix.lower()
    metadata = {**_METADATA[suffix], **({} if suffix == ".pdf" else {"Description": figure_data(figure)})}
    try:
        with rc_context({"svg.hashsalt": "muster"}):
            figure.savefig(path, dpi=150, bbox_inches="tight", pad_inches=0.12, metadata=metadata)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError([Finding(str(path), None, "", reason, "a path that can be written")]) from None


def svg_text(picture: Axes | Figure) -> str:
    """A picture as an SVG element that stands in a page: as wide as its place, its text as paths.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    require_matplotlib()
    from io import StringIO

    from matplotlib import rc_context

    figure: Any = picture.figure.canvas.figure
    text = StringIO()
    with rc_context({"svg.hashsalt": "muster"}):
        figure.savefig(text, format="svg", bbox_inches="tight", pad_inches=0.05, metadata={"Date": None})
    whole = text.getvalue()
    return whole[whole.index("<svg") :]
