"""What the headings of a layer mean: each a key and the unit of its numbers, or nothing."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from muster.mission.errors import Finding, ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster_files.sites.cells import CellError, NoValue, is_bare_number, moment, pairs
from muster_files.sites.features import Feature, Layer
from muster_files.sites.key_words import MOST, OF_ROBOTS, SUBJECTS
from muster_files.sites.keys import ROLES, SiteKey, keys_of
from muster_files.sites.units import ALL_UNITS, UNITS, units_text

_BRACKETED = re.compile(r"^(.*?)\s*[(\[]\s*([^)\]]*?)\s*[)\]]\s*$")
_WORD = re.compile(r"[^\W_]+|°")
_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")
_SUBJECTS = frozenset((*SUBJECTS, *OF_ROBOTS))
"""Words before a name that say of what it is: `Panel name`. Where no other column has names, one alone is the name."""

_OF_LIMITS = frozenset(("endurance_s", "range_m", "speed_mps", "load_capacity"))
_MOST = frozenset(MOST)
"""Words beside the name of what is a greatest value anyway: `Max. range (km)`."""


@dataclass(frozen=True)
class Column:
    """A heading, the key that it means, and what one unit of its numbers is in SI units.

    `factor` is not a number where the heading says no unit, and the key needs one; `is_bare` is whether it says none.
    """

    heading: str
    key: SiteKey
    factor: float
    is_bare: bool = False

    def value(self, feature: Feature, findings: list[Finding]) -> object:
        """The value of a feature; None where it has none, or, with a finding, a wrong one."""
        cell = feature.values.get(self.heading)
        if cell is None:
            return None
        if isinstance(cell, NoValue):
            findings.append(feature.finding(self.heading, cell.told, cell.expected))
            return None
        try:
            return self.key.read(cell, factor=self.factor) if self.key.dimension else self.key.read(cell)
        except CellError as error:
            findings.append(feature.finding(self.heading, cell, error.args[0]))
            return None


@dataclass(frozen=True)
class Columns:
    """The columns of a layer for features of one role, by key; and the headings that mean nothing for it.

    `wrong` are the keys whose headings have a unit that does not fit.
    """

    by_key: Mapping[str, Column]
    unread: tuple[str, ...]
    wrong: frozenset[str] = frozenset()

    def __contains__(self, key: str) -> bool:
        return key in self.by_key

    def heading(self, key: str) -> str:
        """The heading of a key; the key itself where no column has it."""
        return self.by_key[key].heading if key in self.by_key else key


def columns_of(
    layer: Layer, role: str, given: Mapping[str, str], findings: list[Finding], members: Sequence[Feature] = ()
) -> Columns:
    """What the headings of a layer mean for a role; `given` names headings by key, stronger than any other meaning.

    `members` are the features of the role: a heading under which none has a value gives way to one that means the same.
    """
    used = {heading for feature in members for heading in feature.values} if members else {*layer.headings}
    keys = keys_of(role)
    chosen = {key: heading for key, heading in given.items() if key in keys and heading in layer.headings}
    found: dict[str, Column] = {}
    unread: list[str] = []
    wrong: set[str] = set()
    for heading in sorted(layer.headings, key=lambda heading: heading not in used):
        mine = [key for key, named in chosen.items() if named == heading]
        explicit: list[Column | None] = [_explicit(heading, keys[key]) for key in mine]
        meanings = explicit or [_meaning(heading, keys)]
        for column in meanings:
            is_chosen = column is not None and column.key.name in chosen and not mine
            gives_way = column is not None and column.key.name in found and heading not in used
            if column is None or is_chosen or gives_way or (not mine and _is_other(column, members)):
                unread.append(heading)
            elif column.key.name in found and column.key.name in _LABELS and not mine:
                first = found[column.key.name]
                found[column.key.name], other = (column, first) if _is_exact(column) else (first, column)
                unread.append(other.heading)
            elif column.key.name in found:
                first = found[column.key.name]
                expected = f"one column that says {column.key.name}: --column {column.key.name}={first.heading}"
                findings.append(
                    _of_layer(layer, heading, f"means {column.key.name}, as {first.heading} does", expected)
                )
            elif column.factor == 0:
                wrong.add(column.key.name)
                told = column.key.right or f"{units_text(column.key.dimension)}, or nothing in brackets"
                findings.append(_of_layer(layer, heading, "a unit that does not fit", told))
            else:
                found[column.key.name] = column
    if found.keys().isdisjoint(("id", "name")) and "name" in keys:
        subject = next((heading for heading in unread if heading.strip().casefold() in _SUBJECTS), None)
        if subject is not None:
            unread.remove(subject)
            found["name"] = Column(subject, keys["name"], 1.0)
    return Columns(found, tuple(dict.fromkeys(unread)), frozenset(wrong))


_LABELS = ("id", "name", "type", "kind")
"""Keys of words, of which a layer may have more than it needs: the heading that is the key itself is read."""


def _is_exact(column: Column) -> bool:
    return column.heading.strip().casefold() == column.key.name


def _is_other(column: Column, members: Sequence[Feature]) -> bool:
    """Return whether a heading that often means something else does so here: none of its cells can be read."""
    if _bare_name(column.heading) not in column.key.rare or not members:
        return False
    findings: list[Finding] = []
    read = [column.value(feature, findings) for feature in members if column.heading in feature.values]
    return bool(findings) and all(value is None for value in read)


def _bare_name(heading: str) -> str:
    return "".join(_WORD.findall(heading.casefold()))


def bare_numbers(columns: Columns, members: Sequence[Feature]) -> list[str]:
    """Return the headings under which numbers stand without a unit, each with the unit that they are taken to have."""
    found = []
    for column in columns.by_key.values():
        unit = _UNIT_TAKEN.get(column.key.dimension)
        cells = (feature.values.get(column.heading) for feature in members)
        is_said = column.key.read in _MOMENTS or column.key.name in _IN_METRES
        if unit and column.is_bare and not is_said and any(map(is_bare_number, cells)):
            found.append(f"{column.heading} in {unit}")
    return found


_UNIT_TAKEN = {"time": "s", "length": "m", "speed": "m/s", "mass": "kg or pieces"}
_MOMENTS = (moment, pairs)
_IN_METRES = ("x", "y")
"""Places of the map frame, which is in metres."""


def means_something(heading: str) -> bool:
    """Whether a heading means a key of anything."""
    of_subject = heading.strip().casefold() in _SUBJECTS
    return of_subject or any(_meaning(heading, keys_of(role)) is not None for role in ROLES)


def given_columns(given: Mapping[str, str], layers: Sequence[Layer]) -> dict[str, str]:
    """Headings by the keys that a user names, synonyms included.

    Raises
    ------
    ParameterError
        if there is no such key, or no layer has such a heading.
    """
    found: dict[str, str] = {}
    headings = list(dict.fromkeys(heading for layer in layers for heading in layer.headings))
    known = list(dict.fromkeys(name for role in ROLES for name in keys_of(role)))
    for named, heading in given.items():
        keys = [key for role in ROLES if (key := _key_named(named, keys_of(role))) is not None]
        if not keys:
            hint, told = did_you_mean(named, known), ", ".join(known)
            raise ParameterError(f"--column: no key {named}{hint or f'; expected one of {told}'}")
        if heading not in headings:
            hint = did_you_mean(heading, headings) or f"; the files have {', '.join(headings[:12]) or 'none'}"
            raise ParameterError(f"--column {named}: no heading {heading}{hint}")
        found |= dict.fromkeys((key.name for key in keys), heading)
    return found


def _key_named(named: str, keys: Mapping[str, SiteKey]) -> SiteKey | None:
    if named in keys:
        return keys[named]
    compact = "".join(_WORD.findall(named.casefold())).replace("_", "")
    return next((key for key in keys.values() if compact in _names(key)), None)


def _names(key: SiteKey) -> tuple[str, ...]:
    return key.name.replace("_", ""), *key.names


def _explicit(heading: str, key: SiteKey) -> Column:
    """The column that a user names; its factor is 0 where it has a unit that does not fit the key."""
    stated = [factor for _, factor, is_bare in _readings(heading, key) if not is_bare]
    if not key.dimension or not stated:
        return Column(heading, key, math.nan if key.needs_unit else 1.0, is_bare=True)
    return Column(heading, key, stated[0])


def _meaning(heading: str, keys: Mapping[str, SiteKey]) -> Column | None:
    """The column that a heading is; its factor is 0 where it has a unit that does not fit the key.

    A heading that says no unit means a key that needs one only if it means no other.
    """
    wrong: Column | None = None
    without: Column | None = None
    for key in keys.values():
        for name, factor, is_bare in _readings(heading, key):
            if name in _names(key):
                if math.isnan(factor):
                    without = without or Column(heading, key, factor, is_bare=True)
                elif factor:
                    return Column(heading, key, factor, is_bare)
                else:
                    wrong = wrong or Column(heading, key, 0.0)
    return without or wrong


def _readings(heading: str, key: SiteKey) -> Iterator[tuple[str, float, bool]]:
    """The names that a heading may be, the likeliest first, each with the factor of the unit beside it.

    The third is whether the heading says no unit.
    """
    bracketed = _BRACKETED.match(heading)
    base, unit = (bracketed[1], bracketed[2].casefold()) if bracketed and bracketed[1] else (heading, "")
    units = UNITS[key.dimension]
    own_name = heading.strip().casefold() == key.name
    default = math.nan if key.needs_unit and not own_name else 1.0
    unstated = key.unstated.get(heading.strip().casefold(), default)
    words = [word.casefold() for word in _WORD.findall(_CAMEL.sub(" ", base))]
    for own in _fewer_words(words, key):
        is_wrong = unit in ALL_UNITS or (unit and key.dimension and not key.is_free)
        is_bare = not own_name and not unit and unstated == default
        yield "".join(own), units.get(unit, 0.0 if is_wrong else unstated), is_bare
        if not unit and len(own) > 1:
            beside = own[-1] if len(own) < 3 or own[-2:] not in (["km", "h"], ["m", "s"]) else f"{own[-2]}/{own[-1]}"
            name = own[: -2 if "/" in beside else -1]
            if beside in ALL_UNITS:
                yield "".join(name[:-1] if name[-1:] == ["in"] else name), units.get(beside, 0.0), False


def _fewer_words(words: list[str], key: SiteKey) -> Iterator[list[str]]:
    """Yield the words of a heading, and those without words that say nothing of the key."""
    yield words
    if len(words) > 1 and words[0] in _SUBJECTS:
        yield words[1:]
    fewer = [word for word in words if word not in _MOST]
    if key.name in _OF_LIMITS and 0 < len(fewer) < len(words):
        yield fewer


def _of_layer(layer: Layer, heading: str, value: str, expected: str) -> Finding:
    first = layer.features[0] if layer.features else Feature({}, layer.file, None)
    where = f"{layer.name}, {heading}" if layer.name else heading
    return Finding(layer.file, 1 if first.line is not None and not layer.name else None, where, value, expected)
