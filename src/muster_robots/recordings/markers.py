"""The scene of a mission as ROS markers for RViz, converted from `record.scene`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from muster.report.record.json_messages import MAP_FRAME, body_frame
from muster_robots.ros2.message_types import (
    SHAPES,
    ColorRGBA,
    Header,
    Marker,
    Point,
    Pose,
    Quaternion,
    Time,
    Vector3,
)

_LINE_M = 0.05
_TEXT_M = 0.3
Entity = Mapping[str, Any]


class Markers:
    """Markers with constant numbers: a changed one replaces the old one.

    Parameters
    ----------
    names
        of robots in ROS, by id.
    """

    def __init__(self, names: Mapping[str, str]) -> None:
        self._frames = {body_frame(robot): body_frame(name) for robot, name in names.items()}
        self._numbers: dict[tuple[str, int], int] = {}

    def of(self, entities: Iterable[Entity], stamp_s: float) -> tuple[Marker, ...]:
        """The markers of entities of a foxglove.SceneUpdate."""
        return tuple(marker for entity in entities for marker in self._of_entity(entity, stamp_s))

    def _of_entity(self, entity: Entity, stamp_s: float) -> Iterator[Marker]:
        frame = self._frames.get(entity["frame_id"], MAP_FRAME)
        header = Header(stamp=Time.of(stamp_s), frame_id=frame)
        for k, shape in enumerate(_shapes(entity)):
            number = self._numbers.setdefault((entity["id"], k), len(self._numbers))
            yield replace(shape, header=header, ns=entity["id"].split("/")[0], id=number, frame_locked=True)


def _shapes(entity: Entity) -> Iterator[Marker]:
    for solids, word in (("spheres", "SPHERE"), ("cylinders", "CYLINDER")):
        for solid in entity[solids]:
            size = Vector3(**solid["size"])
            yield Marker(type=SHAPES[word], pose=_pose(solid["pose"]), scale=size, color=ColorRGBA(**solid["color"]))
    for line in entity["lines"]:
        points = [Point(**point) for point in line["points"]]
        closed = points + points[:1] if line["type"] == 1 else points
        width = Vector3(x=_LINE_M)
        yield Marker(type=SHAPES["LINE_STRIP"], scale=width, color=ColorRGBA(**line["color"]), points=tuple(closed))
    for text in entity["texts"]:
        height, color = Vector3(z=_TEXT_M), ColorRGBA(**text["color"])
        kind, place = SHAPES["TEXT_VIEW_FACING"], _pose(text["pose"])
        yield Marker(type=kind, pose=place, scale=height, color=color, text=text["text"])


def _pose(pose: Mapping[str, Any]) -> Pose:
    return Pose(Point(**pose["position"]), Quaternion(**pose["orientation"]))
