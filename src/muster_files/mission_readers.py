"""The readers of whole missions that `muster.load` finds: instance files, sites, plans of ground stations.

They load when used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from muster.mission.texts.text_files import first_lines
from muster.planning.mission_readers import MissionReader, Noted, converted_suffixes
from muster_files.qgc.plan_format import WAY_POINTS_HEAD
from muster_files.sites.readers import is_site, unknown_file

_WAY_POINTS = (".waypoints", ".wpl")
_NO_WAY_POINTS = (".yaml", ".yml", ".csv", ".plan", ".json")


def _is_tsplib(path: Path) -> bool:
    if _is_no_instance(path):
        return False
    from muster_files.instances.instance_files import TSPLIB, instance_form

    return instance_form(path) == TSPLIB


def _read_tsplib(path: Path, salesmen: int, depot: str | None = None) -> Noted:
    from muster_files.instances.line_fates import LineFates
    from muster_files.instances.tsplib import read_tsplib

    fates = LineFates()
    mission = read_tsplib(path, salesmen, "1" if depot is None else depot, fates)
    return Noted(mission, (), fates.ledger(path))


def _has_vehicles(path: Path) -> bool:
    if _is_no_instance(path):
        return False
    from muster_files.instances.instance_files import instance_form

    return callable(instance_form(path))


def _read_vehicles(path: Path, salesmen: int | None = None) -> Noted:
    from muster_files.instances.instance_files import instance_form
    from muster_files.instances.line_fates import LineFates

    reader, fates = instance_form(path), LineFates()
    assert callable(reader)  # `_has_vehicles`
    return Noted(reader(path, salesmen, fates), (), fates.ledger(path))


def _is_no_instance(path: Path) -> bool:
    return _is_site(path) or _are_plans(path) or _are_way_points(path)


def _is_site(path: Path) -> bool:
    return path.suffix.lower() not in converted_suffixes() and is_site(path)


def _read_site(
    path: Path,
    robots: str | Path | None = None,
    suitability: str | Path | None = None,
    columns: Mapping[str, str] | None = None,
) -> Noted:
    from muster_files.importing import read_site

    found = read_site(path, robots=robots, suitability=suitability, columns=columns)
    return Noted(found.mission, found.notes, found.ledger)


def _are_plans(path: Path) -> bool:
    return path.suffix.lower() == ".plan" or path.is_dir()


def _read_plans(path: Path, origin: Sequence[float] | None = None) -> Noted:
    from muster_files.qgc.reader import read_flight_plans

    return read_flight_plans(path, origin)


def _are_way_points(path: Path) -> bool:
    suffix = path.suffix.lower()
    if suffix in _NO_WAY_POINTS or not path.is_file() or _is_site(path):
        return False
    return suffix in _WAY_POINTS or first_lines(path).startswith(WAY_POINTS_HEAD)


def _read_way_points(path: Path, origin: Sequence[float] | None = None) -> Noted:
    from muster_files.qgc.wpl_reader import read_wpl

    return read_wpl(path, origin)


TSPLIB = MissionReader(
    takes=_is_tsplib,
    read=_read_tsplib,
    flags=("salesmen", "depot"),
    needed="salesmen",
    suffixes=(".tsp", ".atsp"),
)
VEHICLES = MissionReader(takes=_has_vehicles, read=_read_vehicles, flags=("salesmen",), suffixes=(".vrp", ".txt"))
SITE = MissionReader(takes=_is_site, read=_read_site, flags=("robots", "suitability", "columns"), refusal=unknown_file)
PLANS = MissionReader(takes=_are_plans, read=_read_plans, flags=("origin",), suffixes=(".plan",))
WAY_POINTS = MissionReader(takes=_are_way_points, read=_read_way_points, flags=("origin",), suffixes=_WAY_POINTS)
