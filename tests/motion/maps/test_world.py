"""A mission's map: what is free for whom."""

import pickle

import numpy as np
import pytest
import shapely
from PIL import Image

from muster.mission.errors import MissionError, ParameterError
from muster.motion.free_space import GridSpace, PolygonSpace, PrismSpace
from muster.motion.map_world import World
from muster.motion.maps import free

SQUARE = "boundary: [[0, 0], [10, 0], [10, 10], [0, 10]]"
ZONE = "polygon: [[4, 4], [6, 4], [6, 6], [4, 6]]"
FLAT, TALL = "[{id: r_0, position: [1, 1]}]", "[{id: r_0, position: [1, 1, 0]}]"


def at(*points):
    return np.array(points, dtype=float)


@pytest.mark.parametrize(
    ("kinds", "ground", "air"), [("[ground]", False, True), ("[air]", True, False), ("[ground, air]", False, False)]
)
def test_zones_hold_for_the_kinds_they_are_forbidden_to(mission_with, kinds, ground, air):
    world = World.of(mission_with(f"{{{SQUARE}, zones: [{{{ZONE}, forbidden_to: {kinds}}}]}}"))
    for kind, expected in (("ground", ground), ("air", air)):
        space = world.free_space(0.5, kind)
        assert isinstance(space, PolygonSpace)
        assert free(space, at((5, 5))).tolist() == [expected]
        assert free(space, at((0.4, 5), (0.5, 5), (11, 5))).tolist() == [False, True, False]
        assert free(space, at((3.6, 5))).tolist() == [expected]


def test_the_same_body_gets_the_same_space(mission_with):
    world = World.of(mission_with(f"{{{SQUARE}}}"))
    assert world.free_space(0.5, "ground") is world.free_space(0.5, "ground")
    assert world.free_space(0.5, "ground") is not world.free_space(0.4, "ground")


@pytest.mark.parametrize(
    ("heights", "low", "high"),
    [
        ("", False, False),
        (", floor_m: 1.5", True, False),
        (", ceiling_m: 3", False, True),
        (", floor_m: 1.5, ceiling_m: 3", True, True),
        (", floor_m: 0, ceiling_m: 3", False, True),
    ],
)
def test_drones_pass_over_and_below(mission_with, heights, low, high):
    world = World.of(mission_with(f"{{{SQUARE}, zones: [{{{ZONE}{heights}}}]}}", TALL))
    space = world.free_space(0.5, "air")
    assert isinstance(space, PrismSpace)
    assert free(space, at((5, 5, 0), (5, 5, 1), (5, 5, 2), (5, 5, 3.5), (5, 5, 9))).tolist() == [
        low,
        low,
        False,
        high,
        high,
    ]
    assert free(space, at((1, 1, 0), (1, 1, -0.1), (1, 1, 99), (3.6, 5, 2))).tolist() == [True, False, True, False]


def test_the_ground_is_as_low_as_the_lowest_place(mission_with):
    world = World.of(
        mission_with(f"{{{SQUARE}}}", TALL, "[{id: 1, position: [1, 1, -3]}, {id: 2, position: [1, 1, 5]}]")
    )
    assert world.free_space(0.5, "air").lowest_m == -3


@pytest.mark.parametrize(
    ("floor", "radius", "stopped"), [(1.0, 0.4, False), (1.0, 0.5, True), (0.0, 0.0, True), (0.1, 0.0, False)]
)
def test_a_ground_robot_passes_below_what_is_higher_than_itself(mission_with, floor, radius, stopped):
    zones = f"zones: [{{{ZONE}, floor_m: {floor}, ceiling_m: 4}}]"
    world = World.of(mission_with(f"{{{SQUARE}, {zones}}}", TALL))
    space = world.free_space(radius, "ground")
    assert isinstance(space, PolygonSpace)
    assert free(space, at((5, 5, 0))).tolist() == [not stopped]
    assert (world.clearance(at((5, 5, 0)), "ground", radius)[0] == 0) == stopped
    flat = World.of(mission_with(f"{{{SQUARE}, {zones}}}", FLAT)).free_space(radius, "ground")
    assert not free(flat, at((5, 5))).any()


def test_clearance_of_polygons(mission_with):
    world = World.of(mission_with(f"{{{SQUARE}, zones: [{{{ZONE}, forbidden_to: [air]}}]}}"))
    points = at((5, 5), (3, 5), (1, 5), (3, 3), (-1, 5), (10, 5))
    np.testing.assert_allclose(world.clearance(points, "air"), [0, 1, 1, 2**0.5, 0, 0])
    np.testing.assert_allclose(world.clearance(points, "ground"), [5, 3, 1, 3, 0, 0])


def test_clearance_in_space(mission_with):
    world = World.of(mission_with(f"{{{SQUARE}, zones: [{{{ZONE}, floor_m: 2, ceiling_m: 4}}]}}", TALL))
    points = at((5, 5, 5), (5, 5, 1.5), (3, 5, 5), (5, 5, 3), (5, 5, 99))
    np.testing.assert_allclose(world.clearance(points, "air"), [1, 0.5, 2**0.5, 0, 5])


