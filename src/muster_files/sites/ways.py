"""The lines of a site as lanes: a node at each of their points, shared by the lines that have it."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from muster.mission.errors import Finding
from muster_files.sites.entries import Entry
from muster_files.sites.frame import Frame

_OWN = ("width_m", "speed_mps", "capacity")
_SAME_M = 0.01
"""Points that are no farther apart are one node."""


@dataclass
class Ways:
    """Lanes as they are gathered, those of a mission to which they are added included."""

    nodes: dict[str, Any] = field(default_factory=dict)
    edges: list[dict[str, Any]] = field(default_factory=list)
    made: list[Entry] = field(default_factory=list)
    """For each edge that was added, the entry that it is of."""
    doubled: Counter[str] = field(default_factory=Counter)
    """How many pieces of each entry were left out, as lanes lead there already."""
    _near: dict[tuple[int, int], list[str]] = field(default_factory=dict)
    """Nodes by the square, of `_SAME_M`, in which they are."""
    _driven: set[tuple[str, str]] = field(default_factory=set)

    def __post_init__(self) -> None:
        for name, place in self.nodes.items():
            if isinstance(place, list) and len(place) == 2 and all(isinstance(c, int | float) for c in place):
                self._near.setdefault(_square(place), []).append(name)
        self._driven |= {way for edge in self.edges for way in _directions(edge)}

    def add(self, entry: Entry, frame: Frame | None, findings: list[Finding]) -> None:
        """Add the lines of an entry; where a lane leads already in a direction no second one is made."""
        assert entry.geometry is not None
        given = [[place[:2] for place in piece[0]] for piece in entry.geometry.pieces]
        if entry.geometry.in_metres:
            lines = [[list(place) for place in line] for line in given]
        else:
            assert frame is not None, "of places in degrees"
            lines = [frame.metres(line) for line in given]
        called = entry.geometry.names or [""] * max(map(len, lines), default=0)
        names = [[self._node(point, name) for point, name in zip(line, called, strict=False)] for line in lines]
        ends = [(a, b) for line in names for a, b in itertools.pairwise(line) if a != b]
        both = entry.values.get("both_ways", not entry.values.get("one_way", False))
        if "both_ways" in entry.values and "one_way" in entry.values:
            findings.append(entry.finding("one_way", entry.values["one_way"], "it or both_ways, not both"))
        own = {key: entry.values[key] for key in _OWN if key in entry.values}
        own |= {"both_ways": True} if both else {}
        door = entry.values.get("door")
        for k, (a, b) in enumerate(ends, 1):
            new = [way for way in _directions({"from": a, "to": b, **own}) if way not in self._driven]
            if not new:
                self.doubled[entry.told] += 1
                continue
            edge = {"from": new[0][0], "to": new[0][1], **own}
            if both and len(new) == 1:
                del edge["both_ways"]  # the other direction is there
            if door is not None:
                edge["id"] = door if len(ends) == 1 else f"{door}-{k}"
            self._driven |= set(new)
            self.edges.append(edge)
            self.made.append(entry)

    def _node(self, point: Sequence[float], called: str) -> str:
        """The node at a point; a new one has the name that the point has, if no other is called so."""
        column, row = _square(point)
        for square in itertools.product((column, column - 1, column + 1), (row, row - 1, row + 1)):
            for name in self._near.get(square, ()):
                if math.dist(self.nodes[name], point[:2]) <= _SAME_M:
                    return name
        number, name = len(self.nodes) + 1, called
        while not name or name in self.nodes:
            name, number = f"n{number}", number + 1
        self.nodes[name] = list(point[:2])
        self._near.setdefault((column, row), []).append(name)
        return name


def _square(place: Sequence[float]) -> tuple[int, int]:
    return math.floor(place[0] / _SAME_M), math.floor(place[1] / _SAME_M)


def _directions(edge: dict[str, Any]) -> Iterable[tuple[Any, Any]]:
    there = (edge.get("from"), edge.get("to"))
    return [there, there[::-1]] if edge.get("both_ways") else [there]
