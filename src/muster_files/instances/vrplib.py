"""VRPLIB (`.vrp`), the form of TSPLIB for vehicle routing [reinelt1991]: capacities, time windows, pickup and delivery.

Edge weights are those of TSPLIB, whole numbers, as the best plans known are counted. EUC_2D is the distance itself
where times or a longest distance are given: published plans of such instances are counted so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.model import Mission
from muster.mission.value_types import shown
from muster_files.instances.customer_missions import (
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
from muster_files.instances.keyword_files import KeywordFile, read_keyword_file
from muster_files.instances.line_fates import LineFates
from muster_files.instances.tsplib import tabled
from muster_files.instances.vrplib_fleet import (
    FLEET_SECTIONS,
    NEEDED,
    OwnVehicle,
    limits_of_all,
    own_vehicles,
    robots_for,
)
from muster_files.instances.weighted_nodes import NODE_SECTIONS, WeightedNodes, weighted_nodes
from muster_files.number_rows import Row, is_whole, node_number, read_row

TYPES = ("CVRP", "VRP", "DCVRP", "DVRP", "VRPTW", "CVRPTW", "PDPTW", "MDVRP", "MDCVRP", "MDVRPTW", *NEEDED)
_DEMAND, _DEPOT = "DEMAND_SECTION", "DEPOT_SECTION"
_WINDOW, _SERVICE, _PAIRS = "TIME_WINDOW_SECTION", "SERVICE_TIME_SECTION", "PICKUP_AND_DELIVERY_SECTION"
_SECTIONS = (*NODE_SECTIONS, _DEMAND, _DEPOT, _WINDOW, _SERVICE, _PAIRS, *FLEET_SECTIONS)
_FIELDS = {DEMAND: _DEMAND, READY: _WINDOW, DUE: _WINDOW, SERVICE: _SERVICE}
"""The sections that tell of a customer's demand and times."""
_NO_DURATION = "no longest duration beside time windows, or all of the depot's: a robot's hours are those of the clock"
_PAIR = ("number", "demand", "earliest", "latest", "service time", "pickup", "delivery")


def read_vrplib(path: FilePath, salesmen: int | None = None, fates: LineFates | None = None) -> Mission:
    """Read an instance with `salesmen` robots, or VEHICLES of the file; without both with `enough_vehicles`.

    Raises
    ------
    MissionError
        with file, line, field, value, what was expected.
    """
    file = read_keyword_file(path, "VRPLIB", fates)
    if file.value("TYPE") not in TYPES:
        raise MissionError([file.wrong("TYPE", " or ".join(TYPES))])
    file.require_known_sections(_SECTIONS)
    distance, duration = limits_of_all(file)
    limit = file.number("DISTANCE")
    timed = any(name in file.sections for name in (_WINDOW, _SERVICE, _PAIRS)) or "SERVICE_TIME" in file.head
    in_file = file.number("VEHICLES")
    own = own_vehicles(file, None if in_file is None else fleet(path, file.line("VEHICLES"), "VEHICLES", in_file, None))
    graph = weighted_nodes(file, exact=timed or bool(limit or distance or duration or own))
    depots = _depots(file, graph, own)
    everyone = _customers(file, graph, depots)
    customers = [customer for name, customer in everyone.items() if name not in depots]
    capacity = _capacity(file, customers, own)
    if own and salesmen is not None and salesmen != len(own):
        told = f"{len(own)}, as each vehicle of the file has values of its own"
        raise MissionError([Finding(str(path), None, "salesmen", str(salesmen), told)])
    count: float = enough_vehicles(customers, capacity) if in_file is None else in_file
    vehicles = fleet(path, file.line("VEHICLES"), "VEHICLES", len(own) or count, salesmen)
    robots = robot_ids(vehicles)
    if own:
        customers = [replace(one, only=robots_for(one.id, own, robots)) for one in customers]
    kind, travel, tables = tabled(file, graph, robots, depots[0])
    timed_customers = any(customer.window is not None for customer in customers)
    return instance_mission(
        Instance(
            path=path,
            name=file.value("NAME") or path.stem,
            depot=everyone[depots[0]],
            customers=customers,
            vehicles=vehicles,
            capacity=capacity,
            robot=kind | _limits(limit, timed=timed_customers) | _of_all(file, depots, everyone, distance, duration),
            mission=travel,
            tables=tables,
            own=[_robot(file, vehicle, everyone, timed=timed_customers) for vehicle in own],
            depots=[everyone[name] for name in depots[1:]],
        )
    )


def _capacity(file: KeywordFile, customers: Sequence[Customer], own: Sequence[OwnVehicle]) -> float | None:
    """What each vehicle carries; None where each has a capacity of its own, or none is needed."""
    if any(vehicle.capacity for vehicle in own):
        return None
    capacity = file.number("CAPACITY")
    if capacity is None and any(customer.demand for customer in customers):
        raise MissionError([file.wrong("CAPACITY", "what a vehicle carries")])
    return capacity


def _limits(limit: float | None, *, timed: bool) -> dict[str, Any]:
    """DISTANCE as a limit of robots: the service on the way counts [christofides1979], waiting does not."""
    if limit is None:
        return {}
    return {"work_capacity": limit} if timed else {"available_until_s": limit}


