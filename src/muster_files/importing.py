"""Files of a site as a mission."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.yaml_writer import YAML_SUFFIXES
from muster.planning.loading import load, load_noted
from muster.planning.mission_readers import converted_suffixes, reader_of

if TYPE_CHECKING:
    from muster_files.sites.site_files import SiteMission


def read_site(
    *files: str | Path,
    robots: str | Path | None = None,
    suitability: str | Path | None = None,
    columns: Mapping[str, str] | None = None,
    kinds: Mapping[str, str] | None = None,
    origin: Sequence[float] | None = None,
    starts_at: str | None = None,
    name: str | None = None,
    flat: bool = False,
    height_m: float | None = None,
    fov_deg: float | None = None,
    width_m: float | None = None,
) -> SiteMission:
    """Read the files of a site as one mission: tables (CSV, XLSX), maps (GeoJSON, KML, GeoPackage), tracks (GPX).

    A property `kind`, a word in a name, or `kinds` says what a feature is (docs/sites.md). Without them points are
    tasks and lines lanes; an area that nothing decides is an error, which names the choices.

    Parameters
    ----------
    files
        of the site; one of them may be a mission, to which the others are added.
    robots
        a file of robots, or a mission whose robots are taken.
    suitability
        a table of robot types and task types (CSV).
    columns
        headings by what they mean: `{"lat": "Breite"}`.
    kinds
        what features are by the name of their file, layer, or their own: task, robot, station, zone, boundary, survey,
        lane; air or ground for robots that fly or drive; skip for what is passed over.
    origin
        latitude and longitude in degrees of the map frame's origin, and perhaps its altitude, metres; by default the
        middle of all places.
    starts_at
        date and time at which the mission begins, for clock times.
    name
        of the mission; by default that of the first file.
    flat
        whether heights are left out.
    height_m, fov_deg, width_m
        of areas to survey that have none of their own: the height of flight, metres; the horizontal field of view of a
        camera that looks down, degrees; the width of a tool, metres.

    Returns
    -------
    The mission, and what was read, chosen and not read; `ledger` has the fate of every element of the files.

    Raises
    ------
    MissionError
        with everything that is wrong: file, line, column, value, what was expected.
    ParameterError
        if an option names what is not there, or more than one mission is given.
    MissingExtraError
        if a file needs an optional part of the installation.
    """
    from muster_files.sites.builder import SiteOptions
    from muster_files.sites.site_files import read_site as read

    if not files:
        raise ParameterError("no file given; expected one or more")
    site = [Path(file) for file in files if is_site_file(file)]
    missions = [file for file in files if not is_site_file(file)]
    if len(missions) > 1:
        raise ParameterError(f"{missions[1]}: a second mission; expected one, to which files of a site are added")
    if missions and robots is not None and not is_site_file(robots):
        raise ParameterError(f"--robots: {robots} beside {missions[0]}; expected one mission that has robots")
    team, robots_file = _team_of(robots)
    options = SiteOptions(
        columns=columns or {},
        kinds=kinds or {},
        origin=None if origin is None else tuple(origin),
        starts_at=starts_at,
        name=name,
        flat=flat,
        survey={"height_m": height_m, "fov_deg": fov_deg, "width_m": width_m},
    )
    base = None
    if missions:
        reader = reader_of(Path(missions[0]))
        takes_origin = reader is not None and "origin" in reader.flags
        base = load_noted(missions[0], origin=options.origin if takes_origin else None)
        options = replace(options, origin=None if takes_origin else options.origin)
    found = read(
        site,
        options,
        robots=robots_file,
        base=None if base is None else base.mission,
        team=team,
        suitability=None if suitability is None else Path(suitability),
    )
    if base is None:
        return found
    return replace(found, notes=(*base.notes, *found.notes), ledger=base.ledger + found.ledger)


def is_site_file(path_or_name: str | Path) -> bool:
    """Return whether a file is one of a site, and not a mission by itself."""
    return Path(path_or_name).suffix.lower() not in (*YAML_SUFFIXES, *converted_suffixes(), "")


def _team_of(robots: str | Path | None) -> tuple[Mission | None, Path | None]:
    """The mission whose robots are taken; or the file that has robots alone."""
    if robots is None:
        return None, None
    return (None, Path(robots)) if is_site_file(robots) else (load(robots), None)
