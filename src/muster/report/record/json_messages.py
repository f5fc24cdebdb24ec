"""Messages of a record as JSON: time stamps, poses, transforms, states, logs, a grid.

Those that are written at every step are put together as text, for speed; metres, radians and m/s are written to four
decimals. All times are seconds of the mission's clock, all places metres in the map frame.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from muster.mission.yaml_writer import plain
from muster.motion.grid import Grid

MAP_FRAME = "map"
INFO, WARNING = 2, 3


def nanoseconds(now: float) -> int:
    return round(now * 1e9)


def stamp(now: float) -> dict[str, int]:
    """A time as Foxglove writes it."""
    sec, nsec = divmod(nanoseconds(now), 10**9)
    return {"sec": sec, "nsec": nsec}


def json_bytes(data: Any) -> bytes:
    """Compact JSON; records of the model as a mission file has them, arrays as lists.

    Raises
    ------
    ValueError
        if a number is not finite: JSON has none such.
    """
    return json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"), default=_plain).encode()


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else plain(value)


def body_frame(robot: str) -> str:
    """The frame of a robot's body (REP-105)."""
    return f"{robot}/base_link"


def pose(place: Iterable[float] = (0.0, 0.0, 0.0), heading: float = 0.0) -> dict[str, Any]:
    x, y, z = place
    half = heading / 2
    return {
        "position": {"x": x, "y": y, "z": z},
        "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(half), "w": math.cos(half)},
    }


def state_text(now: float, names: Iterable[str], rows: Iterable[list[float]]) -> bytes:
    """muster.State: of each robot a row x, y, z, heading, vx, vy, vz."""
    robots = ",".join(
        f'{json.dumps(name)}:{{"x":{x:.4f},"y":{y:.4f},"z":{z:.4f},"heading_rad":{heading:.4f},'
        f'"vx":{vx:.4f},"vy":{vy:.4f},"vz":{vz:.4f}}}'
        for name, (x, y, z, heading, vx, vy, vz) in zip(names, rows, strict=True)
    )
    return f'{{"time_s":{now!r},"robots":{{{robots}}}}}'.encode()


def place_texts(rows: Iterable[list[float]]) -> list[tuple[str, str]]:
    """Position and orientation of each row x, y, z, heading, ... as JSON, for `poses_text` and `transforms_text`."""
    return [(_xyz(row), _turn(row[3])) for row in rows]


def poses_text(now: float, places: Iterable[tuple[str, str]]) -> bytes:
    """foxglove.PosesInFrame."""
    poses = ",".join(f'{{"position":{xyz},"orientation":{turn}}}' for xyz, turn in places)
    return f'{{"timestamp":{_stamp_text(now)},"frame_id":"{MAP_FRAME}","poses":[{poses}]}}'.encode()


def transforms_text(now: float, names: Iterable[str], places: Iterable[tuple[str, str]]) -> bytes:
    """foxglove.FrameTransforms: from the map to each body."""
    time = _stamp_text(now)
    transforms = ",".join(
        f'{{"timestamp":{time},"parent_frame_id":"{MAP_FRAME}","child_frame_id":{json.dumps(body_frame(name))},'
        f'"translation":{xyz},"rotation":{turn}}}'
        for name, (xyz, turn) in zip(names, places, strict=True)
    )
    return f'{{"transforms":[{transforms}]}}'.encode()


def _stamp_text(now: float) -> str:
    sec, nsec = divmod(nanoseconds(now), 10**9)
    return f'{{"sec":{sec},"nsec":{nsec}}}'


def _xyz(row: list[float]) -> str:
    return f'{{"x":{row[0]:.4f},"y":{row[1]:.4f},"z":{row[2]:.4f}}}'


def _turn(heading: float) -> str:
    return f'{{"x":0,"y":0,"z":{math.sin(heading / 2):.6f},"w":{math.cos(heading / 2):.6f}}}'


def log(now: float, level: int, message: str) -> dict[str, Any]:
    """foxglove.Log."""
    return {"timestamp": stamp(now), "level": level, "message": message, "name": "muster", "file": "", "line": 0}


def grid_message(grid: Grid) -> dict[str, Any]:
    """foxglove.Grid: 0 where a cell is free, 1 where it is blocked; rows from the lowest."""
    x, y, yaw = grid.origin
    columns = grid.shape[1]
    return {
        "timestamp": stamp(0.0),
        "frame_id": MAP_FRAME,
        "pose": pose((x, y, 0.0), yaw),
        "column_count": columns,
        "cell_size": {"x": grid.resolution_m, "y": grid.resolution_m},
        "row_stride": columns,
        "cell_stride": 1,
        "fields": [{"name": "blocked", "offset": 0, "type": 1}],
        "data": base64.b64encode(grid.blocked.astype(np.uint8).tobytes()).decode(),
    }


def grid_from(message: Mapping[str, Any]) -> Grid:
    """The grid in a message of `grid_message`."""
    cells = np.frombuffer(base64.b64decode(message["data"]), dtype=np.uint8)
    at, turn = message["pose"]["position"], message["pose"]["orientation"]
    yaw = 2 * math.atan2(turn["z"], turn["w"])
    blocked = cells.reshape(-1, message["column_count"]).astype(bool)
    return Grid(blocked, message["cell_size"]["x"], (at["x"], at["y"], yaw))
