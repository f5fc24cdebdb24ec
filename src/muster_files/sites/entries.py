"""The features of a layer with their roles and values: what a mission is built of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any

from muster.mission.errors import Finding
from muster_files.sites.decisions import Decision
from muster_files.sites.features import Coordinate, Feature, Geometry, Layer
from muster_files.sites.file_sizes import MOST_VALUES, require_few
from muster_files.sites.headings import Columns, bare_numbers, columns_of
from muster_files.sites.keys import CIRCLE, ROLE, SKIP, WITH_PLACE, keys_of
from muster_files.sites.labels import labels_of, names_of, quoted
from muster_files.sites.roles import Roles, forbidden_by_name, names_role
from muster_files.sites.shapes import from_text
from muster_files.sites.value_fates import IN_DEGREES, IN_METRES, OF_PLACES, ValueFates

_NEAR = 0.75
"""How much a heading that means nothing is like a key, to be taken for a slip."""
_MOST_NAMED = 8
_MOST_UNDECIDED = 20
_OF_PLANS = frozenset(("starts_at", "ends_at", "starts_s", "ends_s"))
"""What exported plans say of stops: no slips of keys."""
_EXPECTED_PLACE = "columns of latitude and longitude (or x and y); --column lat=HEADING --column lon=HEADING names them"


@dataclass(frozen=True)
class Entry:
    """One thing of the site.

    Parameters
    ----------
    values
        by key, without those of its place.
    degrees, metres
        of a point, one of the two.
    over_ground
        whether the third of `degrees` is a height over the ground.
    geometry
        of a line or an area.
    also
        another name by which references may mean it.
    holes, middle
        of an area of a plan, what else the plan has of it: its holes, and where its task is.
    reason
        what decided its role.
    named_by
        of a robot, the name by which `--as` means it, or all of its layer.
    """

    role: str
    feature: Feature
    columns: Columns
    values: Mapping[str, object]
    degrees: Coordinate | None = None
    metres: tuple[float, ...] | None = None
    over_ground: bool = False
    geometry: Geometry | None = None
    also: str | None = None
    holes: tuple[Entry, ...] = ()
    middle: Entry | None = None
    reason: str = ""
    named_by: str = ""

    def finding(self, key: str, value: object, expected: str) -> Finding:
        """What is wrong with the value of a key."""
        return self.feature.finding(self.columns.heading(key), value, expected)

    @property
    def told(self) -> str:
        """As notes name it: by its name, else by where it is in its file."""
        named = self.values.get("id") or self.values.get("name")
        return str(named or self.feature.where or f"line {self.feature.line}")

    @property
    def height(self) -> float | None:
        """Of a point, if it has one."""
        place = self.degrees or self.metres or ()
        return place[2] if len(place) > 2 else None


def entries_of(
    layer: Layer,
    roles: Roles,
    default: str | None,
    given: Mapping[str, str],
    findings: list[Finding],
    notes: list[str],
) -> list[Entry]:
    """What a layer holds; what of it is not read is noted."""
    if layer.passed_over:
        notes.append(f"{layer.title}: passed over: {some_of(layer.passed_over)}")
    notes += [f"{layer.title}: {note}" for note in layer.notes]
    drawn = {id(feature.source) for feature in layer.features if feature.geometry is not None}
    features = list(_with_shapes(_without_empty(layer, notes), findings))
    features = _without_labels(layer, features, notes)
    decided = [(feature, roles.decide(layer, feature, default, findings)) for feature in features]
    by_role = _by_role(layer, decided, findings, notes)
    found: list[Entry] = []
    unread: dict[str, list[str]] = {}
    for role, chosen in by_role.items():
        members = [feature for feature, _ in chosen]
        columns = columns_of(layer, role, given, findings, members)
        if role in WITH_PLACE and not columns.wrong.isdisjoint(OF_PLACES):
            continue
        if role in WITH_PLACE and not _has_places(members, columns):
            if not _passes_over(layer, default, notes):
                findings.append(_without_places(layer))
            for feature in members:
                feature.source.pass_over("has no place, as nothing in its table has")
            continue
        if taken := bare_numbers(columns, members):
            notes.append(f"{layer.title}: numbers without a unit are taken so: {', '.join(taken)}")
        fates = ValueFates(role, columns, drawn)
        for feature, decision in chosen:
            feature.source.keep(fates.of(feature))
            found += [replace(e, reason=decision.reason) for e in _entry(role, feature, columns, findings)]
        for heading in fates.unread(members):
            unread.setdefault(heading, []).append(role)
    found = [_forbidden(layer, entry) for entry in found]
    filled = {heading for feature in features for heading in feature.values}
    unread |= {heading: list(by_role) for heading in _without_meaning(layer, list(by_role)) if heading not in filled}
    if unread:
        notes.append(f"{layer.title}: not read: {_told_unread(layer, unread, list(by_role))}")
    return found


def _without_labels(layer: Layer, features: list[Feature], notes: list[str]) -> list[Feature]:
    """The features without points that stand beside areas of the same feature: where programs write its name."""
    drawn = {id(one.values) for one in features if one.geometry is not None and one.geometry.shape == "area"}
    labels = [
        one
        for one in features
        if one.geometry is not None and one.geometry.shape == "point" and id(one.values) in drawn
    ]
    if labels:
        told = some_of([one.where or f"line {one.line}" for one in labels])
        notes.append(f"{layer.title}: passed over, points beside areas of the same feature: {told}")
    lost = set(map(id, labels))
    return [one for one in features if id(one) not in lost]


def _by_role(
    layer: Layer, decided: Sequence[tuple[Feature, Decision]], findings: list[Finding], notes: list[str]
) -> dict[str, list[tuple[Feature, Decision]]]:
    """The features by their roles; those that nothing decides are findings, those passed over are noted."""
    findings += _undecided_findings(layer, [pair for pair in decided if pair[1].role is None], len(decided))
    found: dict[str, list[tuple[Feature, Decision]]] = {}
    skipped: dict[str, list[str]] = {}
    for feature, decision in decided:
        if decision.role == SKIP:
            skipped.setdefault(decision.reason, []).append(feature.where or f"line {feature.line}")
            feature.source.pass_over(decision.reason)
        elif decision.role is not None:
            found.setdefault(decision.role, []).append((feature, decision))
    notes += [f"{layer.title}: passed over, {reason}: {some_of(names)}" for reason, names in skipped.items()]
    return found


def _undecided_findings(layer: Layer, undecided: Sequence[tuple[Feature, Decision]], of: int) -> Iterator[Finding]:
    """Yield a finding for each undecided feature of a layer that has `of` features, up to a number of lines.

    Each has the reason, and the option that decides.
    """
    counts: dict[str, int] = {}
    for feature, _ in undecided:
        for label in labels_of(layer, feature)[:1]:
            counts[label] = counts.get(label, 0) + 1
    for feature, decision in undecided[:_MOST_UNDECIDED]:
        own = next((label for label in labels_of(layer, feature)[:1] if counts[label] == 1), None)
        everything = names_of(layer)[0]
        named = everything if own is None or (len(undecided) == of > 1) else own
        first, *others = decision.choices
        expected = f"--as {quoted(f'{named}={first}')} (or {', '.join(others)}) of muster import, or a property kind"
        yield feature.finding("", f"undecided: {decision.reason}", expected)
    if len(undecided) > _MOST_UNDECIDED:
        feature, decision = undecided[_MOST_UNDECIDED]
        told = f"undecided, with {len(undecided) - _MOST_UNDECIDED - 1} more: {decision.reason}"
        yield feature.finding("", told, f"--as {quoted(f'{names_of(layer)[0]}={decision.choices[0]}')}")


def _forbidden(layer: Layer, entry: Entry) -> Entry:
    """The entry; a closed area whose name says to whom it is forbidden with that. Others are forbidden to all."""
    if entry.role not in ("zone", CIRCLE) or "forbidden_to" in entry.values:
        return entry
    kinds = forbidden_by_name(layer, entry.feature)
    return replace(entry, values={**entry.values, "forbidden_to": kinds}) if kinds else entry


def _without_meaning(layer: Layer, roles: Sequence[str]) -> set[str]:
    """The headings of a layer that mean nothing for any of the roles."""
    unread = [{*columns_of(layer, role, {}, []).unread} for role in roles]
    return {heading for heading in set.intersection(*unread) if heading.casefold() != ROLE.name} if unread else set()


def _told_unread(layer: Layer, unread: Mapping[str, Sequence[str]], roles: list[str]) -> str:
    """Headings that mean nothing, those that mean nothing for some roles alone with these.

    For headings that are nearly a key it says what that may be.
    """
    names = [heading for heading in layer.headings if heading in unread]
    known = [key for role in roles for key in keys_of(role)]
    near = {
        name: []
        if name in _OF_PLANS or len(unread[name]) < len(roles)
        else get_close_matches(name.casefold(), known, n=1, cutoff=_NEAR)
        for name in names[:_MOST_NAMED]
    }
    told = [
        f"{name} (did you mean {found[0]}?)" if found else f"{name}{_of_roles(unread[name], roles)}"
        for name, found in near.items()
    ]
    return some_of([*told, *names[_MOST_NAMED:]])


def _of_roles(unread: Sequence[str], roles: Sequence[str]) -> str:
    return "" if len(unread) == len(roles) else f" of {' and '.join(role + 's' for role in unread)}"


def some_of(names: Sequence[str]) -> str:
    """The first of many names."""
    return ", ".join(names[:_MOST_NAMED]) + (
        f", and {len(names) - _MOST_NAMED} more" if len(names) > _MOST_NAMED else ""
    )


def _without_empty(layer: Layer, notes: list[str]) -> Layer:
    """A layer of a map without the features that have neither a geometry nor a place in their values."""
    if all(feature.geometry is None for feature in layer.features):
        return layer
    columns = columns_of(layer, "task", {}, [])
    places = {columns.heading(key) for key in (*OF_PLACES, "wkt") if key in columns}
    kept: list[Feature] = []
    lost: list[Feature] = []
    for feature in layer.features:
        is_placed = feature.geometry is not None or not places.isdisjoint(feature.values)
        (kept if is_placed else lost).append(feature)
    if lost:
        for feature in lost:
            feature.source.pass_over("has no geometry")
        told = some_of([feature.where or f"line {feature.line}" for feature in lost])
        notes.append(f"{layer.title}: passed over, without a geometry: {told}")
    return replace(layer, features=tuple(kept))


def _with_shapes(layer: Layer, findings: list[Finding]) -> Iterator[Feature]:
    """The features; those of tables whose geometry is a text with the parts of that."""
    columns = columns_of(layer, "lane", {}, [])
    if "wkt" not in columns:
        yield from layer.features
        return
    column, places = columns.by_key["wkt"], 0
    for feature in layer.features:
        told = column.value(feature, findings) if feature.geometry is None else None
        if not isinstance(told, str):
            yield feature
            continue
        places += told.count(",")
        require_few(places, "places", layer.file, feature.line, most=MOST_VALUES)
        try:
            for geometry in from_text(told):
                yield replace(feature, geometry=geometry)
        except ValueError as error:
            expected = "a geometry as well-known text, longitude first: POINT (24.06 35.53)"
            findings.append(feature.finding(column.heading, str(error), expected))


def _has_places(features: list[Feature], columns: Columns) -> bool:
    return any(feature.geometry is not None for feature in features) or any(
        key in columns for key in (*IN_DEGREES[:3], *IN_METRES)
    )


def _passes_over(layer: Layer, default: str | None, notes: list[str]) -> bool:
    """Whether a layer without places is one of several that holds something else, such as remarks."""
    if not layer.name or default is not None or names_role(layer):
        return False
    notes.append(f"{layer.title}: passed over, it has no places")
    return True


def _without_places(layer: Layer) -> Finding:
    line = None if layer.name or not layer.features or layer.features[0].line is None else 1
    told = ", ".join(layer.headings[:8]) or "no headings"
    return Finding(layer.file, line, layer.name, f"no places under {told}", _EXPECTED_PLACE)


def _entry(role: str, feature: Feature, columns: Columns, findings: list[Finding]) -> list[Entry]:
    """The entries of a feature: one, but of several points one each; none with a wrong place."""
    before = len(findings)
    read = {key: column.value(feature, findings) for key, column in columns.by_key.items()}
    values = {key: value for key, value in read.items() if value is not None}
    own = {key: value for key, value in values.items() if key not in (*OF_PLACES, "z", "wkt")}
    entry = Entry(role, feature, columns, own)
    geometry = feature.geometry
    if role not in WITH_PLACE:
        return [replace(entry, geometry=geometry)]
    if geometry is None:
        placed = _placed(entry, values, findings) if len(findings) == before else None
        return [] if placed is None else [placed]
    points = [piece[0][0] for piece in geometry.pieces]
    height = values.get("z")
    if isinstance(height, float):
        points = [(*point[:2], height) for point in points]
    over_ground = geometry.over_ground or height is not None
    several = [replace(entry, degrees=point, over_ground=over_ground) for point in points]
    return several if len(several) == 1 else [_numbered(one, k) for k, one in enumerate(several, 1)]


def _numbered(entry: Entry, number: int) -> Entry:
    """One of the points of a feature; the name of each has its number."""
    named = {key: f"{entry.values[key]}-{number}" for key in ("id", "name") if key in entry.values}
    return replace(entry, values={**entry.values, **named})


def _placed(entry: Entry, values: Mapping[str, object], findings: list[Finding]) -> Entry | None:
    """An entry of a table with its place; None, with a finding, where it has none."""
    height = values.get("z")
    together = values.get("lat_lon")
    if isinstance(together, tuple):
        values = {**values, **dict(zip(("lat", "lon", "alt"), together, strict=False))}
    lat, lon = values.get("lat"), values.get("lon")
    if isinstance(lat, float) and isinstance(lon, float):
        alt = values.get("alt")
        third = height if isinstance(height, float) else alt if isinstance(alt, float) else None
        degrees = (lon, lat) if third is None else (lon, lat, third)
        return replace(entry, degrees=degrees, over_ground=isinstance(height, float))
    given = values.get("position")
    place: list[Any] = list(given) if isinstance(given, list) else []
    if not place:
        place = [values[axis] for axis in ("x", "y") if axis in values]
        place += [height] if height is not None else []
    if "position" not in values and not {"x", "y"} <= values.keys():
        findings.append(_no_place(entry, values))
        return None
    return replace(entry, metres=tuple(place))


def _no_place(entry: Entry, values: Mapping[str, object]) -> Finding:
    keys = [key for key in (*IN_DEGREES[:3], *IN_METRES) if key in entry.columns and key not in values]
    headings = ", ".join(entry.columns.heading(key) for key in keys)
    return entry.feature.finding(headings, "missing", "a place: latitude and longitude, or x and y")
