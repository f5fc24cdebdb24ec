"""The action `coverage`: what a camera sees on the way, who can do it, and what it costs."""

import math
import re

import numpy as np
import pytest
import shapely

from muster.mission.model import Action, Camera, Robot, Task
from muster.motion.actions import Impossible, TaskMotion, plan
from muster.motion.actions.footprint import footprint_of
from muster.motion.actions.unseen_places import seen

AREA = ((0, 0), (60, 5), (70, 40), (35, 25), (5, 45))
HOLE = ((20, 10), (30, 10), (28, 18))
CAMERAS = [
    Camera(fov_deg=60, tilt_deg=90),
    Camera(fov_deg=50, tilt_deg=90, height_px=200),
    Camera(fov_deg=60, tilt_deg=50),
    Camera(fov_deg=80, tilt_deg=70, mount=(0.3, 0.4, -0.1)),
]


def task(position=(30, 20), **keys):
    return Task(id="field", position=position, action=Action(name="coverage", **{"area": AREA, **keys}))


def drone(**own):
    return Robot(id="d", position=(0, 0), kind="air", **own)


def grid(step=0.7):
    """Places inside the area without its hole."""
    surface = shapely.Polygon(AREA, [HOLE])
    x, y = np.meshgrid(np.arange(0, 71, step), np.arange(0, 46, step))
    places = np.column_stack([x.ravel(), y.ravel()])
    return places[shapely.contains_xy(surface, *places.T)]


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("height", [4, 9])
def test_a_camera_sees_every_place(camera, height):
    motion = plan(task(holes=(HOLE,), cross_holes=True, height_m=height), drone(camera=camera))
    assert isinstance(motion, TaskMotion)
    assert seen(motion.waypoints, footprint_of(camera, height), grid()).all()


def test_parts_of_an_area_see_every_place_together():
    camera = CAMERAS[0]
    parts = [plan(task(holes=(HOLE,), height_m=5, split=3, part=k), drone(camera=camera)) for k in (1, 2, 3)]
    whole = plan(task(holes=(HOLE,), height_m=5), drone(camera=camera))
    found = np.array([seen(part.waypoints, footprint_of(camera, 5), grid()) for part in parts])
    assert found.any(axis=0).all()
    assert not found.all(axis=1).any()
    costs = [part.cost_m for part in parts]
    assert sum(costs) <= whole.cost_m * (1 + 1e-9)
    assert max(costs) <= 1.06 * sum(costs) / 3


def test_the_cost_is_the_length_of_the_way_and_the_ends_differ():
    motion = plan(task(width_m=3), Robot(id="r", position=(0, 0)))
    points = np.array(motion.points)
    assert motion.cost_m == pytest.approx(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    assert motion.entry == tuple(points[0])
    assert motion.exit == tuple(points[-1])
    assert motion.entry != motion.exit


def test_lanes_are_as_far_apart_as_the_picture_is_wide_less_the_overlap():
    square = ((0, 0), (40, 0), (40, 40), (0, 40))
    wide = 2 * 10 * math.tan(math.radians(30))
    for keys in ({"fov_deg": 60, "height_m": 10, "overlap": 0.5}, {"width_m": wide / 2}):
        motion = plan(task(area=square, **keys), drone())
        assert len(motion.points) == 2 * math.ceil(40 / (wide / 2))


def test_heights_are_above_the_position():
    motion = plan(task(position=(30, 20, 5), height_m=12, fov_deg=60), drone())
    assert {point[2] for point in motion.points} == {17}
    assert {way_point.position[2] for way_point in plan(task(height_m=12, fov_deg=60), drone()).waypoints} == {0}


@pytest.mark.parametrize(
    ("robot", "keys", "reason"),
    [
        (drone(), {"height_m": 5}, "it has no camera from which the distance of lanes follows"),
        (drone(camera=Camera(fov_deg=60)), {"height_m": 5}, "does not look down"),
        (drone(camera=CAMERAS[2]), {"height_m": 4, "holes": (HOLE,)}, r"would fly over holes\[0\]"),
        (drone(), {"width_m": 1e-4}, "lanes; expected at most 10000"),
        (Robot(id="r", position=(0, 0, 0)), {"position": (0, 0, 0), "height_m": 5, "fov_deg": 60}, "a ground robot"),
    ],
)
def test_who_cannot_do_it(robot, keys, reason):
    found = plan(task(**keys), robot)
    assert isinstance(found, Impossible)
    assert re.search(reason, found.reason)
