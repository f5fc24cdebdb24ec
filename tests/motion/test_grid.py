"""The occupancy grid: cells and metres."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from muster.motion.grid import Grid

coordinates = st.floats(-1e4, 1e4)


@given(
    origin=st.tuples(coordinates, coordinates, st.floats(-7, 7)),
    resolution=st.floats(0.01, 10),
    points=st.lists(st.tuples(coordinates, coordinates), min_size=1, max_size=5),
)
def test_to_map_inverts_to_grid(origin, resolution, points):
    grid = Grid(np.zeros((2, 3), dtype=bool), resolution, origin)
    given_ = np.array(points)
    np.testing.assert_allclose(grid.to_map(grid.to_grid(given_)), given_, atol=1e-7)
    np.testing.assert_allclose(grid.to_grid(grid.to_map(given_)), given_, atol=1e-7)


def test_the_origin_is_the_outer_corner_of_the_first_cell_and_yaw_turns_anticlockwise():
    grid = Grid(np.zeros((4, 4), dtype=bool), 0.5, (10.0, 20.0, math.pi / 2))
    np.testing.assert_allclose(
        grid.to_map(np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])), [[10, 20], [10, 21], [9, 20]]
    )
