"""The data of a figure as text, by which two pictures are compared regardless of their pixels."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

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
