"""Travel tables: CSV with place ids in the first line and column; the cell is the distance from row to column.

A file of TSPLIB or VRPLIB is a travel table too, of the weights of its edges.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path as FilePath

from muster.mission.csv_files import number, read_table
from muster.mission.errors import Finding, MissionError
from muster.mission.keyword_files import is_keyword_file, read_keyword_file
from muster.mission.site import TravelTable
from muster.mission.source import Source
from muster.mission.value_types import Fault, shown


def read_travel_tables(
    files: Mapping[str, str],
    source: Source,
    faults: list[Fault],
    robots: Sequence[str] = (),
    others: Collection[str] = (),
) -> dict[str, TravelTable]:
    """The travel table of each robot type; `files` are found from the folder of the mission's file.

    A cell is metres, or `inf` where there is no way. `robots` and `others`, tasks and stations, are the places of the
    mission, which a file of TSPLIB or VRPLIB does not tell apart. What is wrong is appended to `faults`.
    """
    tables: dict[str, TravelTable] = {}
    for kind, name in files.items():
        path = FilePath(source.file).parent / name
        try:
            if is_keyword_file(path):
                tables[kind] = _table_of_instance(path, robots, others)
            else:
                tables[kind] = read_travel_table(path)
        except MissionError as error:
            faults.extend(
                Fault(("travel", kind), f"{finding.place}: {finding.value}", finding.expected)
                for finding in error.findings
            )
    return tables


def _table_of_instance(path: FilePath, robots: Sequence[str], others: Collection[str]) -> TravelTable:
    """The table of an instance file, in which robots start at the one node that is neither task nor station."""
    from muster.mission.weighted_nodes import weighted_nodes  # NumPy is not loaded for other missions

    nodes = weighted_nodes(read_keyword_file(path), exact=False)
    depots = [node.id for node in nodes.nodes if node.id not in others]
    if len(depots) != 1 or nodes.weights is None:
        value = f"{len(depots)} nodes that are no tasks of the mission"
        raise MissionError([Finding(str(path), None, "", value, "one, where the robots start")])
    return nodes.travel_table(robots, depots[0])


def read_travel_table(path: FilePath) -> TravelTable:
    """One travel table.

    Raises
    ------
    MissionError
        if the file cannot be read or is not a square table of numbers.
    """
    columns, rows = read_table(path)
    names = [name for _, name, _ in rows]
    for k, name in enumerate(columns):
        if name in columns[:k]:
            raise _refusal(path, 1, f"column {name} for the second time", "each place once")
        if name not in names:
            raise _refusal(path, 1, f"column {name} and no such row", "the same places in rows and columns")
    for (line, name, _), column in zip_longest(rows, columns):
        if name != column:
            expected = "no more rows than columns" if column is None else f"row {column}, as the columns are ordered"
            raise _refusal(path, line, f"row {name}", expected)
    for line, name, cells in rows:
        for column, cell in zip(columns, cells, strict=True):
            if not isinstance(number(cell), float):
                raise _refusal(path, line, f"{shown(cell)} from {name} to {column}", "metres, or inf")
    return TravelTable(tuple(names), tuple(tuple(float(cell) for cell in cells) for _, _, cells in rows))


def _refusal(path: FilePath, line: int, value: str, expected: str) -> MissionError:
    return MissionError([Finding(str(path), line, "", value, expected)])
