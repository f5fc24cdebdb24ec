"""The mission of a site: its entries as the data of a mission file, in one map frame."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from muster.mission.action_keys import ACTION_KEYS
from muster.mission.errors import Finding, MissionError
from muster.mission.model import SCHEMA
from muster.mission.source import Place
from muster.mission.value_types import Path
from muster_files.sites.areas import (
    areas_of,
    around,
    boundary_of,
    circle_of,
    corners_of,
    seen_from,
    survey_tasks,
    zones_of,
)
from muster_files.sites.entries import Entry, some_of
from muster_files.sites.keys import AT_POINTS, CIRCLE, COVERAGE, can_survey, keys_of
from muster_files.sites.origin import choose_origin
from muster_files.sites.references import References
from muster_files.sites.team import choose_usage, energy_of, let_return, require_kinds
from muster_files.sites.times import KEYS as TIMES
from muster_files.sites.times import chosen_start, of_next_day, robot_times, task_times
from muster_files.sites.ways import Ways

if TYPE_CHECKING:
    import shapely

_GROUPS = {"task": "tasks", "robot": "robots", "station": "stations"}
_OWN = frozenset(("id", "name", "kind", "moves", "battery", "endurance_s", "range_m", "capacity", *TIMES))
"""Keys of entries that do not go into the mission as they are."""
_AREAS = ("zone", "boundary", "survey", CIRCLE)


@dataclass(frozen=True, kw_only=True)
class SiteOptions:
    """What a user says of a site besides its files.

    Parameters
    ----------
    columns
        headings by the keys that they mean.
    kinds
        what features are (`boundary`, `survey`, ...) by the name of their file, layer, or their own.
    origin
        latitude and longitude of the map frame's origin, and perhaps its altitude.
    starts_at
        when the mission begins, for clock times.
    name
        of the mission.
    flat
        whether heights are left out.
    survey
        `height_m`, `fov_deg` and `width_m` of areas to survey that have none of their own.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    kinds: Mapping[str, str] = field(default_factory=dict)
    origin: tuple[float, ...] | None = None
    starts_at: str | None = None
    name: str | None = None
    flat: bool = False
    survey: Mapping[str, float | None] = field(default_factory=dict)


@dataclass
class Built:
    """The data of a mission, where its values are from, and what there is to say of it."""

    data: dict[str, Any]
    places: dict[Path, Place] = field(default_factory=dict)
    fields: dict[Path, str] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


