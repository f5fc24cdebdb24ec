"""Map files of ROS: the YAML of map_server and of nav2_map_server that stands beside an image.

Keys that ROS does not know are passed over, as ROS passes over them. `mode` is trinary where it is absent.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from muster.mission.errors import MissionError
from muster.mission.reading.yaml_reader import parse_data
from muster.mission.records import Checked, Record, findings, record, spec, specified
from muster.mission.texts.text_files import read_text
from muster.mission.value_types import INVALID, Choice, Fault, JsonSchema, Number, Text, shown
from muster.mission.value_types import Path as KeyPath
from muster.motion.grid import Bools, Grid


@dataclass(frozen=True)
class _Pose:
    """`[x, y, yaw]` in metres and radians."""

    filler: ClassVar[tuple[float, float, float]] = (0.0, 0.0, 0.0)
    expected: ClassVar[str] = "[x, y, yaw] in metres and radians"

    def read(self, value: object, at: KeyPath, faults: list[Fault]) -> Any:
        if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != 3:
            faults.append(Fault(at, shown(value), self.expected))
            return INVALID
        numbers = [Number().read(number, (*at, k), faults) for k, number in enumerate(value)]
        return INVALID if INVALID in numbers else tuple(numbers)

    def schema(self) -> JsonSchema:
        return {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}


@dataclass(frozen=True)
class _Switch:
    """0 or 1, false or true."""

    filler: ClassVar[bool] = False
    expected: ClassVar[str] = "0 or 1"

    def read(self, value: object, at: KeyPath, faults: list[Fault]) -> Any:
        if isinstance(value, int) and value in (0, 1):
            return bool(value)
        faults.append(Fault(at, shown(value), self.expected))
        return INVALID

    def schema(self) -> JsonSchema:
        return {"enum": [0, 1, False, True]}


@record
class RosMap(Checked):
    """The keys of a ROS map file. The image is found from the folder of that file."""

    image: str = spec(Text(), "the image's file")
    resolution: float = spec(Number(above=0), "metres a pixel")
    origin: tuple[float, float, float] = spec(_Pose(), "pose of the image's lower left corner")
    negate: bool = spec(_Switch(), "white is occupied, not black")
    occupied_thresh: float = spec(Number(minimum=0, maximum=1), "occupied above it")
    free_thresh: float = spec(Number(minimum=0, maximum=1), "free below it")
    mode: str = spec(Choice(("trinary", "scale", "raw")), "what a shade means", default="trinary")

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        free, occupied = values["free_thresh"], values["occupied_thresh"]
        if free > occupied:
            yield Fault(("free_thresh",), shown(free), f"a number of at most occupied_thresh ({occupied:g})")


def read_ros_map(path: Path) -> RosMap:
    """A ROS map file.

    Raises
    ------
    MissionError
        with every finding: file, line, field, value, what was expected.
    """
    kind = Record(RosMap, "a map of ROS")
    data, source, faults = parse_data(read_text(path), path, kind.expected)
    known = {f.name for f in specified(RosMap)}
    chart: RosMap = kind.read({key: value for key, value in data.items() if key in known}, (), faults)
    if faults:
        raise MissionError(findings(faults, source))
    return chart


OCCUPIED, FREE, UNKNOWN = 0, 254, 205
"""Shades as map_saver of ROS writes them: with its thresholds they are read as occupied, free and unknown."""


def write_ros_map(path: Path, known: Bools, occupied: Bools, frame: Grid) -> None:
    """Write a ROS map file, and its image (.pgm) beside it.

    Parameters
    ----------
    path : Path
        The file (.yaml).
    known, occupied : ndarray of bool, shape (rows, columns)
        Which cells were seen, and which hold an obstacle; row 0 is the lowest.
    frame : Grid
        Resolution and origin of the cells.
    """
    shades = np.where(occupied, OCCUPIED, np.where(known, FREE, UNKNOWN)).astype(np.uint8)[::-1]
    image = path.with_suffix(".pgm")
    image.write_bytes(f"P5\n{shades.shape[1]} {shades.shape[0]}\n255\n".encode() + shades.tobytes())
    x, y, yaw = frame.origin
    lines = (
        f"image: {image.name}",
        "mode: trinary",
        f"resolution: {frame.resolution_m:.9g}",
        f"origin: [{x:.9g}, {y:.9g}, {yaw:.9g}]",
        "negate: 0",
        "occupied_thresh: 0.65",
        "free_thresh: 0.196",
    )
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
