"""Converts plain data (from YAML, CSV, TSPLIB) to a Mission, and reports all errors at once.

A value that is wrong is set aside and the rest is still checked, so that a misspelt speed does not hide an unknown
prerequisite three tasks later.
"""

from __future__ import annotations

from collections.abc import Mapping

from muster.mission.areas.parts import with_parts
from muster.mission.areas.task_areas import put_in_positions
from muster.mission.consistency.all_rules import inconsistencies
from muster.mission.errors import MissionError
from muster.mission.model import Mission
from muster.mission.reading.circles import circles_to_polygons
from muster.mission.reading.degrees import degrees_to_metres, in_degrees
from muster.mission.reading.travel_csv import read_travel_tables
from muster.mission.records import Record, findings
from muster.mission.site import TravelTable
from muster.mission.source import Source
from muster.mission.value_types import Fault, Path
from muster.mission.values.clock_times import clock_times_to_seconds
from muster.mission.values.energy import energy_to_batteries


def mission_from(
    data: object, source: Source, faults: list[Fault], tables: Mapping[str, TravelTable] | None = None
) -> Mission:
    """The mission that plain data describes.

    Parameters
    ----------
    data
        a mapping with the keys of `Mission`; within it places in degrees are replaced by metres, circles by polygons,
        clock times by seconds, and endurance and range by batteries.
    source
        where the values came from; files named in the data are found from the folder of its file.
    faults
        what was wrong with the form of the file already.
    tables
        the travel tables that the data names; without them they are read from their files.

    Raises
    ------
    MissionError
        with `faults` and everything else that was found.
    MissingExtraError
        if places are in degrees and pymap3d is not installed.
    """
    places = degrees_to_metres(data, faults)
    circles_to_polygons(data, faults)
    clock_times_to_seconds(data, faults)
    energy_to_batteries(data, faults)
    put_in_positions(data)
    mission: Mission = Record(Mission, "a mission").read(data, (), faults)
    object.__setattr__(mission, "source", source)
    if mission.travel_rule == "matrix" and mission.travel:
        read = tables or read_travel_tables(mission.travel, source, faults, *_places(mission))
        object.__setattr__(mission, "travel_tables", read)
    # Where a value is known to be wrong a filler stands in its place: nothing more is said of it.
    wrong = {fault.path for fault in faults}
    around = {start for path in wrong for start in _prefixes(path)}
    faults.extend(
        fault
        for fault in (in_degrees(found, places) for found in inconsistencies(mission))
        if fault.path not in around and wrong.isdisjoint(_prefixes(fault.path)) and not _in_doubt(fault, wrong)
    )
    if faults:
        raise MissionError(findings(faults, source))
    for name, value in with_parts(mission).items():
        object.__setattr__(mission, name, value)
    return mission


def _places(mission: Mission) -> tuple[list[str], set[str]]:
    """The ids of robots; and those of tasks and stations."""
    others = {place.id for places in (mission.tasks, mission.stations) for place in places}
    return [robot.id for robot in mission.robots], others


def _in_doubt(fault: Fault, wrong: set[Path]) -> bool:
    """Whether an id was looked for among ids of which one is wrong: that may be the one that was meant."""
    group = fault.relies_on
    return bool(group) and any(path[:1] == (group,) and (len(path) < 3 or path[2] == "id") for path in wrong)


def _prefixes(path: Path) -> list[Path]:
    return [path[:length] for length in range(len(path) + 1)]
