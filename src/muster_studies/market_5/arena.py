"""Cylinders in the arena, and errors of lasers and odometry; all but the scanner is chosen here.

The paper's survivors are white cylinders (section 5). Its gripper takes what is up to 50 mm wide, so that is their
width. Where they and the landmarks stand it shows in pictures only.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from muster.mission.model import Landmark
from muster.perception.laser import Scanner
from muster.perception.spikes import SpikeParameters
from muster_studies.rescue.flights import NOISE

SURVIVORS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "survivor1": (0.3, 1.1),
        "survivor2": (0.55, 1.7),
        "survivor3": (1.3, 0.9),
        "survivor4": (1.7, 1.35),
        "survivor5": (1.45, 1.6),
    }
)
"""Where their cylinders stand: beside the places at which the mission has robots work, 0.14 to 0.15 m off, and at least
as far from all ways."""

BEACONS = ((0.12, 0.12), (1.88, 0.12), (1.88, 1.88), (0.12, 1.88), (1.0, 1.88), (0.12, 1.0))
"""Where landmarks stand that every robot knows: cylinders like the survivors'."""

CYLINDER_RADIUS_M = 0.025
CYLINDERS = np.array([(*place, CYLINDER_RADIUS_M) for place in (*SURVIVORS.values(), *BEACONS)])

SCANNER = Scanner(range_m=0.01)
"""The paper's: 240 degrees, 4 m, 0.36 degrees. The error of a range is ours."""
SEARCH = SpikeParameters(depth_m=0.07, smallest_m=0.012, largest_m=0.04)
"""Cylinders of this size, noise and beams allowed for: robots and the ends of obstacles are wider."""

RANGE_M, BEARING_RAD = 0.005, math.radians(0.36)
"""How far the centre of a cylinder is off in one scan: standard deviations that are counted with."""

STEERED_NOISE = replace(NOISE, position_m=0.0, heading_rad=0.0)
"""That of the study rescue, but that no robot is told its pose: it has its odometry and its laser."""

LANDMARKS = (
    *(Landmark(position=place, radius_m=CYLINDER_RADIUS_M) for place in BEACONS),
    *(Landmark(position=place, radius_m=CYLINDER_RADIUS_M, known=False) for place in SURVIVORS.values()),
)
