"""TSPLIB (`.tsp`, EUC_2D) as closed multiple-salesmen missions.

Distances stay real-valued: TSPLIB's rounding to whole numbers is not applied. The depot's node is where all robots
start and return to; every other node is a task whose id is the node's number.
"""

from __future__ import annotations

import math
from pathlib import Path as FilePath

from muster.mission.csv_files import number
from muster.mission.errors import Finding, MissionError
from muster.mission.from_data import mission_from
from muster.mission.model import SCHEMA, Mission
from muster.mission.source import Place, Source
from muster.mission.text_files import read_text
from muster.mission.value_types import Fault, Path, shown

_MOST_SALESMEN = 100_000
_NEEDED = {"TYPE": "TSP", "EDGE_WEIGHT_TYPE": "EUC_2D"}


def read_tsplib(path: FilePath, salesmen: int, depot: str = "1") -> Mission:
    """Read a TSPLIB instance as a mission of `salesmen` robots `r_0`, `r_1`, ... that start and end at `depot`.

    Raises
    ------
    MissionError
        with every finding: file, line, field, value, what was expected.
    """
    faults: list[Fault] = []
    places: dict[Path, Place] = {}
    head, nodes = _parts(path)
    found = _head_findings(path, head, len(nodes))
    if nodes and depot not in [node for _, node, _ in nodes]:
        found.append(Finding(str(path), None, "depot", shown(depot), "the number of a node"))
    if not 1 <= salesmen <= _MOST_SALESMEN:
        found.append(Finding(str(path), None, "salesmen", str(salesmen), f"a whole number from 1 to {_MOST_SALESMEN}"))
    if found:
        raise MissionError(found)
    start = next(position for _, node, position in nodes if node == depot)
    tasks = [(line, node, position) for line, node, position in nodes if node != depot]
    places |= {("tasks", k): (str(path), line) for k, (line, _, _) in enumerate(tasks)}
    data = {
        "schema": SCHEMA,
        "name": f"{head.get('NAME', (0, path.stem))[1]}-{salesmen}",
        "rules": {"return_to_start": True},
        "robots": [{"id": f"r_{k}", "position": start} for k in range(salesmen)],
        "tasks": [{"id": node, "position": position} for _, node, position in tasks],
    }
    return mission_from(data, Source(str(path), places), faults)


def _parts(path: FilePath) -> tuple[dict[str, tuple[int, str]], list[tuple[int, str, list[object]]]]:
    """The head (keyword to line and value) and the nodes (line, number, coordinates)."""
    head: dict[str, tuple[int, str]] = {}
    nodes: list[tuple[int, str, list[object]]] = []
    seen: set[str] = set()
    in_nodes = False
    for line, text in enumerate(read_text(path).splitlines(), 1):
        words = text.split()
        if not words or words == ["EOF"]:
            continue
        if in_nodes and words[0][0].isdigit():
            x_y = [number(word) for word in words[1:]]
            if len(x_y) != 2 or not all(isinstance(value, float) and math.isfinite(value) for value in x_y):
                raise _refusal(path, line, shown(text.strip()), "number, x, y")
            if words[0] in seen:
                raise _refusal(path, line, f"node {words[0]} for the second time", "each node once")
            seen.add(words[0])
            nodes.append((line, words[0], x_y))
        elif words == ["NODE_COORD_SECTION"]:
            in_nodes = True
        elif ":" in text:
            keyword, _, value = text.partition(":")
            head[keyword.strip().upper()] = (line, value.strip())
        elif not in_nodes and words[0].isdigit():
            raise _refusal(path, line, "missing", "this line before the first node")
        else:
            raise MissionError(
                [Finding(str(path), line, "", shown(text.strip()), "TSPLIB: KEYWORD : value, or a node")]
            )
    return head, nodes


def _refusal(path: FilePath, line: int, value: str, expected: str) -> MissionError:
    return MissionError([Finding(str(path), line, "NODE_COORD_SECTION", value, expected)])


def _head_findings(path: FilePath, head: dict[str, tuple[int, str]], nodes: int) -> list[Finding]:
    found = [
        Finding(str(path), head.get(keyword, (None, ""))[0], keyword, head.get(keyword, (0, "missing"))[1], value)
        for keyword, value in _NEEDED.items()
        if head.get(keyword, (0, ""))[1] != value
    ]
    if not nodes:
        return [*found, Finding(str(path), None, "NODE_COORD_SECTION", "missing", "a line for each node: number, x, y")]
    line, dimension = head.get("DIMENSION", (None, "missing"))
    if dimension != str(nodes):
        found.append(Finding(str(path), line, "DIMENSION", dimension, f"{nodes}, the number of nodes in the file"))
    return found


def write_tsplib(mission: Mission, path: FilePath) -> None:
    """Write a closed multiple-salesmen mission as TSPLIB, the depot as node 1.

    Raises
    ------
    MissionError
        if the mission is more than salesmen who start at one place, visit plain places and return.
    """
    start = mission.robots[0].position
    tasks = [{"id": str(k), "position": t.position} for k, t in enumerate(mission.tasks, 2)]
    robots = [{"id": f"r_{k}", "position": start} for k in range(len(mission.robots))]
    data = {"name": mission.name, "rules": {"return_to_start": True}, "robots": robots, "tasks": tasks}
    if mission.dimensions == 3 or mission_from(data, mission.source, []) != mission:
        value = "more than TSPLIB can say"
        raise MissionError([Finding(mission.source.file, None, "", value, "salesmen, one depot, plain tasks in 2-D")])
    nodes = [start, *(t.position for t in mission.tasks)]
    name = mission.name.removesuffix(f"-{len(mission.robots)}")
    lines = [f"NAME : {name}", "TYPE : TSP", f"DIMENSION : {len(nodes)}", "EDGE_WEIGHT_TYPE : EUC_2D"]
    lines += ["NODE_COORD_SECTION", *(f"{k} {x!r} {y!r}" for k, (x, y) in enumerate(nodes, 1)), "EOF"]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
