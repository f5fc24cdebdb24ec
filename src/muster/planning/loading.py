"""Reading of missions from files and by the names of shipped missions."""

from __future__ import annotations

from pathlib import Path

from muster.library import mission_names, mission_path
from muster.mission.errors import Finding, MissionError, ParameterError
from muster.mission.model import Mission
from muster.mission.near_matches import did_you_mean


def load(
    path_or_name: str | Path,
    *,
    robots: str | Path | None = None,
    suitability: str | Path | None = None,
    salesmen: int | None = None,
    depot: str | None = None,
) -> Mission:
    """Read a mission: YAML, a task-list CSV, an instance file of the field, QGroundControl plans, or a shipped name.

    Instance files are those of TSPLIB and VRPLIB, of Solomon [solomon1987], Gehring and Homberger [gehring1999], Li and
    Lim [li2001], and Schneider, Stenger and Goeke [schneider2014]. They are known by their first lines.

    Parameters
    ----------
    path_or_name
        a file, a folder of QGroundControl `.plan` files, or one of `muster missions`; a file of that name comes first.
    robots, suitability
        the CSV files that go with a task-list CSV.
    salesmen, depot
        how many robots, for instance files: TSPLIB needs it, the others have a number of their own; and the number of
        the node where robots start and end, for TSPLIB, 1 if None.

    Raises
    ------
    MissionError
        with everything that is wrong: file, line, field, value, what was expected.
    ParameterError
        if a parameter is missing, or does not go with this kind of file.
    """
    from muster.mission.instance_files import TSPLIB, instance_form

    path = _found(path_or_name)
    suffix, form = path.suffix.lower(), instance_form(path)
    kind = suffix if form is None else _TSPLIB if form == TSPLIB else _VEHICLES
    _check_flags(path_or_name, kind, robots=robots, suitability=suitability, salesmen=salesmen, depot=depot)
    if suffix == ".csv":
        from muster.mission.thesis_csv import read_csv

        return read_csv(path, Path(str(robots)), None if suitability is None else Path(suitability))
    if form == TSPLIB:
        from muster.mission.tsplib import read_tsplib

        return read_tsplib(path, salesmen or 0, "1" if depot is None else depot)
    if callable(form):
        return form(path, salesmen)
    if suffix == ".plan" or path.is_dir():
        from muster.exchange.qgc_reader import read_plan_files

        return read_plan_files(path)
    from muster.mission.yaml_reader import read_yaml

    return read_yaml(path)


def _found(path_or_name: str | Path) -> Path:
    path = Path(path_or_name)
    shipped = mission_path(str(path_or_name))
    named_as_file = path.suffix.lower() in _SUFFIXES
    if path.is_file() or (shipped is None and (path.exists() or named_as_file)):
        return path
    if shipped is None:
        expected = f"a file, or the name of a shipped mission{did_you_mean(str(path_or_name), mission_names())}"
        raise MissionError([Finding(str(path_or_name), None, "", "no such file or mission", expected)])
    return shipped


_SUFFIXES = (".yaml", ".yml", ".csv", ".tsp", ".atsp", ".vrp", ".txt", ".plan")
_TSPLIB, _VEHICLES = ".tsp", "vehicles"
_FLAGS = {".csv": ("robots", "suitability"), _TSPLIB: ("salesmen", "depot"), _VEHICLES: ("salesmen",)}
_NEEDED_FLAGS = {".csv": "robots", _TSPLIB: "salesmen"}


def _check_flags(named: str | Path, kind: str, **given: object) -> None:
    needed = _NEEDED_FLAGS.get(kind)
    if needed is not None and given[needed] is None:
        raise ParameterError(f"{named}: --{needed} missing; expected with a {kind} file")
    for name, value in given.items():
        if value is not None and name not in _FLAGS.get(kind, ()):
            raise ParameterError(f"{named}: --{name} given; expected no --{name} with this kind of mission")
