"""Files of a site as one mission: tables, maps and tracks, with a mission to which they are added."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.import_ledger import Ledger
from muster.mission.model import Mission
from muster.mission.reading.from_data import mission_from
from muster.mission.reading.thesis_csv import suitability_table
from muster.mission.source import Source
from muster.mission.system.garbage import collector_paused
from muster.mission.texts.counting import counted
from muster.mission.yaml_writer import file_data
from muster_files.sites.builder import Builder, SiteOptions
from muster_files.sites.decisions import BY, LINE, POINT
from muster_files.sites.entries import Entry, entries_of, some_of
from muster_files.sites.features import Layer, refused
from muster_files.sites.headings import given_columns
from muster_files.sites.identities import identified
from muster_files.sites.keys import CIRCLE
from muster_files.sites.plan_areas import joined_areas
from muster_files.sites.readers import reader_of
from muster_files.sites.robot_kinds import with_kind
from muster_files.sites.roles import Roles
from muster_files.sites.site_ledger import ledger_of, left_out
from muster_files.sites.times import require_alike

_FROM_TEAM = ("robots", "origin_wgs84", "starts_at")
_ROBOTS = "a sheet or file of robots whose name says so (robots.csv), or --robots FILE of the command"


@dataclass(frozen=True)
class SiteMission:
    """A mission made of files, and what there is to say of how, one line each.

    Parameters
    ----------
    counts
        what was read from each file.
    notes
        what was chosen, and what was not read.
    ledger
        what became of every element of the files.
    """

    mission: Mission
    counts: tuple[str, ...]
    notes: tuple[str, ...]
    ledger: Ledger = Ledger()


@collector_paused()
def read_site(
    files: Sequence[Path],
    options: SiteOptions,
    *,
    robots: Path | None = None,
    base: Mission | None = None,
    team: Mission | None = None,
    suitability: Path | None = None,
) -> SiteMission:
    """The mission of one or more files of a site.

    Parameters
    ----------
    robots
        a file of which every point is a robot.
    base
        a mission to which the site is added.
    team
        a mission whose robots the mission has, with their origin and start; not beside `base`.
    suitability
        a table of robot types and task types (CSV).

    Raises
    ------
    MissionError
        with everything that is wrong: file, line, column, value, what was expected.
    ParameterError
        if an option names what none of the files has.
    MissingExtraError
        if a file needs an optional part of the installation.
    """
    layers = [(layer, None) for file in files for layer in reader_of(file)(file)]
    found: list[tuple[Layer, str | None]] = [*layers]
    if robots is not None:
        found += [(layer, "robot") for layer in reader_of(robots)(robots)]
    entries, notes, decided = _entries(found, options)
    there = _there(base, team)
    main = base.source.file if base is not None else str(files[0] if files else robots)
    if not there.get("robots") and not any(entry.role == "robot" for entry in entries):
        raise refused(main, None, "robots", "missing", _ROBOTS)
    builder = Builder(entries, there, options, is_new=base is None)
    builder.built.data["name"] = Path(main).stem if base is None else base.name
    built = builder.build()
    data = built.data
    data.setdefault("tasks", [])
    if suitability is not None:
        data["suitability"] = suitability_table(suitability, built.places)
    source = Source(main, built.places, built.fields)
    mission = mission_from(data, source, [], base.travel_tables if base is not None else None)
    left_out(entries, data, flat=options.flat)
    ledger = ledger_of([layer for layer, _ in found])
    return SiteMission(mission, _counts(found, builder.read), (*notes, *built.notes, *decided), ledger)


def _entries(
    layers: Sequence[tuple[Layer, str | None]], options: SiteOptions
) -> tuple[list[Entry], list[str], list[str]]:
    """The entries of all layers, what there is to say of how they were read, and what words decided of them."""
    whole = [layer for layer, _ in layers]
    roles = Roles.of(options.kinds)
    roles.require_used(whole)
    columns = given_columns(options.columns, whole)
    findings: list[Finding] = []
    notes: list[str] = []
    entries: list[Entry] = []
    decided: list[str] = []
    for layer, default in layers:
        read = entries_of(layer, roles, default, columns, findings, notes)
        found = [with_kind(entry, layer, roles) for entry in read]
        require_alike(found, findings)
        entries += identified(layer, found, columns, notes)
        decided += _decisions(layer, entries[len(entries) - len(found) :])
    entries = joined_areas(entries)
    if findings:
        raise MissionError(sorted(findings, key=lambda finding: (finding.file, finding.line or 0)))
    if whole and not entries:
        raise refused(whole[0].file, None, "", "nothing to read", "points, areas or lines")
    return entries, notes, decided


def _decisions(layer: Layer, entries: Sequence[Entry]) -> list[str]:
    """What words, or no words, decided of the features of a layer, one line for each role and reason."""
    groups: dict[tuple[str, str], list[str]] = {}
    for entry in entries:
        if entry.reason.startswith(BY) or entry.reason in (POINT, LINE):
            groups.setdefault((entry.role, entry.reason), []).append(entry.told)
    return [f"{layer.title}: {some_of(names)}: {_NOUNS[role][0]}, {reason}" for (role, reason), names in groups.items()]


def _there(base: Mission | None, team: Mission | None) -> dict[str, Any]:
    """The data of the mission to which the site is added."""
    if base is not None:
        return file_data(base)
    if team is None:
        return {}
    found = {key: value for key, value in file_data(team).items() if key in _FROM_TEAM}
    return found | ({"rules": {"usage": team.rules.usage}} if team.rules.usage != "distance" else {})


def _counts(layers: Sequence[tuple[Layer, str | None]], entries: Sequence[Entry]) -> tuple[str, ...]:
    """For each file what was read from it."""
    lines = []
    for file in dict.fromkeys(layer.file for layer, _ in layers):
        roles = [entry.role for entry in entries if entry.feature.file == file and entry.role != "route"]
        told = [counted(roles.count(role), *_NOUNS[role]) for role in dict.fromkeys(roles)]
        lines.append(f"{file}: {', '.join(told) or 'nothing'}")
    return tuple(lines)


_NOUNS: Mapping[str, tuple[str, ...]] = {
    "task": ("task",),
    "robot": ("robot",),
    "station": ("station",),
    "zone": ("zone",),
    "boundary": ("boundary", "boundaries"),
    "survey": ("area to survey", "areas to survey"),
    "lane": ("line of lanes", "lines of lanes"),
    CIRCLE: ("round zone",),
}
