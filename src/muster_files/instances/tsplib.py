"""TSPLIB (`.tsp`, `.atsp`) [reinelt1991] as closed multiple-salesmen missions.

EUC_2D is the straight distance, without TSPLIB's rounding to whole numbers, as in studies of several salesmen. All
other types of edge weights become a travel table: lengths are those of TSPLIB. The depot's node is where all robots
start and return to; every other node is a task whose id is the node's number.
"""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.model import SCHEMA, Mission
from muster.mission.reading.from_data import mission_from
from muster.mission.site import TravelTable
from muster.mission.source import Place, Source
from muster.mission.value_types import Path, shown
from muster_files.instances.keyword_files import KeywordFile, read_keyword_file
from muster_files.instances.line_fates import LineFates
from muster_files.instances.weighted_nodes import NODE_SECTIONS, WeightedNodes, weighted_nodes
from muster_files.number_rows import node_number

MOST_SALESMEN = 100_000
TABLED_TYPE = "vehicle"
"""The type of robots whose travel is by the table of an instance."""
_TYPES = ("TSP", "ATSP")


def read_tsplib(path: FilePath, salesmen: int, depot: str = "1", fates: LineFates | None = None) -> Mission:
    """Read a TSPLIB instance as a mission of `salesmen` robots `r_0`, `r_1`, ... that start and end at `depot`.

    Raises
    ------
    MissionError
        with every finding: file, line, field, value, what was expected.
    """
    file, depot = read_keyword_file(path, fates=fates), node_number(depot)
    found = [] if file.value("TYPE") in _TYPES else [file.wrong("TYPE", " or ".join(_TYPES))]
    graph: WeightedNodes | None = None
    try:
        file.require_known_sections(NODE_SECTIONS)
        graph = weighted_nodes(file, exact=True)
    except MissionError as error:
        found += error.findings
    if graph is not None and depot not in [node.id for node in graph.nodes]:
        found.append(Finding(str(path), None, "depot", shown(depot), "the number of a node"))
    if not 1 <= salesmen <= MOST_SALESMEN:
        found.append(Finding(str(path), None, "salesmen", str(salesmen), f"a whole number from 1 to {MOST_SALESMEN}"))
    if found or graph is None:
        raise MissionError(found)
    return _mission(file, graph, salesmen, depot)


def _mission(file: KeywordFile, graph: WeightedNodes, salesmen: int, depot: str) -> Mission:
    start = next(node.position for node in graph.nodes if node.id == depot)
    tasks = [node for node in graph.nodes if node.id != depot]
    robots = [f"r_{k}" for k in range(salesmen)]
    kind, rules, tables = tabled(file, graph, robots, depot)
    data = {
        "schema": SCHEMA,
        "name": f"{file.value('NAME') or file.path.stem}-{salesmen}",
        **rules,
        "robots": [{"id": name, "position": start, **kind} for name in robots],
        "tasks": [{"id": node.id, "position": node.position} for node in tasks],
    }
    data["rules"] = {"return_to_start": True, **rules.get("rules", {})}
    places: dict[Path, Place] = {("tasks", k): (str(file.path), node.line) for k, node in enumerate(tasks)}
    return mission_from(data, Source(str(file.path), places), [], tables)


def tabled(
    file: KeywordFile, graph: WeightedNodes, robots: list[str], depot: str
) -> tuple[dict[str, Any], dict[str, Any], dict[str, TravelTable]]:
    """What robots, and what the mission, say of travel by the weights of a file; and the table.

    All are empty where travel is straight.
    """
    if graph.weights is None:
        return {}, {}, {}
    rules = {"rules": {"travel": "matrix"}, "travel": {TABLED_TYPE: file.path.name}}
    return {"type": TABLED_TYPE}, rules, {TABLED_TYPE: graph.travel_table(robots, depot)}
