"""The nodes of a TSPLIB or VRPLIB file, and the weights between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import Finding, MissionError
from muster.mission.site import Point, TravelTable
from muster.mission.value_types import shown
from muster.mission.values.arrays import Floats
from muster_files.instances.edge_weights import COORDINATES, EXPLICIT, LAYOUTS, matrix_of, numbers_in, weights_of
from muster_files.instances.keyword_files import KeywordFile
from muster_files.number_rows import is_whole, node_number, read_row, row_numbers

NODE_SECTIONS = ("NODE_COORD_SECTION", "EDGE_WEIGHT_SECTION", "DISPLAY_DATA_SECTION")
_MOST_TABLED = 5_000
_COLUMNS = ("number", "x", "y", "z")
_EXACT = "EXACT_2D"
"""The distance itself, in any type of file."""
_TYPES = (*COORDINATES, _EXACT, EXPLICIT)


@dataclass(frozen=True)
class Node:
    """A node: the line of the file where it is, None where it has none; its number; its place."""

    line: int | None
    id: str
    position: Point


@dataclass(frozen=True)
class WeightedNodes:
    """Nodes; and the weights between them, None where these are the straight distances of the places."""

    nodes: Sequence[Node]
    weights: Floats | None

    def travel_table(self, robots: Sequence[str], depot: str) -> TravelTable:
        """The weights as a travel table of all nodes but the depot, and of robots that start at the depot."""
        assert self.weights is not None
        ids = [node.id for node in self.nodes]
        others = [k for k, name in enumerate(ids) if name != depot]
        order = [*others, ids.index(depot)]
        same: dict[float, float] = {}
        rows = []
        for row in self.weights[np.ix_(order, order)]:
            cells = [same.setdefault(value, value) for value in row.tolist()]  # each number is held once
            rows.append((*cells[:-1], *cells[-1:] * len(robots)))
        places = (*(ids[k] for k in others), *robots)
        return TravelTable(places, (*rows[:-1], *rows[-1:] * len(robots)))


def weighted_nodes(file: KeywordFile, *, exact: bool) -> WeightedNodes:
    """The nodes of a file.

    A file of a matrix alone has no places: the nodes stand on a circle, for pictures.

    Parameters
    ----------
    exact
        whether EUC_2D is the distance itself, not its nearest whole number.

    Raises
    ------
    MissionError
        with everything that is wrong with its type of weights, its dimension or its nodes.
    """
    kind = file.value("EDGE_WEIGHT_TYPE")
    if kind not in _TYPES:
        raise MissionError([file.wrong("EDGE_WEIGHT_TYPE", " or ".join(_TYPES))])
    if kind == EXPLICIT:
        return _explicit(file)
    nodes = _places(file, "NODE_COORD_SECTION", 2 if kind == _EXACT else COORDINATES[kind])
    _require_dimension(file, len(nodes))
    if kind == _EXACT or (exact and kind == "EUC_2D"):
        return WeightedNodes(nodes, None)
    _require_room(file, len(nodes))
    weights = weights_of(kind, np.array([node.position for node in nodes]))
    if not np.isfinite(weights).all():
        expected = f"coordinates for which {kind} is a finite number"
        raise MissionError([Finding(str(file.path), None, "NODE_COORD_SECTION", "numbers too large", expected)])
    return WeightedNodes(nodes, weights)


def _explicit(file: KeywordFile) -> WeightedNodes:
    layout = file.value("EDGE_WEIGHT_FORMAT")
    dimension = file.value("DIMENSION") or ""
    found = []
    if layout not in LAYOUTS:
        found.append(file.wrong("EDGE_WEIGHT_FORMAT", " or ".join(LAYOUTS)))
    if not is_whole(dimension) or int(dimension) < 1:
        found.append(file.wrong("DIMENSION", "the number of nodes"))
    if "EDGE_WEIGHT_SECTION" not in file.sections:
        found.append(Finding(str(file.path), None, "EDGE_WEIGHT_SECTION", "missing", "the weights of edges"))
    if found:
        raise MissionError(found)
    assert layout is not None
    n = int(dimension)
    _require_room(file, n)
    weights = matrix_of(layout, n, _matrix_numbers(file, numbers_in(layout, n), f"{layout} of {n} nodes"))
    section = next((name for name in ("NODE_COORD_SECTION", "DISPLAY_DATA_SECTION") if file.sections.get(name)), None)
    if section is None:
        turn = 2 * math.pi / n
        radius = float(weights.mean()) or 1.0
        return WeightedNodes([Node(None, str(k + 1), _on_circle(k * turn, radius)) for k in range(n)], weights)
    nodes = _places(file, section, 3 if (file.value("NODE_COORD_TYPE") or "").startswith("THREED") else 2)
    _require_dimension(file, len(nodes))
    return WeightedNodes(nodes, weights)


def _on_circle(angle: float, radius: float) -> Point:
    return round(radius * math.cos(angle), 3), round(radius * math.sin(angle), 3)


def _matrix_numbers(file: KeywordFile, count: int, what: str) -> Floats:
    found: list[float] = []
    for row in file.rows("EDGE_WEIGHT_SECTION"):
        values = row_numbers(row.words)
        if values is None or min(values) < 0:
            wrong = next(word for word in row.words if (one := row_numbers([word])) is None or one[0] < 0)
            expected = "finite numbers of at least 0"
            raise MissionError([Finding(str(file.path), row.line, "EDGE_WEIGHT_SECTION", shown(wrong), expected)])
        found += values
    if len(found) != count:
        line, value = file.line("EDGE_WEIGHT_SECTION"), f"{len(found)} numbers"
        raise MissionError([Finding(str(file.path), line, "EDGE_WEIGHT_SECTION", value, f"{count}, a {what}")])
    return np.array(found)


def _places(file: KeywordFile, section: str, coordinates: int) -> list[Node]:
    columns = _COLUMNS[: coordinates + 1]
    nodes: list[Node] = []
    seen: set[str] = set()
    for row in file.rows(section):
        name = node_number(row.words[0])
        values = read_row(file.path, row, columns, section)
        if not is_whole(name):
            raise MissionError([Finding(str(file.path), row.line, section, shown(name), "the number of a node")])
        if name in seen:
            value = f"node {name} for the second time"
            raise MissionError([Finding(str(file.path), row.line, section, value, "each node once")])
        seen.add(name)
        nodes.append(Node(row.line, name, tuple(values[1:])))
    if not nodes:
        expected = f"a line for each node: {', '.join(columns)}"
        raise MissionError([Finding(str(file.path), file.line(section), section, "missing", expected)])
    return nodes


def _require_dimension(file: KeywordFile, count: int) -> None:
    if file.value("DIMENSION") != str(count):
        raise MissionError([file.wrong("DIMENSION", f"{count}, the number of nodes in the file")])


def _require_room(file: KeywordFile, count: int) -> None:
    if count > _MOST_TABLED:
        expected = f"at most {_MOST_TABLED} nodes, of which a travel table is made"
        raise MissionError([Finding(str(file.path), file.line("DIMENSION"), "DIMENSION", str(count), expected)])