def _of_all(
    file: KeywordFile,
    depots: Sequence[str],
    everyone: Mapping[str, Customer],
    distance: float | None,
    duration: float | None,
) -> dict[str, Any]:
    """VEHICLES_MAX_DISTANCE and VEHICLES_MAX_DURATION as limits of robots."""
    found: dict[str, Any] = {} if distance is None else {"work_capacity": distance}
    if duration is None:
        return found
    windows = [window for name in depots if (window := everyone[name].window) is not None]
    if any(customer.window is not None for customer in everyone.values()):
        if not windows or any(duration < close - opens for opens, close in windows):
            raise MissionError([file.wrong("VEHICLES_MAX_DURATION", _NO_DURATION)])
        return found
    return found | {"available_until_s": duration}


def _robot(file: KeywordFile, vehicle: OwnVehicle, everyone: Mapping[str, Customer], *, timed: bool) -> dict[str, Any]:
    """The keys of a robot that a vehicle of its own has beside the common ones."""
    found: dict[str, Any] = {}
    if vehicle.depot is not None:
        depot = everyone[vehicle.depot]
        found["position"] = depot.position
        if depot.window is not None:
            found["available_from_s"], found["available_until_s"] = depot.window
    if vehicle.capacity is not None:
        found["load_capacity"] = vehicle.capacity
    if vehicle.distance is not None:
        found["work_capacity"] = vehicle.distance
    if vehicle.duration is not None and timed:
        section = "VEHICLES_MAX_DURATION_SECTION"
        value = f"{vehicle.duration:g}"
        raise MissionError([Finding(str(file.path), file.line(section), section, value, _NO_DURATION)])
    if vehicle.duration is not None:
        found["available_until_s"] = vehicle.duration
    return found


def _depots(file: KeywordFile, graph: WeightedNodes, own: Sequence[OwnVehicle]) -> list[str]:
    """The numbers of the depots' nodes; the first node where the file names none."""
    rows = [row for row in file.rows(_DEPOT) if list(row.words) != ["-1"]]
    nodes = {node.id for node in graph.nodes}
    if not rows:
        rows = [Row(0, [graph.nodes[0].id])]
    for row in rows:
        name = node_number(row.words[0])
        if name not in nodes or len(row.words) > 1:
            told = shown(" ".join(row.words))
            raise MissionError([Finding(str(file.path), row.line, _DEPOT, told, "the number of a node")])
    depots = [node_number(row.words[0]) for row in rows]
    used = [vehicle.depot for vehicle in own if vehicle.depot is not None]
    if len(depots) > 1 and not used:
        expected = "one depot, then -1; or a VEHICLES_DEPOT_SECTION that says whose each of them is"
        raise MissionError([Finding(str(file.path), rows[-1].line, _DEPOT, shown(depots[-1]), expected)])
    wrong = next((name for name in used if name not in depots), None)
    if wrong is not None:
        at = file.line("VEHICLES_DEPOT_SECTION")
        raise MissionError([Finding(str(file.path), at, "VEHICLES_DEPOT_SECTION", shown(wrong), "a depot of the file")])
    if len(depots) > 1 and graph.weights is not None:
        expected = "EUC_2D or EXACT_2D with several depots"
        raise MissionError([file.wrong("EDGE_WEIGHT_TYPE", expected)])
    return depots


def _customers(file: KeywordFile, graph: WeightedNodes, depots: Sequence[str]) -> dict[str, Customer]:
    """All nodes with what they ask for, by number."""
    if _PAIRS in file.sections:
        return _pairs(file, graph)
    demands = _by_node(file, graph, _DEMAND, ("number", "demand"))
    windows = _by_node(file, graph, _WINDOW, ("number", "earliest", "latest"))
    services = _by_node(file, graph, _SERVICE, ("number", "service time"))
    for_all = file.number("SERVICE_TIME", above=-1e-9) or 0.0
    lines = {title: {node_number(row.words[0]): row.line for row in rows} for title, rows in file.sections.items()}
    found = {}
    for node in graph.nodes:
        window = windows.get(node.id)
        found[node.id] = Customer(
            line=node.line,
            id=node.id,
            position=node.position,
            demand=demands[node.id][0] if _DEMAND in file.sections else 0.0,
            window=None if window is None else (window[0], window[1]),
            service=services[node.id][0] if services else for_all if node.id not in depots else 0.0,
            lines={name: lines[section][node.id] for name, section in _FIELDS.items() if section in lines},
        )
    return found


def _pairs(file: KeywordFile, graph: WeightedNodes) -> dict[str, Customer]:
    rows = {node_number(row.words[0]): row for row in file.rows(_PAIRS)}
    numbers = _by_node(file, graph, _PAIRS, _PAIR)
    found = {}
    for node in graph.nodes:
        values = numbers[node.id]
        pickup, delivery = map(node_number, rows[node.id].words[-2:])
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
    for row in file.rows(section):
        values = read_row(file.path, row, columns, section)
        name = node_number(row.words[0])
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
