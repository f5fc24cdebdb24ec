"""Random maps for the tests of paths."""

import numpy as np
import shapely
from hypothesis import strategies as st

from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid


@st.composite
def grids(draw, most=7):
    """A grid of cells of 1 m, up to half of them blocked."""
    rows, columns = draw(st.integers(1, most)), draw(st.integers(1, most))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return GridSpace(Grid(rng.random((rows, columns)) < draw(st.sampled_from((0.1, 0.25, 0.4, 0.5))), 1.0))


@st.composite
def places_on(draw, space, count):
    """Points on quarters of cells: corners and borders come up often."""
    rows, columns = space.grid.shape
    return [(draw(st.integers(0, 4 * columns)) / 4, draw(st.integers(0, 4 * rows)) / 4) for _ in range(count)]


@st.composite
def regions(draw):
    """One polygon: a room of 16 m x 12 m without up to four convex obstacles, on a lattice of 2^-10 m."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    region = shapely.box(0, 0, 16, 12)
    for _ in range(draw(st.integers(1, 4))):
        obstacle = shapely.MultiPoint(rng.integers(0, 17, (int(rng.integers(3, 7)), 2))).convex_hull
        if obstacle.area > 0:
            region = region.difference(obstacle)
    region = shapely.set_precision(region, 2.0**-10)
    parts = [part for part in shapely.get_parts(region) if part.area > 0]
    largest = max(parts, key=lambda part: part.area) if parts else shapely.box(0, 0, 16, 12)
    return PolygonSpace(shapely.set_precision(largest, 0))  # the points as they are, of which buffers may be made


@st.composite
def places_in(draw, count):
    return [(draw(st.integers(0, 64)) / 4, draw(st.integers(0, 48)) / 4) for _ in range(count)]
