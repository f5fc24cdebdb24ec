"""The page of a record: one HTML file that contains all it needs and loads nothing from a network."""

from __future__ import annotations

import json
from html import escape
from importlib.resources import files
from pathlib import Path

from muster.mission.errors import Finding, InputError
from muster.report.page.data import page_data
from muster.report.record import Recording

_SCRIPTS = (
    "series.js",
    "names.js",
    "modules/explored.js",
    "map.js",
    "time_marks.js",
    "charts.js",
    "panels.js",
    "player.js",
)
"""The scripts in the order in which the page runs them; those in `modules` are ES modules that other pages import."""


def write_page(path: str | Path, recording: Recording) -> None:
    """Write the page of a record.

    Raises
    ------
    InputError
        if the file cannot be written.
    """
    try:
        Path(path).write_text(page_text(recording), encoding="utf-8")
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError([Finding(str(path), None, "", reason, "a path that can be written")]) from None


def page_text(recording: Recording) -> str:
    """The page as HTML."""
    data = json.dumps(page_data(recording), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    parts = {
        "TITLE": escape(recording.mission.name),
        "STYLE": _file("page.css"),
        "SCRIPT": "\n".join(_script(name) for name in _SCRIPTS),
        "DATA": data.replace("<", "\\u003c"),  # so that no id can end the element that holds it
    }
    pieces = _file("page.html").split("@@")
    return "".join(parts.get(piece, piece) for piece in pieces)


def _script(name: str) -> str:
    """Return a script without the exports of a module, since all scripts of the page share one scope."""
    return _file(name).replace("\nexport ", "\n")


def _file(name: str) -> str:
    return (files("muster.report.page") / name).read_text(encoding="utf-8")
