"""What a laser scan shows, on the map: obstacles with their shapes and edges, and cylinders as landmarks.

Obstacles are those of [tcf-thesis], section 2.1.2 (`obstacles`), landmarks those of [market-paper] (`spikes`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from muster.mission.errors import ParameterError
from muster.motion.frames import Floats, moved
from muster.perception.obstacles import Obstacle, obstacles
from muster.perception.spikes import landmarks


def scan_of(
    ranges: Sequence[float], first_rad: float, step_rad: float, reach_m: tuple[float, float]
) -> tuple[Floats, Floats]:
    """Ranges and bearings (n,) of a sensor_msgs/LaserScan: bearings rise, and what is out of reach is infinite.

    Raises
    ------
    ParameterError
        if there are fewer than two ranges, or no step between beams.
    """
    lengths = np.asarray(ranges, dtype=np.float64)
    if len(lengths) < 2 or not (math.isfinite(first_rad) and math.isfinite(step_rad)) or step_rad == 0:
        raise ParameterError(f"scan: {len(lengths)} ranges at steps of {step_rad} rad; expected two, and a step")
    within = np.isfinite(lengths) & (lengths >= reach_m[0]) & (lengths <= reach_m[1])
    lengths = np.where(within, lengths, math.inf)
    bearings: Floats = first_rad + step_rad * np.arange(len(lengths), dtype=np.float64)
    return (lengths, bearings) if step_rad > 0 else (lengths[::-1], bearings[::-1])


def seen_on_map(ranges: Floats, bearings: Floats, scanner: Floats, *, margin_m: float) -> dict[str, Any]:
    """The obstacles and the landmarks of a scan as plain data, places on the map.

    Parameters
    ----------
    scanner
        its pose (4, 4) in the map: x ahead, y left.
    margin_m
        by which an obstacle grows before its edges are taken: the robot's radius (Figure 2.1).

    Raises
    ------
    ParameterError
        if the shapes differ.
    """
    marks = landmarks(ranges, bearings)
    return {
        "obstacles": [_obstacle(one, scanner, margin_m) for one in obstacles(ranges, bearings)],
        "landmarks": [
            {"position": _on_map([mark.position], scanner)[0], "radius_m": round(mark.radius_m, 4)} for mark in marks
        ],
    }


def _obstacle(obstacle: Obstacle, scanner: Floats, margin_m: float) -> dict[str, Any]:
    shape = obstacle.shape
    return {
        "shape": shape.name,
        "position": _on_map([shape.position], scanner)[0],
        "length_m": round(shape.length_m, 4),
        "width_m": round(shape.width_m, 4),
        "edges": _on_map(obstacle.edges(margin_m), scanner),
    }


def _on_map(places: Sequence[tuple[float, float]], scanner: Floats) -> list[list[float]]:
    level = np.column_stack([np.asarray(places, dtype=np.float64), np.zeros(len(places))])
    return [[round(float(c), 4) for c in place[:2]] for place in moved(scanner, level)]
