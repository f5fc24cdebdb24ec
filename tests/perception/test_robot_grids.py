"""Robots' own occupancy grids in the cells of the team's map, and merged into it."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.mission.model import Map, Mission, Robot, Task
from muster.motion.grid import Grid
from muster.motion.map_world import Body, World
from muster.perception.robot_grids import FREE, OCCUPIED, RobotGrid, SeenCells, in_cells_of
from muster.perception.team_map import TeamMap

FRAME = Grid(np.zeros((14, 18), dtype=bool), 0.25, (-1.0, 2.0, 0.0))
GRIDS = st.builds(
    lambda seed, cell_m, x, y, yaw: RobotGrid.of(
        np.random.default_rng(seed).choice(np.array([-1, 0, 10, 50, 80, 100], dtype=np.int8), 35),
        (5, 7),
        cell_m,
        (x, y, yaw),
    ),
    st.integers(0, 999),
    st.floats(0.05, 1.0),
    st.floats(-2.0, 3.0),
    st.floats(1.0, 5.0),
    st.floats(-math.pi, math.pi),
)


def squares(cells):
    """The cells of a grid as squares on the map, by rows and columns."""
    rows, columns = cells.shape
    column, row = np.meshgrid(np.arange(columns), np.arange(rows))
    corners = np.stack([(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)]).reshape(4, 2, -1)
    flat = cells.to_map(corners.transpose(2, 0, 1).reshape(-1, 2).astype(float)).reshape(-1, 4, 2)
    return shapely.polygons(flat).reshape(cells.shape)


@given(GRIDS)
def test_an_obstacle_is_in_every_cell_that_it_reaches_into_and_in_no_other(grid):
    found = in_cells_of(FRAME, grid)
    obstacles = shapely.union_all(squares(grid.cells)[grid.cells.blocked])
    shared = shapely.area(shapely.intersection(squares(FRAME), obstacles))
    assert found.occupied[shared > 0.2 * min(FRAME.resolution_m, grid.cells.resolution_m) ** 2].all()
    assert (shapely.distance(squares(FRAME)[found.occupied], obstacles) < 1e-9).all()


@given(GRIDS)
def test_a_cell_is_free_where_its_centre_is_unless_an_obstacle_reaches_into_it(grid):
    found = in_cells_of(FRAME, grid)
    free = shapely.union_all(squares(grid.cells)[grid.free])
    inside = shapely.contains(shapely.buffer(free, 1e-9), shapely.centroid(squares(FRAME)))
    assert not (found.free & found.occupied).any()
    assert (found.free == (inside & ~found.occupied)).all()


def test_what_is_neither_likely_nor_unlikely_is_unknown():
    values = np.array([-1, 0, FREE - 1, FREE, OCCUPIED - 1, OCCUPIED, 100], dtype=np.int8)
    grid = RobotGrid.of(values, (1, 7), 1.0, (0.0, 0.0, 0.0))
    assert grid.free[0].tolist() == [False, True, True, False, False, False, False]
    assert grid.cells.blocked[0].tolist() == [False, False, False, False, False, True, True]


@pytest.mark.parametrize(
    ("how", "named"),
    [
        ({"cell_m": 0.0}, "resolution: 0; expected metres above 0"),
        ({"cell_m": math.nan}, "resolution: nan"),
        ({"size": (0, 6)}, "height, width: 0, 6; expected 1 to"),
        ({"size": (2, 2)}, "data: 6 cells; expected 2 rows of 2"),
        ({"size": (100_000, 100_000)}, "height, width: 100000, 100000"),
        ({"origin": (0.0, math.inf, 0.0)}, "origin: 0.0, inf, 0.0"),
    ],
)
def test_what_is_no_grid_is_refused(how, named):
    given = {"size": (2, 3), "cell_m": 0.1, "origin": (0.0, 0.0, 0.0)} | how
    with pytest.raises(ParameterError, match=named):
        RobotGrid.of(np.zeros(6, dtype=np.int8), **given)


def team(*kinds):
    robots = tuple(Robot(id=f"r_{k}", position=(1.0, 1.0 + k), radius_m=0.4, kind=kind) for k, kind in enumerate(kinds))
    chart = Map(boundary=((0.0, 0.0), (8.0, 0.0), (8.0, 4.0), (0.0, 4.0)))
    mission = Mission(map=chart, robots=robots, tasks=(Task(id="t", position=(7.0, 1.0)),))
    return TeamMap(World.of(mission), mission, fills_cells=True)


def wall(team_map, height_m=3.0):
    """A map with a wall across the middle, and free ground elsewhere."""
    frame = team_map.ground.seen.frame
    x, y = frame.to_map(np.argwhere(np.ones(frame.shape))[:, ::-1] + 0.5).T
    occupied = ((np.abs(x - 4.0) < 0.15) & (y < height_m)).reshape(frame.shape)
    return SeenCells(occupied, ~occupied)


def merged(team_map, *maps):
    team_map.begin_look()
    team_map.merge(maps)
    return team_map.end_look()


GROUND, AIR = Body(0.4, "ground"), Body(0.4, "air")


def test_the_way_leads_round_what_any_robot_has_in_its_map_and_straight_once_none_has():
    team_map = team("ground", "ground")
    way = lambda: team_map.of(GROUND).way(GROUND, (1.0, 1.0), (7.0, 1.0))  # noqa: E731
    seen, nothing = wall(team_map), wall(team_map, 0.0)
    assert way().length_m == pytest.approx(6.0)
    assert merged(team_map, (GROUND, seen), (GROUND, nothing))
    assert team_map.is_closed(GROUND, np.array([[1.0, 1.0], [7.0, 1.0]]))
    assert not merged(team_map, (GROUND, seen), (GROUND, seen))  # nothing new
    assert not team_map.is_closed(GROUND, np.array([[1.0, 1.0], [7.0, 1.0]]))
    points = way().points
    assert (
        shapely.LineString(points).distance(shapely.union_all(squares(team_map.ground.seen.frame)[seen.occupied]))
        >= 0.4 - 1e-6
    )
    assert merged(team_map, (GROUND, nothing), (GROUND, nothing))
    assert way().length_m == pytest.approx(6.0)


def test_what_robots_on_the_ground_map_stops_none_in_the_air_and_the_other_way_round_it_does():
    team_map = team("ground", "air")
    straight = np.array([[1.0, 1.0], [7.0, 1.0]])
    merged(team_map, (GROUND, wall(team_map)))
    assert [team_map.is_closed(body, straight) for body in (GROUND, AIR)] == [True, False]
    team_map = team("ground", "air")
    merged(team_map, (AIR, wall(team_map)))
    assert [team_map.is_closed(body, straight) for body in (GROUND, AIR)] == [True, True]
