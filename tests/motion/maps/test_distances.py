"""Inflation, the field of distances and clearance, against looking at every blocked square."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from muster.core import squared_distances
from muster.motion.grid import Grid
from muster.motion.maps import clearance_to_blocked, inflated
from muster.motion.maps.distance_field import distance_field

shared = settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])


@st.composite
def grids(draw):
    rows, columns = draw(st.integers(1, 9)), draw(st.integers(1, 12))
    share = draw(st.sampled_from([0.0, 0.05, 0.3, 1.0]))
    blocked = np.random.default_rng(draw(st.integers(0, 10**6))).random((rows, columns)) < share
    return Grid(blocked, draw(st.sampled_from([0.05, 0.5, 1.0, 3.0])), (draw(st.floats(-5, 5)), 2.0, 0.7))


def centres(grid):
    rows, columns = np.indices(grid.shape)
    return np.column_stack([columns.ravel(), rows.ravel()]) + 0.5


@shared
@given(grid=grids(), radius=st.floats(1e-6, 4), inside=st.tuples(st.floats(0, 1), st.floats(0, 1)))
def test_free_cells_of_an_inflated_grid_keep_their_clearance_everywhere(grid, radius, inside, gap_to_squares):
    cells = np.argwhere(~inflated(grid, radius).blocked)[:, ::-1] + np.array(inside)
    if len(cells):
        assert gap_to_squares(grid, cells).min() >= radius * (1 - 1e-8)


@shared
@given(grid=grids(), radius=st.floats(0.01, 4))
def test_no_cell_is_blocked_without_need(grid, radius, gap_to_squares):
    """A cell that inflation blocks was blocked, or one of its points is too near."""
    fine = np.linspace(0, 1, 5)
    for row, column in np.argwhere(inflated(grid, radius).blocked & ~grid.blocked):
        places = np.array([(column + x, row + y) for x in fine for y in fine])
        assert gap_to_squares(grid, places).min() < radius


@shared
@given(grid=grids())
def test_the_field_is_the_distance_from_centres_to_squares(grid, gap_to_squares):
    np.testing.assert_allclose(distance_field(grid).ravel(), gap_to_squares(grid, centres(grid)), atol=1e-12)


@shared
@given(grid=grids(), places=st.lists(st.tuples(st.floats(-1, 13), st.floats(-1, 10)), min_size=1, max_size=6))
def test_clearance_of_points_is_exact(grid, places, gap_to_squares):
    cells = np.array(places)
    found = clearance_to_blocked(grid)(grid.to_map(cells))
    np.testing.assert_allclose(found, gap_to_squares(grid, cells), atol=1e-9)


def test_a_radius_of_whole_cells_blocks_whole_cells():
    """3 x 0.05 is not 0.15 in float64: a body of 0.15 m still needs three cells and not four."""
    blocked = np.zeros((21, 21), dtype=bool)
    blocked[10, 10] = True
    free = ~inflated(Grid(blocked, 0.05), 0.15).blocked
    assert list(np.flatnonzero(~free[10, 4:17]) + 4) == list(range(7, 14))
    assert free[4:17, 4:17].sum() == 13 * 13 - 7 * 7  # 2.83 cells to the corner ones


def test_radius_0_changes_nothing():
    grid = Grid(np.eye(4, dtype=bool), 1.0)
    assert inflated(grid, 0.0) is grid


@given(seed=st.integers(0, 10**6), trim=st.sampled_from([0.0, 0.5, 1.0]))
def test_squared_distances_by_definition(seed, trim):
    random = np.random.default_rng(seed)
    blocked = random.random((random.integers(1, 8), random.integers(1, 8))) < 0.2
    found = np.empty(blocked.shape)
    squared_distances(blocked, trim, found)
    places = np.argwhere(blocked)
    for at in np.ndindex(*blocked.shape):
        gaps = np.maximum(np.abs(places - at) - trim, 0) ** 2
        assert found[at] == (gaps.sum(axis=1).min() if len(places) else np.inf)


def test_squared_distances_refuses_what_does_not_fit():
    with pytest.raises(ValueError, match="squared"):
        squared_distances(np.zeros((2, 2), dtype=bool), 0.0, np.zeros((2, 3)))
    with pytest.raises(ValueError, match="trim"):
        squared_distances(np.zeros((2, 2), dtype=bool), 1.5, np.zeros((2, 2)))
