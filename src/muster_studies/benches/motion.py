"""Speed of path planning and of travel lengths: part of `muster bench`."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from functools import partial
from typing import TypeVar

import numpy as np

from muster.mission.values.arrays import Bools, Floats
from muster.motion.free_space import GridSpace
from muster.motion.grid import Grid
from muster.motion.path import Path
from muster.motion.paths import PathFinder, find
from muster_studies.benches.measurement import Measurement

Answer = TypeVar("Answer")


def across_a_grid(runs: int) -> list[Measurement]:
    """From corner to corner of 2,000 x 2,000 cells, 30 % of them blocked at random."""
    space = GridSpace(Grid(clutter(2000, 0.3), 1.0))
    found = []
    for planner, aim in (("a-star", "< 0.5"), ("dijkstra", ""), ("theta-star", "")):
        answer, times = _timed(partial(find, space, (0.5, 0.5), (1999.5, 1999.5), planner=planner), runs)
        assert isinstance(answer, Path)
        note = f"{answer.length_m:.0f} cells long"
        found += _rows(f"{planner} across 2,000 x 2,000, 30 % blocked", 1, times, aim, note)
    return found


def travel(runs: int) -> list[Measurement]:
    """All lengths between 100 places of 500 x 500 cells, the graph included, on one thread and on two."""
    maps = (
        ("1 % blocked", clutter(500, 0.01)),
        ("rooms", rooms()),
        ("10 % blocked", clutter(500, 0.1)),
        ("30 % blocked", clutter(500, 0.3)),
    )
    return [row for name, blocked in maps for threads in (1, 2) for row in _travel(name, blocked, threads, runs)]


def _travel(name: str, blocked: Bools, threads: int, runs: int) -> list[Measurement]:
    places = free_places(blocked, 100)
    space = GridSpace(Grid(blocked, 0.1))
    lengths, times = _timed(lambda: PathFinder(space).lengths(places * 0.1, threads=threads), runs)
    note = f"{100 * np.isfinite(lengths).mean():.0f} % of pairs joined"
    return _rows(f"travel of 100 places on 500 x 500, {name}", threads, times, "< 5", note)


def clutter(side: int, share: float) -> Bools:
    """A square with so many cells blocked at random, its corners free."""
    blocked = np.random.default_rng(0).random((side, side)) < share
    blocked[:2, :2] = blocked[-2:, -2:] = False
    return blocked


def rooms() -> Bools:
    """5 x 5 rooms of 100 cells, walls four thick with doors of 20, the walls wider by a disc of three."""
    walls = np.zeros((500, 500), dtype=bool)
    for wall in range(100, 500, 100):
        walls[wall - 2 : wall + 2] = walls[:, wall - 2 : wall + 2] = True
    for wall in range(100, 500, 100):
        for room in range(0, 500, 100):
            door = slice(room + 40, room + 60)
            walls[wall - 2 : wall + 2, door] = walls[door, wall - 2 : wall + 2] = False
    inflated = np.zeros_like(walls)
    for down in range(-3, 4):
        for right in range(-3, 4):
            if down * down + right * right <= 9:
                inflated |= np.roll(walls, (down, right), (0, 1))
    return inflated


def free_places(blocked: Bools, count: int) -> Floats:
    """Centres of free cells at random, (count, 2) of (column, row)."""
    free = np.argwhere(~blocked)
    chosen = np.random.default_rng(1).choice(len(free), count, replace=False)
    return np.asarray(free[chosen][:, ::-1] + 0.5, dtype=np.float64)


def _timed(call: Callable[[], Answer], runs: int) -> tuple[Answer, dict[str, list[float]]]:
    """The result of the last call, and the seconds of each call by both clocks."""
    times: dict[str, list[float]] = {"CPU s": [], "s": []}
    for _ in range(runs):
        cpu, wall = time.process_time(), time.perf_counter()
        answer = call()
        times["CPU s"].append(time.process_time() - cpu)
        times["s"].append(time.perf_counter() - wall)
    return answer, times


def _rows(name: str, threads: int, times: dict[str, list[float]], aim: str, note: str) -> list[Measurement]:
    """One row for each clock: processor time of all threads, and wall time."""
    name = f"{name}, {threads} thread{'s' if threads > 1 else ''}"
    return [
        Measurement(name, unit, statistics.median(t), min(t), max(t), len(t), aim if unit == "CPU s" else "", note)
        for unit, t in times.items()
    ]
