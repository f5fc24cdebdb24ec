"""Paths of many robots on the MovingAI benchmarks, and plans on a roadmap: part of `muster bench`.

`MUSTER_MAPF` names a folder with `warehouse-10-20-10-2-1.map`, `random-32-32-10.map` and
`random-32-32-10-random-1.scen` ([stern2019]). Without it maps of the same kinds are made: the warehouse is the same to
the cell, the random one has other cells.
"""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from muster.mission.values.arrays import Bools
from muster.traffic.joint_path_faults import faults
from muster.traffic.joint_paths import JointPaths, Parameters, costs, grid_graph, joint_paths
from muster.traffic.journeys.roadmap_network import moves_at_once
from muster.traffic.move_faults import distances
from muster.traffic.move_faults import faults as move_faults
from muster.traffic.movingai import Ends, read_map, read_scenario
from muster_studies.benches.measurement import Measurement

FOLDER = "MUSTER_MAPF"
WAREHOUSE, RANDOM, SCENARIO = "warehouse-10-20-10-2-1.map", "random-32-32-10.map", "random-32-32-10-random-1.scen"
PREFIXES = (50, 100, 200, 300, 400)
TIME_LIMIT_S = 10.0
PUBLISHED = {50: "LaCAM 1,316", 400: "LaCAM* 16,368 in 10 s"}
"""Sums of costs on SCENARIO that others print: see docs/traffic-planning.md for where."""


@dataclass(frozen=True)
class Solved:
    """One run: seconds of processor time, sum of costs, and the least that it could be; None where not solved."""

    cpu_s: float
    cost: int | None
    least: int


def traffic(runs: int) -> list[Measurement]:
    """The warehouse with ten seeds, growing prefixes of a scenario, and re-planning on a roadmap."""
    return [*warehouse_bench(10), *prefixes_bench(runs), *roadmap_bench(runs)]


def warehouse_bench(seeds: int) -> list[Measurement]:
    """500 robots from random starts to random goals, until the first solution."""
    blocked = _map(WAREHOUSE, warehouse)
    solved = [solve(blocked, random_ends(blocked, 500, seed), seed) for seed in range(seeds)]
    return [_row("500 robots, warehouse-10-20-10-2-1", solved, "< 10")]


def prefixes_bench(runs: int) -> list[Measurement]:
    """The first robots of a scenario: the first solution, and the best of `TIME_LIMIT_S`."""
    blocked = _map(RANDOM, lambda: clutter(32, 102))
    folder = os.environ.get(FOLDER)
    ends = read_scenario(Path(folder) / SCENARIO) if folder else random_ends(blocked, max(PREFIXES), 0)
    found = []
    for count in PREFIXES:
        published = PUBLISHED.get(count, "") if folder else ""
        solved = [solve(blocked, ends[:count], seed) for seed in range(runs)]
        found.append(_row(f"{count} robots, random-32-32-10", solved, "", published))
    params = Parameters(samples=10, refine=True)
    for count in PREFIXES:
        published = PUBLISHED.get(count, "") if folder else ""
        found.append(
            _row(f"{count} robots, random-32-32-10, refined", [solve(blocked, ends[:count], 0, params)], "", published)
        )
    return found


def solve(blocked: Bools, ends: Sequence[Ends], seed: int, params: Parameters | None = None) -> Solved:
    """Paths on a grid, judged. The time includes the graph and the ways to all goals."""
    begin = time.process_time()
    graph, numbers = grid_graph(blocked)
    starts, goals = ([int(numbers[getattr(end, side)]) for end in ends] for side in ("start", "goal"))
    found = joint_paths(graph, starts, goals, seed=seed, time_limit=TIME_LIMIT_S, params=params)
    cpu_s = time.process_time() - begin
    least = int(sum(graph.costs_to(goal)[start] for start, goal in zip(starts, goals, strict=True)))
    if not isinstance(found, JointPaths):
        return Solved(cpu_s, None, least)
    cells = np.argwhere(numbers >= 0).tolist()
    paths = [[(cells[v][0], cells[v][1]) for v in column] for column in found.vertices.T.tolist()]
    wrong = faults(blocked, paths, [(end.start, end.goal) for end in ends])
    if wrong:
        raise AssertionError(wrong[0])
    return Solved(cpu_s, costs(found.vertices, goals)["sum of costs"], least)


def _row(name: str, solved: Sequence[Solved], aim: str, published: str = "") -> Measurement:
    done = [run for run in solved if run.cost is not None]
    note = f"{len(done)} of {len(solved)} solved"
    if done:
        cost, least = (statistics.mean(getattr(run, what) for run in done) for what in ("cost", "least"))
        note += f"; sum of costs {cost:,.0f}, at least {least:,.0f}"
    note += f"; {published}" if published else ""
    return Measurement.over_runs(name, "CPU s", [run.cpu_s for run in solved], aim, note)


