"""From the map to the motion: what is driven keeps the clearance that the map asks for, and the robot's limits."""

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.motion.paths.spaces import grids, regions

from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid
from muster.motion.limits import Limits
from muster.motion.maps import free
from muster.motion.maps.distances import clearance_to_blocked, inflated
from muster.motion.maps.polygons import free_region
from muster.motion.path import Path
from muster.motion.paths import find
from muster.motion.smoothing import clear_by_points, smoothed
from muster.motion.velocity import timed

LIMITS = Limits(speed_mps=0.8, acceleration_mps2=0.5, yaw_rate_radps=1.0)
SPACING, TOLERANCE = 0.02, 1e-3
planners = st.sampled_from(("shortest", "theta-star", "a-star"))


def driven(space, seed, planner):
    """The motion along a smoothed path between two random places, 0.05 s a moment."""
    if isinstance(space, GridSpace):
        rows, columns = space.grid.shape
        places = space.grid.to_map(np.random.default_rng(seed).uniform((0, 0), (columns, rows), (2, 2)))
    else:
        places = np.random.default_rng(seed).uniform((0, 0), (16, 12), (2, 2))
    path = find(space, *places, planner=planner)
    assume(isinstance(path, Path))
    clear = clear_by_points(lambda points: free(space, points), SPACING)
    radius = LIMITS.turning_radius_m(faces_its_way=True)
    found = smoothed(path, clear, radii_m=(radius,), tolerance_m=TOLERANCE)
    assert found.curve.max_curvature <= (1 + 1e-3) / radius
    return timed(found.curve, LIMITS, faces_its_way=True).sample(0.05)


def assert_within_limits(motion):
    speed = np.linalg.norm(motion.velocities, axis=1)
    assert (speed <= LIMITS.speed_mps * (1 + 1e-6)).all()
    assert (np.abs(motion.yaw_rates) <= LIMITS.yaw_rate_radps * (1 + 1e-6)).all()
    gains = np.linalg.norm(np.diff(motion.velocities, axis=0), axis=1)
    assert (gains <= LIMITS.acceleration_mps2 * np.diff(motion.times) * (1 + 1e-4) + 1e-6).all()


@pytest.mark.long
@settings(max_examples=25, deadline=None)
@given(regions(), st.integers(0, 2**32 - 1), planners, st.sampled_from((0.1, 0.3)))
def test_among_polygons(space, seed, planner, radius):
    room = shapely.box(0, 0, 16, 12)
    obstacles = [part for part in shapely.get_parts(room.difference(space.region)) if part.area > 0]
    obstacles = [shapely.Polygon(part.exterior) for part in obstacles]
    region = free_region(room, obstacles, radius)
    assume(not region.is_empty)
    motion = driven(PolygonSpace(region), seed, planner)
    gaps = shapely.distance(shapely.union_all([room.exterior, *obstacles]), shapely.points(motion.positions))
    assert gaps.min() >= radius - (TOLERANCE + SPACING / 2 + 5e-3)
    assert_within_limits(motion)


@settings(max_examples=25, deadline=None)
@given(grids(), st.integers(0, 2**32 - 1), planners, st.sampled_from((0.0, 0.1)))
def test_over_cells(space, seed, planner, radius):
    cells = np.kron(space.grid.blocked, np.ones((8, 8), dtype=bool))
    grid = Grid(cells, 0.25, (5.0, -3.0, 0.4))
    motion = driven(GridSpace(inflated(grid, radius)), seed, planner)
    assert clearance_to_blocked(grid)(motion.positions).min() >= radius - (TOLERANCE + SPACING / 2 + 5e-3)
    assert_within_limits(motion)
