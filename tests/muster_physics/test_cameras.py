"""Cameras of the physics world: tags are detected where they lie, and buildings hide what is behind them."""

import math
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
from tests.simulation.scenes import mission, robot

if find_spec("mujoco") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)
pytest.importorskip("shapely", reason="needs the extra `map`")

from muster.mission.model import Map, Tag, Zone
from muster.perception.camera import Intrinsics, View, mount_of
from muster.perception.camera_observer import CameraObserver
from muster.perception.detection import TagDetector
from muster.simulation.cameras import GeometricCameras
from muster_physics import PhysicsWorld
from muster_physics.optional_parts import BACKENDS, _is_there
from muster_physics.rendered_cameras import RenderedCameras

if not any(map(_is_there, BACKENDS.values())):
    pytest.skip("neither EGL nor OSMesa is installed", allow_module_level=True)

VGA = Intrinsics.of_view(640, 480, math.radians(60))
DOWN = mount_of([0, 0, 0, 0, math.radians(45), 0])
TAGS = (
    Tag(id=3, position=(4.0, 0.5)),
    Tag(id=17, position=(3.0, -0.8), heading_deg=75),
    Tag(id=586, position=(5.0, -0.4), heading_deg=-160, size_m=0.6),
)
HOUSE = Zone(polygon=((2.0, -1.5), (2.4, -1.5), (2.4, 0.0), (2.0, 0.0)), ceiling_m=1.9)
BODY = [0.0, 0.0, 3.0, 0.0, 0.0, 0.0]


def scene(*, tags=TAGS, zones=()):
    plain = mission(robot(position=(-5.0, -5.0), radius_m=0.3))
    walled = Map(boundary=((-9, -9), (9, -9), (9, 9), (-9, 9)), zones=zones)
    return replace(plain, tags=tags, map=walled, rules=replace(plain.rules, travel="map"))


def look(sight, body=BODY):
    eye = CameraObserver(robot="d", intrinsics=VGA, mount=DOWN, detector=TagDetector())
    return sight.look(eye, View.from_body(VGA, body, DOWN), body, 0.0)


@pytest.fixture
def sight():
    """Of the scene without a building."""
    drawn = RenderedCameras(PhysicsWorld(scene()))
    yield drawn
    drawn.close()


def test_tags_are_detected_where_they_lie(sight):
    seen = look(sight)
    assert seen.image.shape == (480, 640, 3)
    assert seen.observation.estimates.tags.tolist() == [3, 17, 586]
    off = seen.observation.estimates.positions - [tag.position for tag in TAGS]
    assert np.linalg.norm(off, axis=1).max() < 0.01


def test_what_is_drawn_and_what_geometry_has_are_the_same(sight):
    drawn = look(sight).observation.sightings.all
    exact = look(GeometricCameras(TAGS, seed=0, corner_px=0.0)).observation.sightings.all
    for one, other in zip(drawn, exact, strict=True):
        assert one.tag == other.tag
        assert one.corners == pytest.approx(other.corners, abs=1.0)


@pytest.mark.parametrize("zone", [HOUSE, replace(HOUSE, floor_m=1.0, ceiling_m=None)])
def test_buildings_hide_what_is_behind_them(zone):
    drawn = RenderedCameras(PhysicsWorld(scene(zones=(zone,))))
    assert look(drawn).observation.estimates.tags.tolist() == [3]
    drawn.close()


@pytest.mark.parametrize("zone", [replace(HOUSE, forbidden_to=("air",)), replace(HOUSE, ceiling_m=0.1)])
def test_zones_for_one_kind_and_low_ones_hide_nothing(zone):
    drawn = RenderedCameras(PhysicsWorld(scene(zones=(zone,))))
    assert look(drawn).observation.estimates.tags.tolist() == [3, 17, 586]
    drawn.close()


def test_a_roof_of_any_shape_covers_what_is_inside():
    """An L: the tag in its foot is covered, the one in its corner is not."""
    corner = ((2, -2), (5, -2), (5, -1), (3, -1), (3, 2), (2, 2))
    tags = (Tag(id=1, position=(4.5, -1.5)), Tag(id=2, position=(4.0, 0.0)))
    drawn = RenderedCameras(PhysicsWorld(scene(tags=tags, zones=(Zone(polygon=corner, ceiling_m=0.05),))))
    assert look(drawn).observation.estimates.tags.tolist() == [2]
    drawn.close()


def test_tags_of_one_id_twice_are_both_there():
    drawn = RenderedCameras(PhysicsWorld(scene(tags=(Tag(id=8, position=(3, 0.5)), Tag(id=8, position=(3, -0.7))))))
    seen = look(drawn).observation
    assert seen.sightings.repeated == (8,)
    assert seen.remarks == ("d at 0.00 s: tag 8 is twice in one image",)
    drawn.close()


def test_tags_hinder_nobody():
    model = PhysicsWorld(scene()).simulated.model
    plain = PhysicsWorld(scene(tags=())).simulated.model
    touching = [int(np.count_nonzero(m.geom_contype | m.geom_conaffinity)) for m in (model, plain)]
    assert touching[0] == touching[1]
    assert model.ngeom == plain.ngeom + len(TAGS)
