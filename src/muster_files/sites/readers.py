"""The kinds of site files that can be read, by their suffixes; readers are loaded when used."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from muster.mission.errors import Finding, MissionError
from muster.mission.system.plugins import Registry, function_expected

if TYPE_CHECKING:
    from muster_files.sites.features import Layer

Reader = Callable[[Path], "Sequence[Layer]"]
"""Reads a file as layers of features; raises MissionError for one that it cannot read."""


READERS: Registry[Reader] = Registry(
    "reader",
    "muster.readers",
    function_expected("a function of a path"),
)
"""By the suffix of their files without the dot, those of installed packages included."""

_HINTS = {
    ".xls": "; save it as .xlsx",
    ".ods": "; save it as .xlsx or .csv",
    ".shp": "; save it as GeoPackage or GeoJSON",
    ".zip": "; unpack it",
    ".dxf": "; save it as GeoJSON",
}
_FIRST_BYTES = 4096


def is_site(path: Path) -> bool:
    """Whether a file is one of a site: by its suffix, or JSON that begins as GeoJSON does."""
    suffix = path.suffix.lower().lstrip(".")
    return suffix in READERS or (suffix == "json" and _begins_as_geojson(path))


def reader_of(path: Path) -> Reader:
    """The reader of a file.

    Raises
    ------
    MissionError
        if nothing here reads such files; it says what is read.
    PluginError
        if the package that reads it cannot be used.
    """
    suffix = path.suffix.lower().lstrip(".")
    if suffix in READERS:
        return READERS.named(suffix)
    if suffix == "json" and _begins_as_geojson(path):
        return READERS.named("geojson")
    raise unknown_file(path)


def unknown_file(path: Path) -> MissionError:
    """The error of a file of another kind: one line that says what can be read."""
    kinds = ", ".join(f".{name}" for name in READERS)
    expected = (
        f"a mission (.yaml, .json, .plan), a site ({kinds}) or an instance file{_HINTS.get(path.suffix.lower(), '')}"
    )
    told = f"a file of the kind {path.suffix}" if path.suffix else "a file without a suffix"
    return MissionError([Finding(str(path), None, "", told, expected)])


def _begins_as_geojson(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            start = file.read(_FIRST_BYTES)
    except OSError:
        return False
    return b'"FeatureCollection"' in start or (b'"Feature"' in start and b'"geometry"' in start)
