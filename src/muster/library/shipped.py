"""Finds what ships with the package: missions (YAML and TSPLIB) and published tables.

Knows nothing of what a mission means: a summary is read off the lines of the file, which all shipped missions have in
one form (a first comment line that describes the mission; one line a robot and task).
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import yaml

_MISSIONS, _TSPLIB, _PUBLISHED = "missions", "tsplib", "published"
_SUFFIXES = {_MISSIONS: ".yaml", _TSPLIB: ".tsp", _PUBLISHED: ".yaml"}
_SIDES = frozenset({"printed", "corrected"})


@dataclass(frozen=True)
class MissionSummary:
    """What a list of missions shows of one; `robots` is None where the file leaves their number to the user."""

    name: str
    robots: int | None
    tasks: int
    description: str


def mission_names() -> list[str]:
    """The names of the shipped missions: those in YAML, then the TSPLIB instances, each in natural order."""
    return [*_names(_MISSIONS), *_names(_TSPLIB)]


def missions() -> tuple[MissionSummary, ...]:
    """The shipped missions; `muster.load` takes their names."""
    return tuple(mission_summary(name) for name in mission_names())


def mission_path(name: str) -> Path | None:
    """The file of the shipped mission of that name, `.yaml` or `.tsp`; None if there is none."""
    folder = next((folder for folder in (_MISSIONS, _TSPLIB) if name in _names(folder)), None)
    return None if folder is None else _folder(folder) / f"{name}{_SUFFIXES[folder]}"


def mission_summary(name: str) -> MissionSummary:
    """What a shipped mission is, without reading it as a mission.

    Raises
    ------
    KeyError
        if no mission of that name ships.
    """
    path = mission_path(name)
    if path is None:
        raise KeyError(name)
    lines = path.read_text(encoding="utf-8").splitlines()
    if path.suffix == ".tsp":
        head = dict(re.findall(r"^(\w+) : (.*)$", "\n".join(lines), re.MULTILINE))
        return MissionSummary(name, None, int(head["DIMENSION"]) - 1, head["COMMENT"])
    return MissionSummary(name, _items(lines, "robots"), _items(lines, "tasks"), lines[0].lstrip("# "))


def published_names() -> list[str]:
    """The names of the files of published tables, one for each section of a document."""
    return _names(_PUBLISHED)


def published(name: str) -> dict[str, Any]:
    """The published tables of one section of a document.

    A misprinted value is a mapping `{printed, corrected, erratum}`; `as_printed` and `as_corrected` take a side.

    Raises
    ------
    KeyError
        if no tables of that name ship.
    """
    if name not in published_names():
        raise KeyError(name)
    text = (_folder(_PUBLISHED) / f"{name}{_SUFFIXES[_PUBLISHED]}").read_text(encoding="utf-8")
    tables: dict[str, Any] = yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))  # noqa: S506  # safe too
    return tables


def as_printed(data: Any) -> Any:
    """Published data with every misprinted value as the document prints it."""
    return _one_side(data, "printed")


def as_corrected(data: Any) -> Any:
    """Published data with every misprinted value as it should have been."""
    return _one_side(data, "corrected")


def _one_side(data: Any, side: str) -> Any:
    if isinstance(data, list):
        return [_one_side(item, side) for item in data]
    if not isinstance(data, dict):
        return data
    if data.keys() >= _SIDES:
        return data[side]
    return {key: _one_side(item, side) for key, item in data.items()}


def _folder(name: str) -> Path:
    return Path(str(files("muster.library"))) / name


def _names(folder: str) -> list[str]:
    names = (path.stem for path in _folder(folder).glob(f"*{_SUFFIXES[folder]}"))
    return sorted(names, key=_natural)


def _natural(name: str) -> list[tuple[int, int, str]]:
    """A key that sorts `6T-2R` before `31T-6R`, and `31T-6R-as-run` right after `31T-6R`."""
    parts = re.findall(r"\d+|-|[^\d-]+", name)
    return [(0, 0, "") if p == "-" else (1, int(p), "") if p.isdecimal() else (2, 0, p) for p in parts]


def _items(lines: Iterable[str], group: str) -> int:
    """How many items the list `group` has, where each stands on a line of its own; a split task is several."""
    count, inside = 0, False
    for line in lines:
        if not line.startswith((" ", "#")):
            inside = line.startswith(f"{group}:")
        if inside and line.startswith("  - "):
            split = re.search(r"\bsplit: (\d+)", line)
            count += 1 if split is None else int(split[1])
    return count
