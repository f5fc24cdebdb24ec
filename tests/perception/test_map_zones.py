"""The zones of a voxel map cover what is occupied: all of it, and nothing else as long as they are few."""

import numpy as np
import pytest

from muster.motion.voxels import VoxelFrame
from muster.perception import map_zones
from muster.perception.map_zones import zones_of
from muster.perception.voxel_map import VoxelMap

FRAME = VoxelFrame((9, 10, 11), 0.5, (2.0, -1.0, 0.0))


def covered(zones):
    centres = FRAME.centres(np.argwhere(np.ones(FRAME.shape)))
    inside = np.zeros(len(centres), dtype=bool)
    for zone in zones:
        low, high = np.min(zone.polygon, axis=0), np.max(zone.polygon, axis=0)
        within = ((low < centres[:, :2]) & (centres[:, :2] < high)).all(axis=1)
        inside |= within & (centres[:, 2] > (zone.floor_m or 0.0)) & (centres[:, 2] < zone.ceiling_m)
    return inside.reshape(FRAME.shape)


@pytest.mark.parametrize("most", [10_000, 40])
def test_zones_cover_what_is_occupied(most, monkeypatch):
    monkeypatch.setattr(map_zones, "MOST_BLOCKS", most)
    seen = VoxelMap(FRAME, 1.0)
    seen.occupied[:] = np.random.default_rng(2).random(FRAME.shape) < 0.3
    zones = zones_of(seen)
    assert len(zones) <= most
    inside = covered(zones)
    assert inside[seen.occupied].all()
    assert (inside == seen.occupied).all() == (most > 40)
    assert {zone.floor_m is None for zone in zones} == {True, False}


def test_one_box_is_one_zone():
    seen = VoxelMap(FRAME, 1.0)
    seen.occupied[0:3, 2:5, 4:8] = True
    (zone,) = zones_of(seen)
    assert (zone.floor_m, zone.ceiling_m) == (None, 1.5)
    assert zone.polygon == ((4.0, 0.0), (6.0, 0.0), (6.0, 1.5), (4.0, 1.5))
    assert zone.forbidden_to == ("ground", "air")


def test_an_empty_map_has_no_zones():
    assert zones_of(VoxelMap(FRAME, 1.0)) == ()
