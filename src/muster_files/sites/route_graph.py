"""Route graphs of Nav2 (GeoJSON) as lines of lanes: nodes with an id, and directed edges from one to another.

They stand in the frame of the map, in metres, whatever their `crs` says. The greatest speed on an edge is read where
its metadata state it in metres per second (`abs_speed_limit`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from muster.mission.import_ledger import Source, passed_over, read_as
from muster_files.sites.features import Feature, Geometry, refused
from muster_files.tracked_json import Tracked

_EDGE = {"startid", "endid"}
_NODE = read_as("a node of lanes")
_UNNAMED = passed_over("names an edge, and lanes need no name", minor=True)
_DRAWN = read_as("the straight line between its nodes")


def is_edge(item: object) -> bool:
    """Return whether a feature is an edge of a route graph."""
    properties = item.peek("properties") if isinstance(item, Tracked) else None
    return isinstance(properties, dict) and properties.keys() >= _EDGE


@dataclass(frozen=True)
class RouteGraph:
    """The features of a route graph.

    Parameters
    ----------
    file, line
        where the features stand: `line` is of the number of one, from 0.
    enter
        says of which feature of the site a feature of the file, with its properties, is the source.
    """

    file: str
    line: Callable[[int], int | None]
    enter: Callable[[Tracked, object, Source], None]

    def features(self, items: list[Any]) -> Iterator[Feature]:
        """Yield an edge each.

        Raises
        ------
        MissionError
            for a feature that is neither a node nor an edge, or leads to no node.
        """
        nodes = self._nodes(items)
        for k, item in enumerate(items):
            if not is_edge(item):
                continue
            properties = item.get("properties")
            ends = [self._end(nodes, k, key, properties.get(key)) for key in ("startid", "endid")]
            item.get("type")
            _member(item, "geometry").say(_DRAWN)
            properties.say(_UNNAMED, "id")
            values: dict[str, object] = {"kind": "lane", "one_way": "yes"}
            if (speed := _member(properties, "metadata").get("abs_speed_limit")) is not None:
                values["speed_mps"] = speed
            names, places = zip(*ends, strict=True)
            geometry = Geometry("line", ((places,),), names=names, in_metres=True)
            source = Source()
            self.enter(item, None, source)
            yield Feature(values, self.file, self.line(k), f"features[{k}]", geometry, source)

    def _nodes(self, items: list[Any]) -> Mapping[object, tuple[float, float]]:
        """The places of the nodes by their ids."""
        found: dict[object, tuple[float, float]] = {}
        frames: dict[object, int] = {}
        for k, item in enumerate(items):
            if is_edge(item):
                continue
            properties, geometry = _member(item, "properties"), _member(item, "geometry")
            name, place = properties.get("id"), geometry.get("coordinates")
            if not isinstance(name, str | int) or not _is_place(place):
                raise self._refused(k, "", item, "a node (a point with an id), or an edge (startid, endid)")
            if name in found:
                raise self._refused(k, "id", name, "an id that no node before has")
            frames.setdefault(properties.get("frame", "map"), k)
            geometry.say(_NODE)
            item.get("type")
            found[name] = (float(place[0]), float(place[1]))
        if len(frames) > 1:
            k = max(frames.values())
            raise self._refused(k, "frame", " and ".join(map(str, frames)), "one frame for all nodes, that of the map")
        return found

    def _end(
        self, nodes: Mapping[object, tuple[float, float]], number: int, key: str, name: object
    ) -> tuple[str, tuple[float, float]]:
        if not isinstance(name, str | int) or name not in nodes:
            raise self._refused(number, key, name, "the id of a node")
        return str(name), nodes[name]

    def _refused(self, number: int, key: str, value: object, expected: str) -> Exception:
        where = ".".join(part for part in (f"features[{number}]", "properties" if key else "", key) if part)
        return refused(self.file, self.line(number), where, "missing" if value is None else value, expected)


def _member(item: object, key: str) -> Tracked:
    """A member that is an object, marked as read; else an empty one."""
    given = item.get(key) if isinstance(item, Tracked) else None
    return given if isinstance(given, Tracked) else Tracked([])


def _is_place(given: object) -> bool:
    numbers = given[:2] if isinstance(given, list) else []
    return len(numbers) == 2 and all(
        isinstance(c, int | float) and not isinstance(c, bool) and math.isfinite(c) for c in numbers
    )
