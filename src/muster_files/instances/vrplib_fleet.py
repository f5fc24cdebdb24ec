"""The vehicles of a VRPLIB file that are not all equal: depots, capacities, limits, and whom each may serve.

The sections are those of PyVRP's reader of VRPLIB: `VEHICLES_DEPOT_SECTION`, `CAPACITY_SECTION`,
`VEHICLES_ALLOWED_CLIENTS_SECTION`, `VEHICLES_MAX_DISTANCE_SECTION`, `VEHICLES_MAX_DURATION_SECTION`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from muster.mission.errors import Finding, MissionError
from muster.mission.value_types import shown
from muster_files.instances.keyword_files import KeywordFile
from muster_files.number_rows import Row, node_number, row_numbers

_DEPOTS, _CAPACITIES, _ALLOWED = "VEHICLES_DEPOT_SECTION", "CAPACITY_SECTION", "VEHICLES_ALLOWED_CLIENTS_SECTION"
_DISTANCES, _DURATIONS = "VEHICLES_MAX_DISTANCE_SECTION", "VEHICLES_MAX_DURATION_SECTION"
_DISTANCE, _DURATION = "VEHICLES_MAX_DISTANCE", "VEHICLES_MAX_DURATION"
"""Keywords with one limit for all vehicles."""
_OF_ALL = ("VEHICLES", _DISTANCE, _DURATION)
FLEET_SECTIONS = (_DEPOTS, _CAPACITIES, _ALLOWED, _DISTANCES, _DURATIONS)
NEEDED = {"SDVRP": _ALLOWED, "SDVRPTW": _ALLOWED, "HFVRP": _CAPACITIES, "HFVRPTW": _CAPACITIES, "HVRP": _CAPACITIES}
"""Types of files with the section without which they are something else: SDVRP may be split deliveries."""


@dataclass(frozen=True)
class OwnVehicle:
    """What one vehicle has of its own: the number of its depot's node, its capacity, its limits, its customers."""

    depot: str | None = None
    capacity: float | None = None
    distance: float | None = None
    duration: float | None = None
    customers: frozenset[str] | None = field(default=None)


def own_vehicles(file: KeywordFile, count: int | None) -> list[OwnVehicle]:
    """Return what vehicles have of their own, in the order of their numbers; empty where all are equal.

    Parameters
    ----------
    count
        how many there are, if the file says so.

    Raises
    ------
    MissionError
        unless each section has a line for each vehicle.
    """
    kind = file.value("TYPE") or ""
    needed = NEEDED.get(kind)
    if needed is not None and needed not in file.sections:
        raise MissionError([Finding(str(file.path), file.line("TYPE"), "TYPE", kind, f"a {needed} in such a file")])
    depots, capacities = _column(file, _DEPOTS, count), _column(file, _CAPACITIES, count)
    distances, durations = _column(file, _DISTANCES, count), _column(file, _DURATIONS, count)
    allowed = _rows(file, _ALLOWED, count)
    number = max(map(len, (depots, capacities, distances, durations, allowed)))
    return [
        OwnVehicle(
            node_number(depots[k].words[1]) if depots else None,
            _amount(file, _CAPACITIES, capacities[k]) if capacities else None,
            _amount(file, _DISTANCES, distances[k]) if distances else None,
            _amount(file, _DURATIONS, durations[k]) if durations else None,
            frozenset(map(node_number, allowed[k].words[1:])) - {"-1"} if allowed else None,
        )
        for k in range(number)
    ]


def limits_of_all(file: KeywordFile) -> tuple[float | None, float | None]:
    """Return the longest distance and the longest duration that the head states for all vehicles.

    Raises
    ------
    MissionError
        for another keyword of vehicles, which may change what is asked.
    """
    other = next((key for key in file.head if key.startswith("VEHICLE") and key not in _OF_ALL), None)
    if other is not None:
        raise MissionError([Finding(str(file.path), file.line(other), other, "not supported", ", ".join(_OF_ALL))])
    return file.number(_DISTANCE), file.number(_DURATION)


def _column(file: KeywordFile, section: str, count: int | None) -> list[Row]:
    rows = _rows(file, section, count)
    for row in rows:
        if len(row.words) != 2:
            raise _wrong(file, section, row, "the number of a vehicle, and one number")
    return rows


def _rows(file: KeywordFile, section: str, count: int | None) -> list[Row]:
    """The rows of a section by the numbers of vehicles, which begin with 1; empty where there is no such section."""
    rows = [row for row in file.rows(section) if list(row.words) != ["-1"]]
    if not rows:
        return []
    expected = f"a line for each vehicle, from 1 to {len(rows) if count is None else count}"
    numbers = [node_number(row.words[0]) for row in rows]
    wrong = next((k for k, number in enumerate(numbers) if number != str(k + 1)), None)
    if wrong is not None:
        raise _wrong(file, section, rows[wrong], expected)
    if count is not None and len(rows) != count:
        told = f"{len(rows)} lines"
        raise MissionError([Finding(str(file.path), file.line(section), section, told, expected)])
    return rows


def _amount(file: KeywordFile, section: str, row: Row) -> float:
    found = row_numbers(row.words[1:])
    if found is None or not found[0] > 0:
        raise _wrong(file, section, row, "the number of a vehicle, and a finite number above 0")
    return found[0]


def _wrong(file: KeywordFile, section: str, row: Row, expected: str) -> MissionError:
    return MissionError([Finding(str(file.path), row.line, section, shown(" ".join(row.words)), expected)])


def robots_for(customer: str, vehicles: Sequence[OwnVehicle], robots: Sequence[str]) -> tuple[str, ...] | None:
    """Return the robots that may serve a customer; None where all may."""
    if not any(vehicle.customers is not None for vehicle in vehicles):
        return None
    return tuple(
        robot
        for robot, vehicle in zip(robots, vehicles, strict=True)
        if vehicle.customers is None or customer in vehicle.customers
    )