def roadmap_bench(runs: int) -> list[Measurement]:
    """200 robots of radius 0.3 m in 100 m x 100 m with racks and aisles for one: the whole plan, all ways new."""
    roadmap = lattice(~shelves(100), 1.0, 0.62)
    seconds, moves, arrived = [], [], 0
    for seed in range(runs):
        random = np.random.default_rng(seed)
        starts, goals = (random.permutation(len(roadmap.points))[:200].tolist() for _ in range(2))
        begin = time.process_time()
        in_turn, through = moves_at_once(roadmap, starts, goals, radius_m=0.3, margin_m=0.02, seed=seed)
        seconds.append(time.process_time() - begin)
        wrong = move_faults(roadmap.points, roadmap.edges, starts, in_turn, [0.3] * 200, 0.02)
        if wrong:
            raise AssertionError(wrong[0])
        moves.append(len(in_turn))
        arrived += through
    note = f"{arrived} of {runs} to all goals; {len(roadmap.points):,} points, {statistics.mean(moves):,.0f} moves"
    return [Measurement.over_runs("200 robots, aisles in 100 m x 100 m", "CPU s", seconds, "< 1", note)]


def _map(name: str, make: Callable[[], Bools]) -> Bools:
    folder = os.environ.get(FOLDER)
    return read_map(Path(folder) / name) if folder else make()


def warehouse(rows: int = 20, racks: int = 10, beside: int = 25) -> Bools:
    """Rows of racks of 10 x 2 cells, aisles of one cell, and free columns on each side: 63 x 161 by default."""
    blocked = np.ones((3 * rows + 3, 11 * racks + 2 * beside + 1), dtype=np.bool_)
    blocked[1:-1, 1:-1] = False
    for row in range(2, 3 * rows + 2, 3):
        for column in range(beside + 1, beside + 11 * racks, 11):
            blocked[row : row + 2, column : column + 10] = True
    return blocked


def shelves(side: int) -> Bools:
    """A square with racks of 10 x 2 cells, aisles of one cell between them lengthwise and of two across."""
    blocked = np.zeros((side, side), dtype=np.bool_)
    for row in range(4, side - 4, 3):
        for column in range(4, side - 4, 12):
            blocked[row : row + 2, column : min(column + 10, side - 4)] = True
    return blocked


def clutter(side: int, count: int) -> Bools:
    """A square with so many cells blocked at random."""
    blocked = np.zeros((side, side), dtype=np.bool_)
    blocked.flat[np.random.default_rng(0).permutation(side * side)[:count]] = True
    return blocked


def random_ends(blocked: Bools, count: int, seed: int) -> list[Ends]:
    """Starts and goals in the largest connected part, no two the same."""
    from scipy.ndimage import label

    parts, _ = label(~blocked)
    cells = np.argwhere(parts == np.bincount(parts[parts > 0]).argmax()).tolist()
    random = np.random.default_rng(seed)
    sides = (random.permutation(len(cells))[:count] for _ in range(2))
    return [Ends((cells[a][0], cells[a][1]), (cells[b][0], cells[b][1])) for a, b in zip(*sides, strict=True)]


def lattice(free: Bools, spacing_m: float, reach_m: float) -> SimpleNamespace:
    """A roadmap with a point in each free cell, joined to those beside, above and below, and its conflicts."""
    _, numbers = grid_graph(~free)
    cells = np.argwhere(numbers >= 0)
    points = np.asarray(cells[:, ::-1] * spacing_m, dtype=np.float64)
    sides = ((0, 1), (1, 0), (0, -1), (-1, 0))
    padded = np.pad(numbers, 1, constant_values=-1)
    edges = [
        (k, there)
        for k, (row, column) in enumerate(cells.tolist())
        for down, right in sides
        if (there := int(padded[row + 1 + down, column + 1 + right])) >= 0
    ]
    near: list[int] = []
    metres: list[float] = []
    start = [0]
    for tail, head in edges:
        row, column = cells[head]
        around = padded[max(row - 1, 0) : row + 4, max(column - 1, 0) : column + 4]
        close = np.array([k for k in around.flat if k >= 0 and k != tail])
        distance = distances(points[close], points[tail], points[head])
        away = np.linalg.norm(points[close] - points[tail], axis=1)
        chosen = (distance < reach_m) & (distance < away - 1e-9)
        near += close[chosen].tolist()
        metres += distance[chosen].tolist()
        start.append(len(near))
    return SimpleNamespace(
        points=points,
        edges=np.array(edges, dtype=np.int64),
        speed_mps=np.full(len(edges), np.inf),
        reach_start=np.array(start, dtype=np.int64),
        reach_point=np.array(near, dtype=np.int64),
        reach_m=np.array(metres, dtype=np.float64),
    )
