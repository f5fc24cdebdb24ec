"""Reading of missions from files and by the names of shipped missions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from muster.library import mission_names, mission_path
from muster.mission.errors import Finding, MissionError, ParameterError
from muster.mission.import_ledger import Ledger, summary_lines
from muster.mission.line_fates import LineFates
from muster.mission.model import Mission
from muster.mission.near_matches import did_you_mean, near_file
from muster.mission.swapped import PLAN_AS_MISSION

if TYPE_CHECKING:
    from muster.exchange.flight_missions import ReadFlights


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


@dataclass(frozen=True)
class Noted:
    """A mission, and what its reader has chosen or not read, one line each.

    The ledger has the fate of every element of the files; it is empty for missions of Muster's own form, of which every
    key is read or refused.
    """

    mission: Mission
    notes: tuple[str, ...] = ()
    ledger: Ledger = Ledger()

    @property
    def said(self) -> tuple[str, ...]:
        """All there is to say of how the mission was read: the notes, and what of the ledger no note says."""
        return *self.notes, *summary_lines(self.ledger)


def load_noted(
    path_or_name: str | Path,
    *,
    robots: str | Path | None = None,
    suitability: str | Path | None = None,
    salesmen: int | None = None,
    depot: str | None = None,
    columns: Mapping[str, str] | None = None,
) -> Noted:
    """Read a mission as `load` does, with what there is to say of how."""
    from muster.mission.instance_files import TSPLIB, WAY_POINTS, instance_form

    path = _found(path_or_name)
    suffix, is_site = path.suffix.lower(), _is_site(path)
    form = None if is_site else instance_form(path)
    kind = _kind(path, None if robots is None else Path(robots), form, is_site=is_site)
    given = {"robots": robots, "suitability": suitability, "salesmen": salesmen, "depot": depot, "columns": columns}
    _check_flags(path_or_name, kind, **given)
    if kind == _SITE:
        return _site(path, robots, None if suitability is None else Path(suitability), columns or {})
    if kind == _TASK_LIST:
        from muster.mission.thesis_csv import read_csv

        return Noted(read_csv(path, Path(str(robots)), None if suitability is None else Path(suitability)))
    if suffix == ".sol":
        raise MissionError([Finding(str(path), None, "", "a plan (.sol)", PLAN_AS_MISSION)])
    fates = LineFates()
    if form == TSPLIB:
        from muster.mission.tsplib import read_tsplib

        mission = read_tsplib(path, salesmen or 0, "1" if depot is None else depot, fates)
        return Noted(mission, (), fates.ledger(path))
    if callable(form):
        return Noted(form(path, salesmen, fates), (), fates.ledger(path))
    if form == WAY_POINTS:
        from muster.exchange.wpl_reader import read_wpl

        return _of_flights(read_wpl(path))
    if suffix == ".plan" or path.is_dir():
        from muster.exchange.qgc_reader import read_flight_plans

        return _of_flights(read_flight_plans(path))
    if suffix not in _OTHERS and suffix not in _SUFFIXES:
        from muster.exchange.sites.readers import unknown_file

        raise unknown_file(path)
    from muster.mission.yaml_reader import read_yaml

    return Noted(read_yaml(path))


def _of_flights(found: ReadFlights) -> Noted:
    return Noted(found.mission, found.notes, found.ledger)


def _site(path: Path, robots: str | Path | None, suitability: Path | None, columns: Mapping[str, str]) -> Noted:
    from muster.exchange.sites.builder import SiteOptions
    from muster.exchange.sites.site_files import read_site

    team, of_robots = team_of(robots)
    found = read_site([path], SiteOptions(columns=columns), robots=of_robots, team=team, suitability=suitability)
    return Noted(found.mission, found.notes, found.ledger)


def team_of(robots: str | Path | None) -> tuple[Mission | None, Path | None]:
    """The mission whose robots are taken; or the file that has robots alone."""
    if robots is None:
        return None, None
    return (None, Path(robots)) if is_site_file(robots) else (load(robots), None)


def is_site_file(path_or_name: str | Path) -> bool:
    """Whether a file is one of a site, and not a mission by itself."""
    return _is_site(Path(path_or_name)) or Path(path_or_name).suffix.lower() not in (*_SUFFIXES, "")


def _is_site(path: Path) -> bool:
    if path.suffix.lower() in _SUFFIXES:
        return False
    from muster.exchange.sites.readers import is_site

    return is_site(path)


def _kind(path: Path, robots: Path | None, form: object, *, is_site: bool) -> str:
    """What kind of file it is, as its flags are known by."""
    from muster.mission.instance_files import TSPLIB, WAY_POINTS

    if form is not None:
        return {TSPLIB: _TSPLIB, WAY_POINTS: ".waypoints"}.get(str(form), _VEHICLES)
    suffix = path.suffix.lower()
    if is_site and suffix == _TASK_LIST:
        from muster.mission.thesis_csv import is_task_list

        return _TASK_LIST if is_task_list(path, robots) else _SITE
    return _SITE if is_site else suffix


def _found(path_or_name: str | Path) -> Path:
    path = Path(path_or_name)
    shipped = mission_path(str(path_or_name))
    named_as_file = path.suffix.lower() in _SUFFIXES or (shipped is None and path.suffix != "" and _is_site(path))
    if path.is_file() or (shipped is None and (path.exists() or named_as_file)):
        return path
    if shipped is None:
        near = did_you_mean(str(path_or_name), mission_names()) or near_file(path)
        expected = f"a file, or the name of a shipped mission{near}"
        raise MissionError([Finding(str(path_or_name), None, "", "no such file or mission", expected)])
    return shipped


CONVERTED = (".tsp", ".atsp", ".vrp", ".txt", ".plan", ".waypoints", ".wpl")
"""Suffixes of missions of other programs."""
_SUFFIXES = (".yaml", ".yml", *CONVERTED)
"""Suffixes of missions by themselves."""
_OTHERS = (".json", "")
"""Suffixes of files that may be missions in YAML, of which JSON is a part."""
_TASK_LIST, _SITE, _TSPLIB, _VEHICLES = ".csv", "site", ".tsp", "vehicles"
_FLAGS = {
    _TASK_LIST: ("robots", "suitability"),
    _SITE: ("robots", "suitability", "columns"),
    _TSPLIB: ("salesmen", "depot"),
    _VEHICLES: ("salesmen",),
}
_NEEDED_FLAGS = {_TASK_LIST: "robots", _TSPLIB: "salesmen"}
_OPTIONS = {"columns": "column"}


def _check_flags(named: str | Path, kind: str, **given: object) -> None:
    needed = _NEEDED_FLAGS.get(kind)
    if needed is not None and given[needed] is None:
        raise ParameterError(f"{named}: --{needed} missing; expected with a {kind} file")
    for name, value in given.items():
        if value is not None and name not in _FLAGS.get(kind, ()):
            option = _OPTIONS.get(name, name)
            raise ParameterError(f"{named}: --{option} given; expected no --{option} with this kind of mission")
