"""Shared paths in metres: on maps of both kinds, without contact by an exact measure."""

import math

import numpy as np
import pytest
import shapely

from muster.mission.errors import ParameterError
from muster.motion.free_space import GridSpace, PolygonSpace, PrismSpace
from muster.motion.grid import Grid
from muster.motion.maps.free_points import free
from muster.traffic.shared_paths import SharedPaths, shared_paths
from muster.traffic.space_time import NotTogether

ROOM = PolygonSpace(shapely.box(0, 0, 12, 8).difference(shapely.box(5, 0, 7, 3).union(shapely.box(5, 5, 7, 8))))
ENDS = {f"r{k}": ((1, 1 + 2 * k), (11, 7 - 2 * k)) if k % 2 else ((11, 1 + 2 * k), (1, 7 - 2 * k)) for k in range(4)}


def fine_grid():
    cells = np.argwhere(np.ones((160, 240), dtype=bool))[:, ::-1] * 0.05 + 0.025
    blocked = ~shapely.contains_xy(ROOM.region, *cells.T).reshape(160, 240)
    return GridSpace(Grid(blocked, 0.05))


@pytest.mark.parametrize("space", [ROOM, fine_grid()], ids=["region", "grid"])
@pytest.mark.parametrize("cell", [None, 0.6])
def test_robots_that_change_sides_do_not_touch(space, cell):
    found = shared_paths(space, ENDS, radius_m=0.2, speed_mps=0.5, cell_m=cell)
    assert isinstance(found, SharedPaths)
    assert found.neighbours == (8 if cell is None else 4)
    assert found.least_distance_m() >= 0.4
    assert found.positions[0].tolist() == [list(map(float, start)) for start, _ in ENDS.values()]
    assert found.positions[-1].tolist() == [list(map(float, goal)) for _, goal in ENDS.values()]
    speeds = np.linalg.norm(np.diff(found.positions, axis=0), axis=2) / np.diff(found.times_s)[:, None]
    assert speeds.max() <= 0.5 + 1e-9
    between = (
        found.positions[:-1, None]
        + np.linspace(0, 1, 9)[None, :, None, None] * np.diff(found.positions, axis=0)[:, None]
    )
    assert free(space, between.reshape(-1, 2)).all()
    assert (found.arrivals_s() <= found.times_s[-1]).all()
    assert (found.lengths_m() >= [math.dist(*ends) for ends in ENDS.values()]).all()


def test_points_without_radius_get_cells_of_the_map():
    found = shared_paths(ROOM, {"one": ((1, 1), (11, 7))}, radius_m=0.0)
    assert found.cell_m == pytest.approx(0.2)
    assert found.least_distance_m() == math.inf


def test_a_door_too_narrow_for_the_cells_is_told():
    narrow = PolygonSpace(
        shapely.union_all([shapely.box(0, 0, 4, 8), shapely.box(4, 3.8, 6, 4.2), shapely.box(6, 0, 10, 8)])
    )
    found = shared_paths(narrow, {"one": ((1, 1), (9, 7))}, radius_m=0.2)
    assert isinstance(found, NotTogether)
    assert found.reason.startswith("its goal is not connected with its start (cells of 0.89")


def test_what_is_wrong_is_named():
    with pytest.raises(ParameterError, match=r"cell_m: 0.5; expected at least 0.566"):
        shared_paths(ROOM, ENDS, radius_m=0.2, cell_m=0.5)
    with pytest.raises(ParameterError, match="with heights"):
        shared_paths(PrismSpace(shapely.box(0, 0, 1, 1), ()), ENDS, radius_m=0.2)
    found = shared_paths(ROOM, {"lost": ((6, 1), (1, 1))}, radius_m=0.1)
    assert found == NotTogether("lost", found.reason)
    assert "is beside its start" in found.reason