def image(folder, blocked):
    """A floor whose cells are blocked as given, the lowest row first."""
    Image.fromarray(np.where(blocked[::-1], 0, 255).astype(np.uint8)).save(folder / "floor.png")


def test_an_image_is_a_grid_with_its_zones(mission_with, tmp_path):
    image(tmp_path, np.zeros((20, 30), dtype=bool))
    chart = "{image: floor.png, resolution_m: 0.5, zones: [{polygon: [[4.1, 4], [6, 4], [6, 6]], forbidden_to: [air]}]}"
    for robots in (FLAT, TALL):
        world = World.of(mission_with(chart, robots))
        air, ground = world.free_space(0.0, "air"), world.free_space(0.0, "ground")
        assert isinstance(air, GridSpace)
        assert not ground.grid.blocked.any()
        zone = shapely.Polygon([(4.1, 4), (6, 4), (6, 6)])
        for row, column in np.ndindex(20, 30):
            cell = shapely.box(column / 2, row / 2, column / 2 + 0.5, row / 2 + 0.5)
            assert air.grid.blocked[row, column] == (cell.intersection(zone).area > 1e-9)


def test_zones_are_cells_of_a_turned_image_too(mission_with, tmp_path):
    image(tmp_path, np.zeros((20, 30), dtype=bool))
    zones = "zones: [{polygon: [[1, 3], [6, 4], [3, 8]]}]"
    world = World.of(mission_with(f"{{image: floor.png, resolution_m: 0.5, origin: [2, -1, 0.6], {zones}}}"))
    grid, zone = world.free_space(0.0, "air").grid, shapely.Polygon([(1, 3), (6, 4), (3, 8)])
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=float)
    for row, column in np.ndindex(20, 30):
        cell = shapely.Polygon(grid.to_map(corners + np.array((column, row))))
        assert grid.blocked[row, column] == (cell.intersection(zone).area > 1e-9)


@pytest.mark.parametrize("kind", ["ground", "air"])
@pytest.mark.parametrize("radius", [5.1, 1e9, 1e300])
def test_a_body_larger_than_the_map_is_nowhere(mission_with, tmp_path, kind, radius):
    image(tmp_path, np.zeros((100, 100), dtype=bool))
    for chart in (f"{{{SQUARE}, zones: [{{{ZONE}}}]}}", "{image: floor.png, resolution_m: 0.1}"):
        for robots in (FLAT, TALL):
            space = World.of(mission_with(chart, robots)).free_space(radius, kind)
            assert not free(space, at((5, 5, 5), (1, 1, 0))).any()


def test_a_world_that_was_used_can_be_sent_to_another_process(mission_with, tmp_path):
    image(tmp_path, np.eye(20, dtype=bool))
    world = World.of(mission_with("{image: floor.png, resolution_m: 0.5}"))
    points = at((1, 5), (5, 1))
    metres = world.clearance(points, "ground")
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(world)).clearance(points, "ground"), metres)


def test_free_space_and_clearance_of_an_image_agree(mission_with, tmp_path):
    random = np.random.default_rng(5)
    image(tmp_path, random.random((40, 40)) < 0.03)
    world = World.of(mission_with("{image: floor.png, resolution_m: 0.1, origin: [-1, -2, 0.3]}"))
    grid = world.free_space(0.3, "ground").grid
    inside = np.argwhere(~grid.blocked)[:, ::-1] + random.random((int((~grid.blocked).sum()), 2))
    assert len(inside) > 100
    assert world.clearance(grid.to_map(inside), "ground").min() >= 0.3 - 1e-9


def test_all_faults_of_a_map_at_once(mission_with, tmp_path):
    rings = "[[0, 0], [4, 4], [4, 0], [0, 4]]", "[[1, 1], [2, 2], [3, 3]]", "[[50, 0], [60, 0], [60, 9]]"
    zones = f"zones: [{', '.join(f'{{polygon: {ring}}}' for ring in rings)}]"
    with pytest.raises(MissionError) as caught:
        World.of(mission_with(f"{{boundary: [[0, 0], [9, 9], [9, 0], [0, 9]], {zones}}}"))
    expected = "a polygon whose sides meet at its corners alone"
    assert str(caught.value).replace(f"{tmp_path}/", "").splitlines() == [
        f"m.yaml:4: map.boundary: crosses itself at (4.5, 4.5); expected {expected}",
        f"m.yaml:4: map.zones[0].polygon: crosses itself at (2, 2); expected {expected}",
        f"m.yaml:4: map.zones[1].polygon: corners on one line; expected {expected}",
    ]


def test_a_mission_without_a_map(mission_with):
    with pytest.raises(ParameterError, match="no map"):
        World.of(mission_with("null"))
