"""Reading of missions from files and by the names of shipped missions."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from muster.library import mission_names, mission_path
from muster.mission.errors import Finding, MissionError, ParameterError
from muster.mission.model import Mission
from muster.mission.reading.mistaken_files import PLAN_AS_MISSION
from muster.mission.texts.near_matches import did_you_mean, near_file
from muster.mission.yaml_writer import YAML_SUFFIXES
from muster.planning.mission_readers import Noted, converted_suffixes, reader_of, refusal_of


def load(
    path_or_name: str | Path,
    *,
    robots: str | Path | None = None,
    suitability: str | Path | None = None,
    salesmen: int | None = None,
    depot: str | None = None,
    columns: Mapping[str, str] | None = None,
) -> Mission:
    """Read a mission: YAML, a file of a site, an instance file of the field, QGroundControl plans, or a shipped name.

    Files of sites are tables (CSV, XLSX), maps (GeoJSON, KML, KMZ, GeoPackage) and tracks (GPX); `read_site` reads
    several, and says what was chosen. Instance files are those of TSPLIB and VRPLIB, of Solomon [solomon1987], Gehring
    and Homberger [gehring1999], Li and Lim [li2001], and Schneider, Stenger and Goeke [schneider2014]. They are known
    by their first lines, as way points in text are (`QGC WPL 110`).

    Parameters
    ----------
    path_or_name
        a file, a folder of QGroundControl `.plan` files, or one of `muster missions`; a file of that name comes first.
    robots, suitability
        the files that go with a file of a site: robots, or a mission that has them; and a table of types (CSV).
    salesmen, depot
        how many robots, for instance files: TSPLIB needs it, the others have a number of their own; and the number of
        the node where robots start and end, for TSPLIB, 1 if None.
    columns
        headings of a site's table by what they mean: `{"lat": "Breite"}`.

    Raises
    ------
    MissionError
        with everything that is wrong: file, line, field, value, what was expected.
    ParameterError
        if a parameter is missing, or does not go with this kind of file.
    MissingExtraError
        if the file needs an optional part of the installation.
    """
    return load_noted(
        path_or_name, robots=robots, suitability=suitability, salesmen=salesmen, depot=depot, columns=columns or None
    ).mission


def load_noted(
    path_or_name: str | Path,
    *,
    robots: str | Path | None = None,
    suitability: str | Path | None = None,
    salesmen: int | None = None,
    depot: str | None = None,
    columns: Mapping[str, str] | None = None,
    origin: Sequence[float] | None = None,
) -> Noted:
    """Read a mission as `load` does, with what there is to say of how.

    `origin` is the place of the map frame's origin, for files whose own home is else: latitude and longitude in
    degrees, and perhaps metres of altitude.
    """
    path = _found(path_or_name)
    given = {
        "robots": robots,
        "suitability": suitability,
        "salesmen": salesmen,
        "depot": depot,
        "columns": columns,
        "origin": origin,
    }
    if path.suffix.lower() == ".csv" and _is_task_list(path, robots):
        return _task_list(path, path_or_name, **given)
    is_yaml = path.suffix.lower() in YAML_SUFFIXES and path.is_file()
    if not is_yaml and (reader := reader_of(path)) is not None:
        kind = next(iter(reader.suffixes), "")
        _check_flags(path_or_name, reader.flags, given, needed=reader.needed, kind=kind)
        return reader.read(path, **{name: given[name] for name in reader.flags})
    return _own(path, path_or_name, **given)


def _is_task_list(path: Path, robots: str | Path | None) -> bool:
    from muster.mission.reading.thesis_csv import is_task_list

    return is_task_list(path, None if robots is None else Path(robots))


def _task_list(path: Path, named: str | Path, **given: Any) -> Noted:
    from muster.mission.reading.thesis_csv import read_csv

    _check_flags(named, ("robots", "suitability"), given, needed="robots", kind=".csv")
    suitability = given["suitability"]
    return Noted(read_csv(path, Path(given["robots"]), None if suitability is None else Path(suitability)))


def _own(path: Path, named: str | Path, **given: Any) -> Noted:
    """Return the mission of a file in Muster's own form, YAML or JSON."""
    from muster.mission.reading.yaml_reader import read_yaml

    _check_flags(named, (), given)
    suffix = path.suffix.lower()
    if suffix == ".sol":
        raise MissionError([Finding(str(path), None, "", "a plan (.sol)", PLAN_AS_MISSION)])
    is_known = suffix in (*YAML_SUFFIXES, *_PERHAPS_YAML) or suffix in converted_suffixes()
    if not is_known and (refusal := refusal_of(path)) is not None:
        raise refusal
    return Noted(read_yaml(path))


def _found(path_or_name: str | Path) -> Path:
    path = Path(path_or_name)
    if path.is_file():
        return path
    shipped = mission_path(str(path_or_name))
    if shipped is not None:
        return shipped
    if path.exists() or _is_named_as_file(path):
        return path
    near = did_you_mean(str(path_or_name), mission_names()) or near_file(path)
    expected = f"a file, or the name of a shipped mission{near}"
    raise MissionError([Finding(str(path_or_name), None, "", "no such file or mission", expected)])


def _is_named_as_file(path: Path) -> bool:
    suffix = path.suffix.lower()
    return suffix != "" and (suffix in (*YAML_SUFFIXES, *converted_suffixes()) or reader_of(path) is not None)


_PERHAPS_YAML = (".json", "")
"""Suffixes of files that may be missions in YAML, of which JSON is a part."""
_OPTIONS = {"columns": "column"}


def _check_flags(
    named: str | Path, known: Collection[str], given: Mapping[str, object], *, needed: str = "", kind: str = ""
) -> None:
    if needed and given[needed] is None:
        raise ParameterError(f"{named}: --{needed} missing; expected with a {kind} file")
    for name, value in given.items():
        if value is not None and name not in known:
            option = _OPTIONS.get(name, name)
            raise ParameterError(f"{named}: --{option} given; expected no --{option} with this kind of mission")
