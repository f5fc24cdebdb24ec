"""The names of features, layers and files, by which words and users mean them."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import PurePath

from muster_files.sites.cells import visible
from muster_files.sites.features import Feature, Layer
from muster_files.sites.key_words import OF_ROBOTS
from muster_files.sites.keys import IDENTITY

_SUBJECTS = ("task", "robot", "panel", "point", "site", "zone", "area", "waypoint", "target", "asset", *OF_ROBOTS)
_SUBJECT = re.compile(rf"^({'|'.join(_SUBJECTS)})[ _-]+")
"""A word before a heading that says of what it is: `Panel name`."""


def names_of(layer: Layer) -> list[str]:
    """Return the names by which a layer may be called."""
    return _names_in((layer.name, *layer.around), layer.file)


@lru_cache(maxsize=64)
def _names_in(names: tuple[str, ...], file: str) -> list[str]:
    """The names by which a layer may be called; asked for each of its features."""
    path = PurePath(file)
    return [told for told in (*names, path.stem, path.name) if told]


def labels_of(layer: Layer, feature: Feature) -> list[str]:
    """Return the name and the id of a feature, each in one line, as far as it has them."""
    values = (feature.values.get(heading) for heading in _label_headings(layer.headings))
    return [" ".join(visible(value).split()) for value in values if isinstance(value, str)]


@lru_cache(maxsize=64)
def robots_heading(headings: tuple[str, ...]) -> str | None:
    """Return the heading of ids or names that says that they are of robots: `Drone ID`, or `Drone` alone."""
    known = _label_headings(headings)
    if not known:
        alone = [heading for heading in headings if heading.strip().casefold() in _SUBJECTS]
        return alone[0] if len(alone) == 1 and alone[0].strip().casefold() in OF_ROBOTS else None
    return known[0] if all(map(_of_robots, known)) else None


def _of_robots(heading: str) -> bool:
    match = _SUBJECT.match(heading.casefold())
    return match is not None and match[1] in ("robot", *OF_ROBOTS)


@lru_cache(maxsize=64)
def _label_headings(headings: tuple[str, ...]) -> tuple[str, ...]:
    """Return the headings of names and ids among others; asked for each feature of a layer."""
    known = {name for key in IDENTITY for name in (key.name, *key.names)}
    by_name = [heading for heading in headings if bare(heading) in known]
    return tuple(sorted(by_name, key=lambda heading: bare(heading) != "name"))


def bare(heading: str) -> str:
    """Return a heading as the names of keys are: without the word that says of what it is, and marks."""
    return re.sub(r"[\W_]", "", _SUBJECT.sub("", heading.casefold()))


def folded(name: str) -> str:
    """Return a name as it is compared: in lower case, without marks that nobody sees."""
    return " ".join(visible(name).casefold().split())


def quoted(name: str) -> str:
    """Return a name as it stands on a command line."""
    return f'"{name}"' if " " in name else name
