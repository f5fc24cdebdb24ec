"""The lines of a site as lanes: a node at each of their points, shared by the lines that have it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from muster.exchange.sites.entries import Entry
from muster.exchange.sites.frame import Frame
from muster.mission.errors import Finding

_OWN = ("width_m", "speed_mps", "capacity")
_DECIMALS = 2
"""Points that are the same to a centimetre are one node."""


@dataclass
class Ways:
    """Lanes as they are gathered, those of a mission to which they are added included."""

    nodes: dict[str, Any] = field(default_factory=dict)
    edges: list[dict[str, Any]] = field(default_factory=list)
    made: list[Entry] = field(default_factory=list)
    """For each edge that was added, the entry that it is of."""
    _at: dict[tuple[float, float], str] = field(default_factory=dict)
    _driven: set[tuple[str, str]] = field(default_factory=set)

    def __post_init__(self) -> None:
        for name, place in self.nodes.items():
            if isinstance(place, list) and len(place) == 2 and all(isinstance(c, int | float) for c in place):
                self._at.setdefault((round(place[0], _DECIMALS), round(place[1], _DECIMALS)), name)
        self._driven |= {way for edge in self.edges for way in _directions(edge)}

    def add(self, entry: Entry, frame: Frame, findings: list[Finding]) -> None:
        """Add the lines of an entry; where a lane leads already no second one is made."""
        assert entry.geometry is not None
        lines = [frame.metres([place[:2] for place in piece[0]]) for piece in entry.geometry.pieces]
        names = [[self._node(point) for point in line] for line in lines]
        ends = [(a, b) for line in names for a, b in pairwise(line) if a != b]
        both = entry.values.get("both_ways", not entry.values.get("one_way", False))
        if "both_ways" in entry.values and "one_way" in entry.values:
            findings.append(entry.finding("one_way", entry.values["one_way"], "it or both_ways, not both"))
        own = {key: entry.values[key] for key in _OWN if key in entry.values}
        own |= {"both_ways": True} if both else {}
        door = entry.values.get("door")
        for k, (a, b) in enumerate(ends, 1):
            edge = {"from": a, "to": b, **own}
            if not self._driven.isdisjoint(_directions(edge)):
                continue
            if door is not None:
                edge["id"] = door if len(ends) == 1 else f"{door}-{k}"
            self._driven |= set(_directions(edge))
            self.edges.append(edge)
            self.made.append(entry)

    def _node(self, point: Sequence[float]) -> str:
        place = (round(point[0], _DECIMALS), round(point[1], _DECIMALS))
        if place not in self._at:
            number = len(self.nodes) + 1
            while (name := f"n{number}") in self.nodes:
                number += 1
            self.nodes[name] = list(point[:2])
            self._at[place] = name
        return self._at[place]


def _directions(edge: dict[str, Any]) -> Iterable[tuple[Any, Any]]:
    there = (edge.get("from"), edge.get("to"))
    return [there, there[::-1]] if edge.get("both_ways") else [there]
