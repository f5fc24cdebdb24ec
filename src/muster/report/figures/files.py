"""Files of pictures, with the data by which two of them are compared regardless of pixels."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.mission.errors import Finding, InputError
from muster.report.figures.canvas import require_matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
import hashlib
import json
from collections.abc import Iterable, Iterator

import numpy as np

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


_DECIMALS = 3


def figure_data(figure: Any) -> str:
    """JSON: the words of each axes, and digests of the coordinates of its lines, patches, collections and images."""
    return json.dumps([_axes_data(axes) for axes in figure.axes], ensure_ascii=True)


def _axes_data(axes: Any) -> dict[str, Any]:
    legend = axes.get_legend()
    words = [axes.get_title(), axes.get_xlabel(), axes.get_ylabel(), *(text.get_text() for text in axes.texts)]
    words += [text.get_text() for text in legend.get_texts()] if legend is not None else []
    return {
        "words": [word for word in words if word],
        "lines": _digest(_line(line) for line in axes.lines),
        "patches": _digest(_patch(patch) for patch in axes.patches),
        "collections": _digest(array for collection in axes.collections for array in _collection(collection)),
        "images": _digest(np.asarray(image.get_array(), dtype=float) for image in axes.images),
    }


def _line(line: Any) -> Any:
    return np.asarray(line.get_data_3d() if hasattr(line, "get_data_3d") else line.get_xydata(), dtype=float)


def _patch(patch: Any) -> Any:
    if hasattr(patch, "arrow_patch") or not hasattr(patch, "get_patch_transform"):
        return np.empty(0)
    ends = getattr(patch, "_posA_posB", None)  # of an arrow, whose outline depends on the size of the picture
    if ends is not None:
        return np.asarray(ends, dtype=float)
    return patch.get_patch_transform().transform(patch.get_path().vertices)


def _collection(collection: Any) -> Iterator[Any]:
    if hasattr(collection, "do_3d_projection"):
        return  # drawn as seen: its outlines are made anew by every drawing; lines and words tell of the same
    yield np.ma.filled(np.ma.asarray(collection.get_offsets(), dtype=float), np.nan)
    for path in collection.get_paths():
        yield np.asarray(path.vertices, dtype=float)


def _digest(arrays: Iterable[Any]) -> str:
    """The number of arrays and a hash of their values, rounded; -0 counts as 0."""
    digest, count = hashlib.sha256(), 0
    for count, array in enumerate(arrays, start=1):  # noqa: B007
        digest.update(np.ascontiguousarray(np.round(array, _DECIMALS) + 0.0).tobytes())
    return f"{count}:{digest.hexdigest()[:16]}"
