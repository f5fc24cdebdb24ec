"""Vehicle routing with several depots or kinds of vehicles in the layout of Cordeau and others [cordeau1997].

The first line is `type m n t`; then `t` lines of the longest duration and the load, then a line for each node: number,
x, y, service, demand, frequency, combinations and their list, and a time window where the type has windows. With
several depots (types 2 and 6) these are the last `t` nodes, and each has `m` vehicles. With kinds of vehicles (3 and 7)
there are `m` of each, and a customer's combinations are the kinds that may serve it. Periods of days are refused.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.model import Mission
from muster.mission.texts.text_files import read_text
from muster_files.instances.customer_missions import Customer, Instance, fleet, instance_mission, robot_ids
from muster_files.instances.line_fates import LineFates
from muster_files.number_rows import Row, is_whole, node_number, read_row, row_numbers, text_rows

_HEAD = ("type", "number of vehicles", "number of customers", "number of depots or kinds of vehicles")
_LIMITS = ("longest duration", "load")
_NODE = ("number", "x", "y", "service", "demand", "frequency", "combinations")
_VRP, _MDVRP, _SDVRP, _VRPTW, _MDVRPTW, _SDVRPTW = 0, 2, 3, 4, 6, 7
_TIMED = (_VRPTW, _MDVRPTW, _SDVRPTW)
_KNOWN = (_VRP, _MDVRP, _SDVRP, *_TIMED)
_DEPOTS, _KINDS = (_MDVRP, _MDVRPTW), (_SDVRP, _SDVRPTW)


def looks_like_cordeau(rows: Sequence[Row]) -> bool:
    """Whether the first lines are those of such a file: four whole numbers, limits of two, a node."""
    if not rows or len(rows[0].words) != len(_HEAD) or not all(map(is_whole, rows[0].words)):
        return False
    kinds = int(rows[0].words[3])
    limits, nodes = rows[1 : 1 + kinds], rows[1 + kinds : 2 + kinds]
    return kinds > 0 and all(len(row.words) == 2 for row in limits) and all(len(row.words) > 4 for row in nodes)


def read_cordeau(path: FilePath, salesmen: int | None = None, fates: LineFates | None = None) -> Mission:
    """Read an instance with the vehicles that it says.

    Raises
    ------
    MissionError
        with file, line, field, value, what was expected.
    """
    rows = text_rows(read_text(path))
    kind, of_each, number, kinds = (int(value) for value in read_row(path, rows[0], _HEAD))
    if kind not in _KNOWN:
        expected = f"one of {', '.join(map(str, _KNOWN))}: no periods of days"
        raise MissionError([Finding(str(path), rows[0].line, "type", str(kind), expected)])
    limits = rows[1 : 1 + kinds]
    nodes = rows[1 + kinds :]
    expected_nodes = number + (kinds if kind in _DEPOTS else 1)
    if len(nodes) != expected_nodes:
        told = f"{len(nodes)} nodes"
        raise MissionError([Finding(str(path), rows[0].line, _HEAD[2], told, f"{expected_nodes} with the depots")])
    (fates or LineFates()).read("head", rows[: 1 + kinds])
    (fates or LineFates()).read("node", nodes)
    everyone = [_node(path, row, timed=kind in _TIMED) for row in nodes]
    depots = [one for one, _ in (everyone[number:] if kind in _DEPOTS else everyone[:1])]
    served = everyone[:number] if kind in _DEPOTS else everyone[1:]
    vehicles = fleet(path, rows[0].line, _HEAD[1], of_each * (kinds if kind in (*_DEPOTS, *_KINDS) else 1), None)
    if salesmen not in (None, vehicles):
        raise MissionError([Finding(str(path), None, "salesmen", str(salesmen), f"{vehicles}, as the file says")])
    robots = robot_ids(vehicles)
    own = [_robot(path, limits, depots, k // of_each, timed=kind in _TIMED) for k in range(vehicles)]
    return instance_mission(
        Instance(
            path=path,
            name=path.stem,
            depot=depots[0],
            customers=[_with_robots(path, one, row, robots, of_each, kinds) for one, row in served],
            vehicles=vehicles,
            capacity=None,
            own=own,
            depots=depots[1:],
        )
    )


def _node(path: FilePath, row: Row, *, timed: bool) -> tuple[Customer, Row]:
    """A customer or depot, with its row."""
    values = row_numbers(row.words)
    lists = int(values[6]) if values is not None and len(values) > 6 and values[6] >= 0 else 0
    if values is None or not is_whole(row.words[0]) or len(values) != len(_NODE) + lists + (2 if timed else 0):
        told, columns = " ".join(row.words), ", ".join((*_NODE, "their list", *(("opens", "closes") if timed else ())))
        raise MissionError([Finding(str(path), row.line, "node", told, columns)])
    window = (values[-2], values[-1]) if timed else None
    number = node_number(row.words[0])
    return Customer(row.line, number, (values[1], values[2]), values[4], window, values[3]), row


def _with_robots(path: FilePath, one: Customer, row: Row, robots: Sequence[str], of_each: int, kinds: int) -> Customer:
    """A customer with the robots that may serve it, where not all depots or kinds of vehicles may."""
    values = [float(word) for word in row.words]
    if values[5] not in (0, 1):
        raise MissionError([Finding(str(path), row.line, "frequency", f"{values[5]:g}", "1: one visit")])
    codes = [int(value) for value in values[7 : 7 + int(values[6])]]
    allowed = [k for k in range(kinds) if any(code >> (kinds - 1 - k) & 1 for code in codes)]
    if len(robots) == of_each or not codes or len(allowed) == kinds:
        return one
    return replace(one, only=tuple(robots[k * of_each + j] for k in allowed for j in range(of_each)))


def _robot(
    path: FilePath, rows: Sequence[Row], depots: Sequence[Customer], k: int, *, timed: bool
) -> Mapping[str, Any]:
    """The keys of the vehicles of a depot, or of a kind; `rows` are the lines of limits."""
    row, depot = rows[min(k, len(rows) - 1)], depots[min(k, len(depots) - 1)]
    duration, load = read_row(path, row, _LIMITS, "limits")
    found: dict[str, Any] = {"position": depot.position}
    if load:
        found["load_capacity"] = load
    if depot.window is not None:
        found["available_from_s"], found["available_until_s"] = depot.window
    if duration and timed and depot.window is not None and duration < depot.window[1] - depot.window[0]:
        expected = "0, or the depot's whole window: a robot's hours are those of the clock"
        raise MissionError([Finding(str(path), row.line, _LIMITS[0], f"{duration:g}", expected)])
    if duration and not timed:
        found["available_until_s"] = duration
    return found
