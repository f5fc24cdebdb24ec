"""Given lanes: a graph of places and ways between them on which robots drive, as the lane graphs of fleets have it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Any

from muster.mission.place_types import Place
from muster.mission.records import Checked, Record, record, spec
from muster.mission.site import Point
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import Fault, Flag, Many, Number, Path, Table, Text, Whole, shown


@record
class Lane(Checked):
    """A straight way from one node to another."""

    start: str = spec(Text(), "name of the node where it begins", key="from")
    end: str = spec(Text(), "name of the node where it ends", key="to")
    id: str | None = spec(Text(), "what events call it", default=None)
    both_ways: bool = spec(Flag(), "whether robots drive it backwards as well", default=False)
    capacity: int | None = spec(
        Whole(minimum=1), "how many robots may be on it at once, between its nodes; as many as fit", default=None
    )
    speed_mps: float | None = spec(Number(above=0), "the greatest speed on it", default=None)
    width_m: float | None = spec(Number(above=0), "its width; wider robots do not drive it", default=None)

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        if values["start"] == values["end"]:
            yield Fault(("to",), shown(values["end"]), "the name of another node than from")

    def directions(self) -> list[tuple[str, str]]:
        """The nodes from which and to which it leads."""
        there = (self.start, self.end)
        return [there, there[::-1]] if self.both_ways else [there]


@record
class Lanes(Checked):
    """Nodes by name, and the lanes between them."""

    nodes: Mapping[str, Point] = spec(
        Table(Place(planar=True), "a mapping from names to places [x, y]"), "where lanes begin, meet and end"
    )
    edges: tuple[Lane, ...] = spec(Many(Record(Lane, "a lane"), minimum=1), "the lanes")

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        yield from _unknown_nodes(values["nodes"], values["edges"])
        yield from _one_place(values["nodes"])
        yield from _repeated(values["edges"])

    @cached_property
    def farthest_m(self) -> float:
        """The greatest coordinate of its nodes, signs aside."""
        return max(abs(c) for place in self.nodes.values() for c in place)


def _unknown_nodes(nodes: Mapping[str, Point], edges: tuple[Lane, ...]) -> Iterator[Fault]:
    for k, lane in enumerate(edges):
        for key, name in (("from", lane.start), ("to", lane.end)):
            if name not in nodes:
                yield Fault(("edges", k, key), shown(name), f"the name of a node{did_you_mean(name, nodes)}")


def _one_place(nodes: Mapping[str, Point]) -> Iterator[Fault]:
    first: dict[Point, str] = {}
    for name, place in nodes.items():
        if first.setdefault(place, name) != name:
            yield Fault(("nodes", name), shown(list(place)), f"a place of its own: node {first[place]} is there")


def _repeated(edges: tuple[Lane, ...]) -> Iterator[Fault]:
    """Lanes with the id of another, or that lead where another does."""
    ids: dict[str, int] = {}
    ways: dict[tuple[str, str], int] = {}
    for k, lane in enumerate(edges):
        at: Path = ("edges", k)
        if lane.id is not None and ids.setdefault(lane.id, k) != k:
            yield Fault((*at, "id"), shown(lane.id), f"an id of its own: edges[{ids[lane.id]}] has this one")
        same = [ways.setdefault(way, k) for way in lane.directions()]
        if (first := min(same)) != k:
            value = f"a lane from {lane.start} to {lane.end}"
            yield Fault(at, value, f"one lane in each direction: edges[{first}] leads there as well")
