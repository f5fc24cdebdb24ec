"""What readers of site files make of them: layers of features, each with its values and perhaps a geometry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date, time, timedelta
from textwrap import shorten
from typing import Literal, Protocol

from muster.mission.errors import Finding, MissionError
from muster.mission.import_ledger import LedgerBook, Source
from muster.mission.value_types import shown

Coordinate = tuple[float, ...]
"""Longitude and latitude in degrees (WGS84), and perhaps a height in metres."""
Ring = tuple[Coordinate, ...]
"""The coordinates of a line; of an area its corners, the first of them again at the end."""
Shape = Literal["point", "line", "area"]

_LONGEST_NAME = 40
HEIGHT = "the height of the place"
"""What readers call, beside the headings of a `Source`, an element that says how high a point is."""


class Document(Protocol):
    """The whole source of a file, which knows after reading what became of each of its elements."""

    def enter(self, book: LedgerBook) -> None:
        """Give the ledger every element of the file, with its fate."""


@dataclass(frozen=True)
class Geometry:
    """Points, lines or areas.

    Parameters
    ----------
    pieces
        of a point or a line one ring each; of an area its outer ring, then its holes.
    over_ground
        whether heights are metres over the ground, and not over the ellipsoid.
    in_metres
        whether places are metres in the map frame, and not degrees.
    names
        of the places of a line, where these have such.
    """

    shape: Shape
    pieces: tuple[tuple[Ring, ...], ...]
    over_ground: bool = False
    in_metres: bool = False
    names: tuple[str, ...] = ()


@dataclass(frozen=True)
class Feature:
    """One row of a table, or one feature of a map.

    Parameters
    ----------
    values
        what stands under each heading; empty cells are left out.
    file, line
        where it begins; None where there are no lines.
    where
        which one of the file it is, where the line alone does not say so: `sheet Panels`, `features[3]`.
    source
        what becomes of its values; features that are made of one thing in the file share it.
    """

    values: Mapping[str, object]
    file: str
    line: int | None
    where: str = ""
    geometry: Geometry | None = None
    source: Source = field(default_factory=Source, compare=False, repr=False)

    def finding(self, heading: str, value: object, expected: str) -> Finding:
        """What is wrong with a value of it."""
        field = ", ".join(part for part in (self.where, heading) if part)
        return Finding(self.file, self.line, field, _told(value), expected)


@dataclass(frozen=True)
class Layer:
    """Features that have their headings in common: a table, a sheet, a folder.

    `name` is that of the sheet, folder or layer, if there is one; `headings` are in the order of the file;
    `passed_over` is what has no place in a mission; `notes` are what else is to be said of it. `document` is the file
    of which the layer is; a reader of an installed package may leave it out. `around` are the names of the folders and
    of the document in which the layer is, the innermost first.
    """

    file: str
    name: str
    headings: tuple[str, ...]
    features: tuple[Feature, ...]
    passed_over: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    document: Document | None = field(default=None, compare=False, repr=False)
    around: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """The layer as messages name it."""
        return f"{self.file}, {self.name}" if self.name else self.file


def _told(value: object) -> str:
    if isinstance(value, str):
        return value
    return str(value) if isinstance(value, date | time | timedelta) else shown(value)


def with_name(where: str, values: Mapping[str, object]) -> str:
    """Where a feature is in its file, with its name, if it has one."""
    name = next((v for k, v in values.items() if k.casefold() in ("name", "title") and isinstance(v, str)), "")
    name = shorten("".join(filter(str.isprintable, name)), _LONGEST_NAME, placeholder=" ...")
    return f"{where} ({name})".strip() if name else where


def layer_of(
    file: str, name: str, features: list[Feature], document: Document | None = None, around: tuple[str, ...] = ()
) -> Layer:
    """A layer whose headings are those of its features."""
    headings = dict.fromkeys(heading for feature in features for heading in feature.values)
    return Layer(file, name, tuple(headings), tuple(features), document=document, around=around)


def refused(file: str, line: int | None, field: str, value: object, expected: str) -> MissionError:
    """The error of a file that cannot be read."""
    told = value if isinstance(value, str) else shown(value)
    return MissionError([Finding(file, line, field, told, expected)])
