"""The shipped maps: drawn as their script says, and every place on them free and within reach."""

import runpy
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from muster.library import mission_path
from muster.mission.reading.yaml_reader import read_yaml

pytestmark = pytest.mark.skipif(find_spec("shapely") is None, reason="needs the extra `map`")

ROOT = Path(__file__).parents[2]
MAPS = ROOT / "src" / "muster" / "library" / "maps"


def checked(name):
    from muster.motion.unreachable_places import checked_world

    mission = read_yaml(mission_path(name))
    return mission, checked_world(mission)


def test_the_floor_plan_is_the_one_its_script_draws(tmp_path):
    from PIL import Image

    runpy.run_path(str(ROOT / "tools" / "draw_floor.py"))["main"](tmp_path)
    for name in ("floor-plan.png", "floor-plan.yaml"):
        assert (tmp_path / name).is_file()
    with Image.open(tmp_path / "floor-plan.png") as drawn, Image.open(MAPS / "floor-plan.png") as kept:
        np.testing.assert_array_equal(np.asarray(drawn), np.asarray(kept))
    assert (tmp_path / "floor-plan.yaml").read_text() == (MAPS / "floor-plan.yaml").read_text()


def test_on_the_floor_each_robot_reaches_every_place_it_may_stand_at():
    from scipy.ndimage import label

    mission, world = checked("floor")
    assert world.image.shape == (540, 840)
    for robot in mission.robots:
        grid = world.free_space(robot.radius_m, robot.kind).grid
        parts, _ = label(~grid.blocked)
        places = np.array([robot.position, *(task.position for task in mission.tasks)])
        column, row = np.floor(grid.to_grid(places)).astype(int).T
        assert set(parts[row, column]) - {0} == {parts[row[0], column[0]]}
        left_out = [mission.tasks[k - 1].id for k in np.flatnonzero(grid.blocked[row, column])]
        assert left_out == (["corridor"] if robot.kind == "air" else [])


def test_in_the_yard_rovers_drive_around_what_drones_fly_over():
    import shapely

    mission, world = checked("yard")
    assert mission.dimensions == 3
    ground, air = world.free_space(0.4, "ground"), world.free_space(0.3, "air")
    assert isinstance(ground.region, shapely.Polygon)
    assert [(p.floor_m, p.ceiling_m) for p in air.prisms] == [
        (-np.inf, pytest.approx(4.3)),
        (-np.inf, pytest.approx(6.3)),
        (-np.inf, pytest.approx(3.3)),
        (-np.inf, np.inf),
    ]
    for prism in air.prisms[:3]:
        assert not shapely.intersects(ground.region, shapely.Point(*prism.polygon.representative_point().coords))
    assert shapely.intersects(ground.region, shapely.Point(50, 9))
