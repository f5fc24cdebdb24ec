"""From the shades of an image to cells that are free or blocked, by the rules of ROS map_server.

Occupancy is 1 - shade, or the shade with `negate`; a cell is occupied above `occupied_thresh`, free below
`free_thresh`, else unknown. In mode `raw` occupancy is the pixel's value in per cent, unknown above 100, whatever
`negate` says. Here what is unknown is blocked, so that `trinary` and `scale` mean the same; and what is not opaque is
unknown in every mode.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from muster.mission.errors import MissionError
from muster.mission.model import Map
from muster.mission.value_types import Fault
from muster.mission.values.arrays import Floats
from muster.motion.grid import Grid
from muster.motion.maps.images import image_kind, read_shades
from muster.motion.maps.ros_yaml import RosMap, read_ros_map

_OCCUPIED, _FREE = 0.65, 0.196  # the thresholds that ROS writes where nobody says otherwise
FARTHEST_M = 1e9
"""Greatest coordinate of a map: beyond it float64 has no micrometres left."""


def read_grid(chart: Map, folder: Path, faults: list[Fault]) -> Grid | None:
    """The occupancy grid of a map that is an image; None where something is wrong, which is appended to `faults`.

    Parameters
    ----------
    chart
        a map with `ros_yaml` or `image`.
    folder
        where its file is found from.
    """
    key = "image" if chart.ros_yaml is None else "ros_yaml"
    path = folder / str(getattr(chart, key))
    if key == "ros_yaml" and (kind := image_kind(path)) is not None:
        faults.append(
            Fault(("map", key), f"{path}: {kind}", "a map file of ROS, in YAML; for an image the key is image")
        )
        return None
    try:
        ros_map = _as_ros_map(chart) if chart.ros_yaml is None else read_ros_map(path)
        image = path if chart.ros_yaml is None else path.parent / ros_map.image
        shades = read_shades(image)
    except MissionError as error:
        faults.extend(
            Fault(("map", key), _told(finding.place, finding.field, finding.value), finding.expected)
            for finding in error.findings
        )
        return None
    far = max(map(abs, ros_map.origin[:2])) + ros_map.resolution * sum(shades.shape)
    if far > FARTHEST_M:
        faults.append(Fault(("map", key), f"a map that reaches {far:g} m", f"coordinates up to {FARTHEST_M:g} m"))
        return None
    return Grid(~free_cells(shades, ros_map)[::-1], ros_map.resolution, ros_map.origin)


def free_cells(shades: Floats, ros_map: RosMap) -> npt.NDArray[np.bool_]:
    """Which pixels are free; `shades` (rows, columns) as `read_shades` gives them."""
    if ros_map.mode == "raw":
        return np.round(shades * 255) / 100 < ros_map.free_thresh
    return (shades if ros_map.negate else 1 - shades) < ros_map.free_thresh


def _as_ros_map(chart: Map) -> RosMap:
    x, y, yaw = (*(chart.origin or (0.0, 0.0)), 0.0)[:3]
    return RosMap(
        image=str(chart.image),
        resolution=chart.resolution_m or 0.0,
        origin=(x, y, yaw),
        negate=False,
        occupied_thresh=_OCCUPIED,
        free_thresh=_FREE,
    )


def _told(place: str, field: str, value: str) -> str:
    return ": ".join(filter(None, (place, field, value)))
