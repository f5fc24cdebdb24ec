"""Voxels: ways through them beside the exact ways among prisms, what a scan passes, and clearances by brute force."""

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from scipy.ndimage import label

from muster.motion.free_space import Prism, PrismSpace
from muster.motion.paths import PathFinder
from muster.motion.voxels import VoxelFrame, VoxelWays, lower_clearances, passed_voxels

HALL = shapely.box(0, 0, 20, 20)
CUBES = VoxelFrame((8, 9, 10), 0.5, (1.0, -2.0, 0.25))


def ways_among(*prisms):
    space = PrismSpace(HALL, prisms)
    frame = VoxelFrame.over(np.array([0.0, 0.0, 0.0]), np.array([20.0, 20.0, 8.0]), 0.25, 10**6)
    return VoxelWays(frame, frame.beyond(space)), PathFinder(space)


def length(points):
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def test_places_and_voxels_of_a_frame():
    voxels, within = CUBES.voxels(np.array([[1.1, -1.9, 0.3], [5.9, 2.4, 4.2], [0.9, 0.0, 1.0], [2.0, 0.0, 4.3]]))
    assert voxels[:2].tolist() == [[0, 0, 0], [7, 8, 9]]
    assert within.tolist() == [True, True, False, False]
    assert CUBES.centres(voxels[:1]).tolist() == [[1.25, -1.75, 0.5]]
    points = np.array([[3.2, 0.1, 2.0]])
    assert np.allclose(CUBES.to_map(CUBES.to_cells(points)), points)


def test_a_frame_has_about_as_many_voxels_as_may_be():
    frame = VoxelFrame.over(np.zeros(3), np.array([100.0, 100.0, 10.0]), 0.1, 10_000)
    assert 10_000 <= math.prod(frame.shape) < 12_000
    assert VoxelFrame.over(np.zeros(3), np.ones(3), 0.1, 10_000).shape == (10, 10, 10)


@pytest.mark.parametrize(
    ("prism", "start", "goal"),
    [
        (Prism(shapely.box(9, -5, 11, 25), 0, 3), (5, 10, 1), (15, 10, 1)),  # over a wall
        (Prism(shapely.box(9, 4, 11, 16), 0, 99), (5, 10, 1), (15, 11, 1)),  # around a tower
        (Prism(shapely.box(9, -5, 11, 25), 3, 99), (5, 10, 4), (15, 10, 6)),  # below a bridge
    ],
)
def test_ways_are_short_and_free(prism, start, goal):
    voxels, exact = ways_among(prism)
    way = voxels.way(np.array(start, dtype=float), np.array(goal, dtype=float))
    assert tuple(way[0]) == start
    assert tuple(way[-1]) == goal
    assert exact.clear(way)
    shortest = exact.path(start, goal).length_m
    assert shortest - 1e-9 <= length(way) < 1.08 * shortest


@pytest.mark.parametrize("seed", range(20))
def test_ways_among_random_prisms(seed):
    random = np.random.default_rng(seed)
    prisms = []
    for x, y in random.uniform(2, 15, (8, 2)):
        low = random.choice([-math.inf, random.uniform(1, 3)])
        prisms.append(
            Prism(shapely.box(x, y, x + random.uniform(0.5, 4), y + random.uniform(0.5, 4)), low, random.uniform(4, 7))
        )
    voxels, exact = ways_among(*prisms)
    ends = random.uniform((0.3, 0.3, 0.3), (19.7, 19.7, 7.7), (40, 3))
    free = [place for place in ends if voxels.free(place)][:8]
    for a, b in zip(free[::2], free[1::2], strict=False):
        way, shortest = voxels.way(a, b), exact.path(a, b).length_m
        assert all(voxels.sees(p, q) for p, q in pairwise(way))
        assert exact.clear(way)
        assert shortest - 1e-9 <= length(way) < 1.15 * shortest + 0.3


def test_sight_is_that_of_dense_samples():
    random = np.random.default_rng(3)
    blocked = random.random((8, 9, 10)) < 0.15
    ways = VoxelWays(CUBES, blocked)
    places = CUBES.to_map(random.uniform(0, (10, 9, 8), (200, 2, 3)))
    for a, b in places:
        along = np.linspace(a, b, 4000)
        voxels, _ = CUBES.voxels(along)
        assert ways.sees(a, b) == (not blocked[tuple(voxels.T)].any())


def test_parts_are_those_of_faces_that_touch():
    blocked = np.random.default_rng(4).random((8, 9, 10)) < 0.6
    ways, (numbers, _) = VoxelWays(CUBES, blocked), label(~blocked)
    found = {}
    for voxel in np.argwhere(~blocked):
        part = ways.part(CUBES.centres(voxel[None])[0])
        assert found.setdefault(numbers[tuple(voxel)], part) == part
    assert len(set(found.values())) == len(found)
    assert ways.part(CUBES.centres(np.argwhere(blocked)[:1])[0]) == 0


def test_there_is_no_way_between_parts():
    blocked = np.zeros((8, 9, 10), dtype=bool)
    blocked[:, :, 5] = True
    ways = VoxelWays(CUBES, blocked)
    assert ways.way(np.array([1.5, 0.0, 1.0]), np.array([5.5, 0.0, 1.0])) is None
    blocked[7, 8, 5] = False
    way = VoxelWays(CUBES, blocked).way(np.array([1.5, 0.0, 1.0]), np.array([5.5, 0.0, 1.0]))
    assert CUBES.voxels(way)[0][:, 2].max() > 5


def test_a_scan_passes_what_is_nearer_than_its_beams_reached():
    eye, rings, columns = np.array([3.1, 0.2, 2.1]), 37, 72
    random = np.random.default_rng(5)
    reached = random.uniform(0.5, 4.0, (rings, columns))
    passed = set(passed_voxels(CUBES, eye, 0.7, reached).tolist())
    for voxel in np.ndindex(CUBES.shape):
        to = CUBES.centres(np.array([voxel]))[0] - eye
        away = np.linalg.norm(to) / CUBES.cell_m
        bearing = (math.atan2(to[1], to[0]) - 0.7) % (2 * math.pi) / (2 * math.pi) * columns
        ring = (math.atan2(to[2], math.hypot(to[0], to[1])) + math.pi / 2) / math.pi * (rings - 1)
        i, j = min(int(ring), rings - 2), int(bearing) % columns
        least = min(reached[i, j], reached[i + 1, j], reached[i, (j + 1) % columns], reached[i + 1, (j + 1) % columns])
        stands_in = np.abs(to).max() <= CUBES.cell_m / 2
        is_passed = int(np.ravel_multi_index(voxel, CUBES.shape)) in passed
        assert is_passed == (stands_in or away + 1 <= least / CUBES.cell_m)


def test_clearances_are_to_the_nearest_point_within_reach():
    points = CUBES.to_map(np.random.default_rng(6).uniform(0, (10, 9, 8), (12, 3)))
    clearances = np.full(CUBES.shape, np.inf, dtype=np.float32)
    lower_clearances(CUBES, clearances, points, 1.3)
    centres = CUBES.centres(np.argwhere(np.ones(CUBES.shape)))
    nearest = np.linalg.norm(centres[:, None] - points, axis=2).min(axis=1) / CUBES.cell_m
    expected = np.where(nearest <= 1.3 / CUBES.cell_m, nearest, np.inf)
    assert np.allclose(clearances.ravel(), expected, atol=1e-5)
