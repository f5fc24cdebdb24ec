"""Which points are free, borders included."""

import numpy as np
import shapely

from muster.motion.free_space import GridSpace, PolygonSpace, Prism, PrismSpace
from muster.motion.grid import Grid
from muster.motion.maps import free


def test_in_a_grid_the_border_of_a_free_cell_is_free():
    blocked = np.ones((3, 3), dtype=bool)
    blocked[1, 1] = False
    space = GridSpace(Grid(blocked, 0.1, (5.0, 5.0, 0.0)))
    points = [(5.15, 5.15), (5.1, 5.1), (5.2, 5.2), (5.1, 5.15), (5.0999, 5.15), (5.2001, 5.15), (4, 5), (9, 9)]
    assert free(space, np.array(points)).tolist() == [True] * 4 + [False] * 4


def test_the_outer_border_of_a_grid_is_free():
    space = GridSpace(Grid(np.zeros((2, 2), dtype=bool), 1.0))
    assert free(space, np.array([(0, 0), (2, 2), (2, 1), (2.001, 1), (-0.001, 1)])).tolist() == [True] * 3 + [False] * 2


def test_in_a_region_the_border_is_free():
    space = PolygonSpace(shapely.box(0, 0, 4, 4).difference(shapely.box(1, 1, 2, 2)))
    points = [(0.5, 0.5), (0, 0), (1, 1.5), (1.5, 1.5), (4.001, 1), (4 + 1e-10, 1)]
    assert free(space, np.array(points)).tolist() == [True, True, True, False, False, True]


def test_heights_do_not_count_in_a_region():
    assert free(PolygonSpace(shapely.box(0, 0, 4, 4)), np.array([(1, 1, -50.0)])).all()


def test_in_the_air_the_faces_of_prisms_are_free():
    prism = Prism(shapely.box(1, 1, 2, 2), -np.inf, 3.0)
    space = PrismSpace(shapely.box(0, 0, 4, 4), (prism,), lowest_m=0.0)
    points = [
        (1.5, 1.5, 2.9),
        (1.5, 1.5, 3.0),
        (1.5, 1.5, 9.0),
        (1.0, 1.5, 1.0),
        (0.5, 0.5, 0.0),
        (0.5, 0.5, -0.1),
        (5, 1, 1),
    ]
    assert free(space, np.array(points)).tolist() == [False, True, True, True, True, False, False]


def test_no_points_are_no_answer():
    assert free(PolygonSpace(shapely.box(0, 0, 1, 1)), np.empty((0, 2))).shape == (0,)
    assert free(GridSpace(Grid(np.zeros((2, 2), dtype=bool), 1.0)), np.empty((0, 2))).shape == (0,)
