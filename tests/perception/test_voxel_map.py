"""What lidars measure becomes voxels: obstacles where beams end, free where scans pass, and free again later."""

import math

import numpy as np

from muster.motion.voxels import VoxelFrame
from muster.perception.sphere_scanner import SphereScanner
from muster.perception.voxel_map import SpaceScan, VoxelMap

SCANNER = SphereScanner(math.radians(2.5), 12.0)
FRAME = VoxelFrame((20, 40, 40), 0.25, (-5.0, -5.0, 0.0))
NO_BALLS = np.empty((0, 4))
WALL = np.array([[3.0, -5.0, 3.0, 5.0, -math.inf, math.inf]])


def enter(seen, eye, faces=WALL):
    eye = np.array(eye)
    scan = SCANNER.scan(eye, 0.4, faces, [], 0.0, NO_BALLS)
    return seen.see(
        SpaceScan(eye, 0.4, scan.ranges, np.isfinite(scan.ranges) & ~scan.on_ground, scan.on_ground), SCANNER
    )


def test_a_wall_is_occupied_where_it_stands_and_the_air_before_it_is_free():
    seen = VoxelMap(FRAME, 1.0)
    fresh, changed = enter(seen, (0.0, 0.0, 2.0))
    assert changed
    assert np.allclose(fresh[:, 0], 3.0, atol=1e-5)
    centres = FRAME.centres(np.argwhere(seen.occupied))
    assert np.allclose(centres[:, 0], 3.125)
    free = FRAME.centres(np.argwhere(seen.known & ~seen.occupied))
    assert free[:, 0].max() < 3.0
    behind, _ = FRAME.voxels(np.array([[4.0, 0.0, 2.0]]))
    assert not seen.known[tuple(behind[0])]


def test_the_ground_is_no_obstacle_and_the_lowest_air_is_seen():
    seen = VoxelMap(FRAME, 1.0)
    enter(seen, (0.0, 0.0, 2.0), np.empty((0, 6)))
    assert not seen.occupied.any()
    assert seen.known[0, 15:25, 15:25].all()


def test_points_and_clearances_are_those_of_the_surface():
    seen = VoxelMap(FRAME, 1.0)
    enter(seen, (0.0, 0.0, 2.0))
    near, _ = FRAME.voxels(np.array([[2.6, 0.1, 2.1]]))
    away = seen.clearances[tuple(near[0])] * FRAME.cell_m
    assert 0.37 <= away <= 0.42  # the centre is 0.375 m from the wall
    assert seen.tree().query((2.0, 0.0, 2.0))[0] >= 1.0


def test_what_has_gone_is_free_after_some_scans():
    seen = VoxelMap(FRAME, 1.0)
    for _ in range(2):
        enter(seen, (0.0, 0.0, 2.0))
    assert seen.occupied.any()
    scans = 0
    while seen.occupied[8, 20, 32] and scans < 200:
        enter(seen, (0.0, 0.0, 2.0), np.empty((0, 6)))
        scans += 1
    assert 1 < scans < 200
    assert np.isinf(seen.clearances[8, 20, 30]) or seen.occupied.any()


def test_clearances_can_be_asked_for_farther_later():
    seen = VoxelMap(FRAME, 0.5)
    enter(seen, (0.0, 0.0, 2.0))
    at, _ = FRAME.voxels(np.array([[2.1, 0.0, 2.1]]))
    assert np.isinf(seen.clearances[tuple(at[0])])
    seen.require_clearance(1.2)
    assert abs(seen.clearances[tuple(at[0])] * FRAME.cell_m - 0.875) < 0.05
