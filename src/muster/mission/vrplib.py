"""VRPLIB (`.vrp`), the form of TSPLIB for vehicle routing [reinelt1991]: capacities, time windows, pickup and delivery.

Edge weights are those of TSPLIB, whole numbers, as the best plans known are counted. EUC_2D is the distance itself
where times or a longest distance are given: published plans of such instances are counted so.
"""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

from muster.mission.customer_missions import (
    DEMAND,
    DUE,
    READY,
    SERVICE,
    Customer,
    Instance,
    enough_vehicles,
    fleet,
    instance_mission,
    robot_ids,
)
from muster.mission.errors import Finding, MissionError
from muster.mission.keyword_files import KeywordFile, read_keyword_file
from muster.mission.model import Mission
from muster.mission.number_rows import is_whole, read_row
from muster.mission.tsplib import tabled
from muster.mission.value_types import shown
from muster.mission.weighted_nodes import NODE_SECTIONS, WeightedNodes, weighted_nodes

TYPES = ("CVRP", "VRP", "DCVRP", "DVRP", "VRPTW", "CVRPTW", "PDPTW")
_DEMAND, _DEPOT = "DEMAND_SECTION", "DEPOT_SECTION"
_WINDOW, _SERVICE, _PAIRS = "TIME_WINDOW_SECTION", "SERVICE_TIME_SECTION", "PICKUP_AND_DELIVERY_SECTION"
_SECTIONS = (*NODE_SECTIONS, _DEMAND, _DEPOT, _WINDOW, _SERVICE, _PAIRS)
_FIELDS = {DEMAND: _DEMAND, READY: _WINDOW, DUE: _WINDOW, SERVICE: _SERVICE}
"""The sections that tell of a customer's demand and times."""
_PAIR = ("number", "demand", "earliest", "latest", "service time", "pickup", "delivery")


def read_vrplib(path: FilePath, salesmen: int | None = None) -> Mission:
    """Read an instance with `salesmen` robots, or VEHICLES of the file; without both with `enough_vehicles`.

    Raises
    ------
    MissionError
        with file, line, field, value, what was expected.
    """
    file = read_keyword_file(path, "VRPLIB")
    if file.value("TYPE") not in TYPES:
        raise MissionError([file.wrong("TYPE", " or ".join(TYPES))])
    file.require_known_sections(_SECTIONS)
    limit = file.number("DISTANCE")
    timed = any(name in file.sections for name in (_WINDOW, _SERVICE, _PAIRS)) or "SERVICE_TIME" in file.head
    graph = weighted_nodes(file, exact=timed or limit is not None)
    everyone = _customers(file, graph)
    depot = everyone[_depot(file, graph)]
    customers = [customer for customer in everyone.values() if customer is not depot]
    capacity = file.number("CAPACITY")
    if capacity is None and any(customer.demand for customer in customers):
        raise MissionError([file.wrong("CAPACITY", "what a vehicle carries")])
    in_file = file.number("VEHICLES")
    count = enough_vehicles(customers, capacity) if in_file is None else in_file
    vehicles = fleet(path, file.line("VEHICLES"), "VEHICLES", count, salesmen)
    kind, travel, tables = tabled(file, graph, robot_ids(vehicles), depot.id)
    return instance_mission(
        Instance(
            path=path,
            name=file.value("NAME") or path.stem,
            depot=depot,
            customers=customers,
            vehicles=vehicles,
            capacity=capacity,
            robot=kind | _limits(limit, customers),
            mission=travel,
            tables=tables,
        )
    )


def _limits(limit: float | None, customers: list[Customer]) -> dict[str, Any]:
    """DISTANCE as a limit of robots: the service on the way counts [christofides1979], waiting does not."""
    if limit is None:
        return {}
    if any(customer.window is not None for customer in customers):
        return {"work_capacity": limit}
    return {"available_until_s": limit}


def _depot(file: KeywordFile, graph: WeightedNodes) -> str:
    """The number of the depot's node; the first one where the file names none."""
    rows = [row for row in file.sections.get(_DEPOT, ()) if row.words != ["-1"]]
    if not rows:
        return graph.nodes[0].id
    name = rows[0].words[0]
    if len(rows) > 1 or len(rows[0].words) > 1:
        at = rows[-1]
        raise MissionError([Finding(str(file.path), at.line, _DEPOT, shown(" ".join(at.words)), "one depot, then -1")])
    if name not in [node.id for node in graph.nodes]:
        raise MissionError([Finding(str(file.path), rows[0].line, _DEPOT, shown(name), "the number of a node")])
    return name


def _customers(file: KeywordFile, graph: WeightedNodes) -> dict[str, Customer]:
    """All nodes with what they ask for, by number."""
    if _PAIRS in file.sections:
        return _pairs(file, graph)
    demands = _by_node(file, graph, _DEMAND, ("number", "demand"))
    windows = _by_node(file, graph, _WINDOW, ("number", "earliest", "latest"))
    services = _by_node(file, graph, _SERVICE, ("number", "service time"))
    for_all = file.number("SERVICE_TIME", above=-1e-9) or 0.0
    depot = _depot(file, graph)
    lines = {title: {row.words[0]: row.line for row in rows} for title, rows in file.sections.items()}
    found = {}
    for node in graph.nodes:
        window = windows.get(node.id)
        found[node.id] = Customer(
            line=node.line,
            id=node.id,
            position=node.position,
            demand=demands[node.id][0] if _DEMAND in file.sections else 0.0,
            window=None if window is None else (window[0], window[1]),
            service=services[node.id][0] if services else for_all if node.id != depot else 0.0,
            lines={name: lines[section][node.id] for name, section in _FIELDS.items() if section in lines},
        )
    return found


def _pairs(file: KeywordFile, graph: WeightedNodes) -> dict[str, Customer]:
    rows = {row.words[0]: row for row in file.sections[_PAIRS]}
    numbers = _by_node(file, graph, _PAIRS, _PAIR)
    found = {}
    for node in graph.nodes:
        values = numbers[node.id]
        pickup, delivery = rows[node.id].words[-2:]
        window = values[1], values[2]
        found[node.id] = Customer(
            rows[node.id].line, node.id, node.position, values[0], window, values[3], pickup, delivery
        )
    return found


def _by_node(file: KeywordFile, graph: WeightedNodes, section: str, columns: tuple[str, ...]) -> dict[str, list[float]]:
    """The numbers of each node in a section; empty where the file has no such section."""
    if section not in file.sections:
        return {}
    ids = {node.id for node in graph.nodes}
    found: dict[str, list[float]] = {}
    for row in file.sections[section]:
        values = read_row(file.path, row, columns, section)
        name = row.words[0]
        if not is_whole(name) or name not in ids:
            raise MissionError([Finding(str(file.path), row.line, section, shown(name), "the number of a node")])
        if name in found:
            value = f"node {name} for the second time"
            raise MissionError([Finding(str(file.path), row.line, section, value, "each node once")])
        found[name] = values[1:]
    missing = [node.id for node in graph.nodes if node.id not in found]
    if missing:
        value, line = f"no line for node {missing[0]}", file.line(section)
        raise MissionError(
            [Finding(str(file.path), line, section, value, f"a line for each node: {', '.join(columns)}")]
        )
    return found
