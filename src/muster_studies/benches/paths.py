"""Speed of one query for a path, the analysis of the space included: part of `muster bench`."""

from __future__ import annotations

import time

import numpy as np
import shapely

from muster.motion.free_space import GridSpace, Prism, PrismSpace, Space
from muster.motion.grid import Grid
from muster.motion.path import Path
from muster.motion.paths import find
from muster_studies.benches.measurement import Measurement
from muster_studies.benches.motion import clutter

CELLS = 2000
PLANNERS = ("a-star", "shortest", "theta-star")
SIDE_M, RADIUS_M = 100.0, 0.3
Place = tuple[float, ...]


def paths(runs: int) -> list[Measurement]:
    """From corner to corner of grids without and with noise, and of the air among 100 prisms."""
    found = []
    for what, share in (("open", 0.0), ("5 % noise", 0.05)):
        space = GridSpace(Grid(clutter(CELLS, share), 1.0))
        for planner in PLANNERS:
            name = f"{planner} across {CELLS:,} x {CELLS:,}, {what}"
            found.append(query(name, space, (0.5, 0.5), (CELLS - 0.5, CELLS - 0.5), planner, runs, "< 1"))
    low, high = (1.0, 1.0, 1.0), (SIDE_M - 1, SIDE_M - 1, 1.0)
    for what, hanging in (("on the ground", 0.0), ("half of them hanging", 0.5)):
        name = f"shortest in the air, 100 prisms {what}"
        found.append(query(name, towers(100, hanging), low, high, "shortest", runs, "< 5"))
    return found


def query(name: str, space: Space, start: Place, goal: Place, planner: str, runs: int, aim: str) -> Measurement:
    """Seconds of processor time of the same query, each time anew."""
    seconds, length_m = [], 0.0
    for _ in range(runs):
        begin = time.process_time()
        answer = find(space, start, goal, planner=planner)
        seconds.append(time.process_time() - begin)
        assert isinstance(answer, Path)
        length_m = answer.length_m
    return Measurement.over_runs(name, "CPU s", seconds, aim, f"{length_m:.1f} m long")


def towers(count: int, hanging: float) -> PrismSpace:
    """Rectangular towers at random in 100 m x 100 m, wider by a disc; such a share begins 3 m above the ground."""
    random = np.random.default_rng(0)
    prisms = []
    for k in range(count):
        x, y = random.uniform(4, SIDE_M - 4, 2)
        width, depth = random.uniform(1, 4, 2)
        base = shapely.affinity.rotate(shapely.box(x, y, x + width, y + depth), random.uniform(0, 90))
        floor_m = 3.0 if k < hanging * count else 0.0
        top_m = floor_m + random.uniform(2, 15)
        prisms.append(Prism(base.buffer(RADIUS_M), floor_m - RADIUS_M, top_m + RADIUS_M))
    return PrismSpace(shapely.box(0, 0, SIDE_M, SIDE_M), tuple(prisms))