class Builder:
    """Builds one mission; what is wrong is gathered, and raised when the frame depends on it.

    Parameters
    ----------
    base
        the data of the mission to which the entries are added, or of its robots alone.
    is_new
        whether the rules of the mission are free: there is no mission to which the entries are added.
    """

    def __init__(
        self, entries: Sequence[Entry], base: Mapping[str, Any] | None, options: SiteOptions, *, is_new: bool = True
    ) -> None:
        self._base = dict(base or {})
        self._options = options
        self._is_new = is_new
        self._entries = [entry for entry in entries if entry.role != "route"]
        self.built = Built({"schema": SCHEMA, "name": "site", **self._base})
        self._made: list[tuple[str, Entry, dict[str, Any]]] = []
        passed_over = len(entries) - len(self._entries)
        if passed_over:
            self.built.notes.append(f"routes of a plan passed over: {passed_over}; Muster plans them anew")

    @property
    def read(self) -> list[Entry]:
        """What was read, once for each thing in the mission: of an area to survey in several parts once for each."""
        times = Counter(id(entry) for _, entry, _ in self._made if entry.role == "survey")
        return [one for entry in self._entries for one in [entry] * max(1, times[id(entry)])]

    def build(self) -> Built:
        """The whole mission."""
        data = self.built.data
        if self._options.name is not None:
            data["name"] = self._options.name
        origin = choose_origin(self._entries, self._base, self._options.origin, flat=self._options.flat)
        self._frame, self._entries = origin.frame, origin.entries
        if origin.chosen is not None:
            data["origin_wgs84"] = origin.chosen
        self.built.findings += origin.findings
        self.built.notes += origin.notes
        self._raise_findings()
        points = [entry for entry in self._entries if entry.role in AT_POINTS]
        spatial = self._is_spatial(points)
        positions = self._positions(points, spatial)
        ids = self._ids(points)
        for entry, position, name in zip(points, positions, ids, strict=True):
            self._add(_GROUPS[entry.role], entry, self._record(entry, name, position))
        self._add_areas(spatial)
        self._resolve_references()
        self._add_lanes()
        self._settle_team()
        self._set_start()
        self._note_next_day()
        self._raise_findings()
        return self.built

    def _settle_team(self) -> None:
        made = [(entry, record) for group, entry, record in self._made if group == "robots"]
        data, findings, notes = self.built.data, self.built.findings, self.built.notes
        require_kinds(made, data, findings, notes)
        if self._is_new:
            choose_usage(made, data, findings, notes)
        let_return(made, data, is_new=self._is_new, notes=notes)

    def _raise_findings(self) -> None:
        if self.built.findings:
            raise MissionError(sorted(self.built.findings, key=lambda finding: (finding.file, finding.line or 0)))

    # Points

    def _is_spatial(self, points: Sequence[Entry]) -> bool:
        """Whether the mission is in space: where it is so already, or all places have heights."""
        if self._options.flat:
            return False
        there = next((len(one["position"]) for one in self._base.get("robots", ())), None)
        if there is not None:
            return there == 3
        high = [entry for entry in points if entry.height is not None]
        if not high:
            return False
        low = next((entry for entry in points if entry.height is None), None)
        if low is None:
            return True
        title = low.feature.file
        if all(entry.over_ground or entry.metres is not None for entry in high):
            self.built.notes.append(f"{title}: places without a height are taken on the ground, at height 0")
            return True
        self.built.notes.append(f"heights left out: places of {title} have none")
        return False

    def _positions(self, points: Sequence[Entry], spatial: bool) -> list[list[float]]:
        size = 3 if spatial else 2
        found: dict[int, list[float]] = {}
        for over_ground in (False, True):
            chosen = [k for k, e in enumerate(points) if e.degrees is not None and e.over_ground == over_ground]
            places = [point.degrees[:size] for k in chosen if (point := points[k]).degrees is not None]
            if self._frame is not None:
                found |= dict(zip(chosen, self._frame.metres(places, over_ground), strict=True))
        found |= {k: list(e.metres[:size]) for k, e in enumerate(points) if e.metres is not None}
        return [[*found[k], *[0.0] * (size - len(found[k]))] for k in range(len(points))]

    def _ids(self, points: Sequence[Entry]) -> list[str]:
        """The id of each; names that stand several times, and places without a name, are numbered."""
        taken = Counter(self._all_ids())
        counts: Counter[str] = Counter()
        ids = []
        repeated: dict[str, int] = {}
        for entry in points:
            own, name = entry.values.get("id"), entry.values.get("name")
            stem = str(own or name or PurePath(entry.feature.file).stem)
            if own is None:
                counts[stem] += 1
                number = counts[stem]
                own = stem if name is not None and number == 1 else f"{stem}-{number}"
                while taken[own]:
                    counts[stem] += 1
                    own = f"{stem}-{counts[stem]}"
                if name is not None and own != stem:
                    repeated[stem] = counts[stem]
            taken[str(own)] += 1
            ids.append(str(own))
        if repeated:
            told = ", ".join(f"{name} ({count} times)" for name, count in list(repeated.items())[:4])
            self.built.notes.append(f"names that stand several times are numbered: {told}")
        return ids

    def _all_ids(self) -> list[str]:
        return [str(one["id"]) for group in _GROUPS.values() for one in self.built.data.get(group, ())]

    def _record(self, entry: Entry, name: str, position: list[float]) -> dict[str, Any]:
        """A task, robot or station as a mission file has it."""
        known = keys_of(entry.role)
        record: dict[str, Any] = {"id": name, "position": position}
        record |= {key: value for key, value in entry.values.items() if key in known and key not in _OWN}
        if entry.role == "robot":
            record |= {"kind": entry.values["moves"]} if "moves" in entry.values else {}
            record |= energy_of(entry)
            record |= robot_times(entry, self.built.findings)
        elif entry.role == "task":
            record |= task_times(entry, self.built.findings)
        return record

    def _resolve_references(self) -> None:
        groups = {group: [str(one["id"]) for one in self.built.data.get(group, ())] for group in _GROUPS.values()}
        references = References(groups)
        for group, entry, record in self._made:
            references.add(group, entry, record["id"])
        for _, entry, record in self._made:
            references.resolve(entry, record, self.built.findings)

    def _add(self, group: str, entry: Entry, record: dict[str, Any]) -> None:
        items = self.built.data.setdefault(group, [])
        self._place((group, len(items)), entry)
        items.append(record)
        self._made.append((group, entry, record))

    def _place(self, at: Path, entry: Entry) -> None:
        feature = entry.feature
        self.built.places[at] = feature.file, feature.line
        prefix = f"{feature.where}, " if feature.where else ""
        if prefix:
            self.built.fields[at] = feature.where
            if entry.role == "survey":
                self.built.fields[*at, "action"] = feature.where
        for key, column in entry.columns.by_key.items():
            for name in {key, *_SAID_AS.get(key, ())}:
                self.built.fields[*at, name] = f"{prefix}{column.heading}"

    # Areas and lines

    def _add_areas(self, spatial: bool) -> None:
        entries = [entry for entry in self._entries if entry.role in _AREAS]
        surveys = [entry for entry in entries if entry.role == "survey"]
        if surveys and not can_survey():
            expected = f"the action {COVERAGE}, which surveys need and this version has not; or --as NAME=zone"
            self.built.findings.append(surveys[0].feature.finding("", "an area to survey", expected))
            return
        zones: list[tuple[Entry, dict[str, Any]]] = []
        bounds: list[tuple[Entry, list[list[float]]]] = []
        mends: dict[str, list[str]] = {}
        for entry in entries:
            if entry.role == CIRCLE:
                center = self._positions([entry], False)[0]
                zones.append((entry, circle_of(entry, center, self.built.findings)))
                continue
            assert self._frame is not None
            areas = areas_of(entry, self._frame, self.built.findings, mends if entry.role == "zone" else None)
            if entry.role == "survey":
                tasks = survey_tasks(self._seen(entry), areas, self._holes(entry), self._middle(entry, spatial))
                for task, name in zip(tasks, self._ids([entry] * len(areas)), strict=True):
                    record = self._record(entry, name, task["position"])
                    kept = {key: value for key, value in record.items() if key not in ACTION_KEYS[COVERAGE].names}
                    self._add("tasks", entry, kept | task_times(entry, self.built.findings) | task)
                continue
            if entry.role == "boundary":
                corners, holes = boundary_of(entry, areas, self.built.findings)
                bounds.append((entry, corners))
            else:
                holes = zones_of(entry, areas, self.built.findings)
            zones += [(entry, zone) for zone in holes]
        self.built.notes += [f"{told}: {some_of(names)}" for told, names in mends.items()]
        self._set_map(bounds, [(entry, zone) for entry, zone in zones if zone.get("forbidden_to") != []])
        if left_out := [entry.told for entry, zone in zones if zone.get("forbidden_to") == []]:
            self.built.notes.append(f"zones that are forbidden to nobody are left out: {some_of(left_out)}")

    def _seen(self, entry: Entry) -> Entry:
        has_camera = any("camera" in one for one in self.built.data.get("robots", ()))
        return seen_from(entry, self._options.survey, has_camera=has_camera, findings=self.built.findings)

    def _holes(self, entry: Entry) -> list[shapely.Polygon]:
        """The holes that a plan has beside an area."""
        assert self._frame is not None
        return [hole for one in entry.holes for hole in areas_of(one, self._frame, self.built.findings)]

    def _middle(self, entry: Entry, spatial: bool) -> list[float]:
        """Where the task over an area is, as far as it is said: in space on the ground."""
        if entry.middle is not None:
            return self._positions([entry.middle], spatial)[0]
        return [0.0] if spatial else []

    def _set_map(
        self, bounds: Sequence[tuple[Entry, list[list[float]]]], zones: Sequence[tuple[Entry, dict[str, Any]]]
    ) -> None:
        there = dict(self._base.get("map") or {})
        if not bounds and not zones:
            return
        if len(bounds) > 1 or (bounds and there):
            entry = bounds[1 if len(bounds) > 1 else 0][0]
            other = f"that of {bounds[0][0].feature.file}" if len(bounds) > 1 else "the map of the mission"
            expected = f"one boundary: {other} is there; --as NAME=zone or survey says what it is"
            self.built.findings.append(entry.feature.finding("", "a second boundary", expected))
            return
        if bounds:
            there["boundary"] = bounds[0][1]
            self._place(("map", "boundary"), bounds[0][0])
        elif not there:
            points = [one["position"] for group in _GROUPS.values() for one in self.built.data.get(group, ())]
            points += [corner for _, zone in zones for corner in corners_of(zone)]
            there["boundary"] = around(points)
            self.built.notes.append("no boundary given: a rectangle 50 m around everything is taken")
        there["zones"] = [*there.get("zones", ())]
        for entry, zone in zones:
            self._place(("map", "zones", len(there["zones"])), entry)
            there["zones"].append(zone)
        if not there["zones"]:
            del there["zones"]
        self.built.data["map"] = there

    def _add_lanes(self) -> None:
        entries = [entry for entry in self._entries if entry.role == "lane"]
        if not entries:
            return
        there = self._base.get("lanes") or {}
        ways = Ways(dict(there.get("nodes", {})), list(there.get("edges", ())))
        begin = len(ways.edges)
        for entry in entries:
            ways.add(entry, self._frame, self.built.findings)
        for k, entry in enumerate(ways.made, begin):
            self._place(("lanes", "edges", k), entry)
        if ways.doubled:
            told = some_of([f"{name} ({count})" for name, count in ways.doubled.items()])
            self.built.notes.append(f"pieces of lines along which lanes lead already are left out: {told}")
        if ways.edges:
            self.built.data["lanes"] = {"nodes": ways.nodes, "edges": ways.edges}

    # When

    def _set_start(self) -> None:
        stated = self._options.starts_at
        if stated is not None:
            self.built.data["starts_at"] = stated
            self.built.places[("starts_at",)] = "--starts-at", None
        if self.built.data.get("starts_at") is not None:
            return
        chosen, needed = chosen_start(self._entries)
        if chosen is not None:
            self.built.data["starts_at"] = chosen
            self.built.notes.append(
                f"starts_at chosen: {chosen}, the earliest time in the files; --starts-at says another"
            )
        elif needed:
            timed = next(
                entry for entry in self._entries if any(isinstance(entry.values.get(k), str | list) for k in TIMES)
            )
            expected = "--starts-at 2027-03-01T08:00, the moment at which the mission begins, beside clock times"
            self.built.findings.append(timed.feature.finding("starts_at", "missing", expected))

    def _note_next_day(self) -> None:
        starts_at = self.built.data.get("starts_at")
        if later := of_next_day(self._entries, starts_at):
            self.built.notes.append(f"begin before starts_at ({starts_at}), and are the next day's: {some_of(later)}")


_SAID_AS = {
    "name": ("id",),
    "opens": ("window", "window_s"),
    "closes": ("window", "window_s"),
    "window": ("window_s",),
    "deadline": ("deadline_s",),
    "due": ("due_s",),
    "starts": ("shift", "available_from_s"),
    "ends": ("shift", "available_until_s"),
    "door": ("id",),
    "moves": ("kind",),
    "lat": ("position",),
    "lat_lon": ("position",),
    "x": ("position",),
}
"""The keys of a mission that are said by those of entries."""
