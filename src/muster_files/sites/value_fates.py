"""What becomes of the values of a feature: each is read as a key of its role, or passed over with the reason."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from muster.mission.import_ledger import Fate, passed_over, read_as
from muster_files.sites.features import HEIGHT, Feature
from muster_files.sites.headings import Columns
from muster_files.sites.keys import AT_POINTS, ROLE
from muster_files.sites.roles import is_of_plan, role_word

IN_DEGREES = ("lat", "lon", "lat_lon", "alt")
IN_METRES = ("x", "y", "position")
OF_PLACES = (*IN_DEGREES, *IN_METRES)
_OF_AREAS = ("action", "of")
"""What exported plans say of areas, and is read by its own name."""
_AS_ROLE = read_as("what the feature is")
_BESIDE_PLACE = passed_over("stands beside a geometry, or a place that is stronger")
_HEIGHT = read_as("a height")
_NO_HEIGHT = passed_over("is the height of a line or an area")
_NAMELESS = ("zone", "boundary", "lane")
"""Roles of what has no id in a mission; a door has one of its own."""
_NO_ID = passed_over("is no id: zones, boundaries and lanes have none in a mission", minor=True)
_NAME = read_as("a name, which may say what the feature is")
_PLAN = "is of a plan: Muster plans anew"


class ValueFates:
    """The fates of the values of all features of one role in a layer.

    Parameters
    ----------
    columns
        what the headings mean for the role.
    drawn
        the ids of the sources of features that have a geometry of their own.
    """

    def __init__(self, role: str, columns: Columns, drawn: Collection[int]) -> None:
        self._role, self._columns, self._drawn = role, columns, drawn
        self._places = [(key, columns.by_key[key].heading) for key in (*OF_PLACES, "z") if key in columns]
        self._found: dict[tuple[bool, tuple[str, ...], tuple[str, ...]], Mapping[str, Fate]] = {}

    def of(self, feature: Feature) -> Mapping[str, Fate]:
        """Return the fate of each heading; features with the same share one mapping."""
        placed = tuple(key for key, heading in self._places if heading in feature.values)
        key = id(feature.source) in self._drawn, placed, tuple(self._role_headings(feature))
        if key not in self._found:
            self._found[key] = self._fates(*key)
        return self._found[key]

    def unread(self, members: Sequence[Feature]) -> Iterator[str]:
        """Yield the headings that mean nothing for the role, of those under which a feature of the role has a value."""
        lost = {heading for heading in self._columns.unread if heading.casefold() != ROLE.name}
        found = {h for feature in members for h in lost & feature.values.keys() if self.of(feature)[h].how != "read"}
        yield from (heading for heading in self._columns.unread if heading in found)

    def _role_headings(self, feature: Feature) -> Iterator[str]:
        """Yield the headings whose values say what the feature is."""
        of_plan = any(is_of_plan(feature, kind) for kind in ("area", "hole"))
        for heading, value in feature.values.items():
            folded = heading.casefold()
            if folded in (ROLE.name, *ROLE.names, "type"):
                if role_word(value) or of_plan or (self._role == "robot" and folded != "type"):
                    yield heading
            elif of_plan and heading in _OF_AREAS:
                yield heading

    def _fates(self, drawn: bool, placed: Sequence[str], of_role: Sequence[str]) -> Mapping[str, Fate]:
        if self._role == "route":
            return dict.fromkeys((*(c.heading for c in self._columns.by_key.values()), *self._columns.unread), _ROUTE)
        fates = {
            heading: passed_over(f"means nothing for a {self._role}", noted=True) for heading in self._columns.unread
        }
        beside = (*OF_PLACES, "wkt") if drawn else _weaker(placed)
        for key, column in self._columns.by_key.items():
            fates[column.heading] = _BESIDE_PLACE if key in beside else read_as(key)
            if key in ("id", "name") and self._role in _NAMELESS:
                fates[column.heading] = _NO_ID if key == "id" else _NAME
            if key == ROLE.name:
                fates[column.heading] = passed_over("is no kind of feature that Muster knows")
        fates |= dict.fromkeys(of_role, _AS_ROLE)
        fates[HEIGHT] = _HEIGHT if self._role in AT_POINTS else _NO_HEIGHT
        return fates


def _weaker(placed: Collection[str]) -> Collection[str]:
    """Of the keys by which a row says where it is those that do not count beside the others."""
    if "lat_lon" in placed or {"lat", "lon"} <= {*placed}:
        together = ("lat", "lon") if "lat_lon" in placed else ()
        return (*IN_METRES, *together, *(("alt",) if "z" in placed else ()))
    return (*IN_DEGREES, *(("x", "y", "z") if "position" in placed else ()))


_ROUTE = passed_over(_PLAN, noted=True)
