"""A lidar all around measures walls, undersides, tops, the ground and other robots as geometry says."""

import math

import numpy as np
import pytest

from muster.perception.sphere_scanner import SphereScanner

SCANNER = SphereScanner(math.radians(5), 20.0)
NO_FACES, NO_BALLS = np.empty((0, 6)), np.empty((0, 4))
SQUARE = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]


def scan(eye=(0.0, 0.0, 3.0), heading=0.3, faces=NO_FACES, slabs=(), ground=0.0, balls=NO_BALLS):
    eye = np.array(eye)
    seen = SCANNER.scan(eye, heading, faces, list(slabs), ground, balls)
    return seen, eye + np.where(np.isfinite(seen.ranges), seen.ranges, 0.0)[..., None] * SCANNER.directions(heading)


def test_the_ground_is_met_below_and_said_to_be_the_ground():
    seen, ends = scan()
    assert seen.on_ground.any()
    assert np.allclose(ends[seen.on_ground][:, 2], 0.0)
    below = np.sin(SCANNER.elevations) < -3.0 / 20.0
    assert (seen.on_ground == below[:, None]).all()
    assert np.isinf(seen.ranges[~below]).all()


def test_a_robot_on_the_ground_sees_the_ground_at_its_feet():
    seen, _ = scan(eye=(0.0, 0.0, 0.0))
    assert seen.on_ground[0].all()
    assert (seen.ranges[0] == 0).all()


def test_walls_end_where_they_end():
    wall = np.array([[5.0, -3.0, 5.0, 3.0, 2.0, 4.0]])
    seen, ends = scan(faces=wall, ground=-100.0)
    met = np.isfinite(seen.ranges)
    assert np.allclose(ends[met][:, 0], 5.0)
    assert np.abs(ends[met][:, 1]).max() <= 3.0 + 1e-6
    assert 2.0 <= ends[met][:, 2].min() <= ends[met][:, 2].max() <= 4.0
    directions = SCANNER.directions(0.3)
    ahead = directions[..., 0] > 0
    y, z = (5 * directions[..., k] / np.where(ahead, directions[..., 0], 1.0) for k in (1, 2))
    assert (met == (ahead & (np.abs(y) <= 3) & (np.abs(z) <= 1))).all()


@pytest.mark.parametrize(("eye_m", "level"), [(1.0, 2.0), (6.0, 4.0)])
def test_undersides_and_tops_are_level(eye_m, level):
    seen, ends = scan(eye=(0.5, 0.0, eye_m), slabs=[(SQUARE, 2.0, 4.0)], ground=-100.0)
    met = np.isfinite(seen.ranges)
    assert np.allclose(ends[met][:, 2], level)
    assert np.abs(ends[met][:, :2]).max() <= 2.0
    assert met[-1 if eye_m < 2 else 0].all()


def test_other_robots_are_balls():
    seen, ends = scan(balls=np.array([[3.0, 1.0, 3.5, 0.5]]), ground=-100.0)
    met = np.isfinite(seen.ranges)
    assert met.any()
    assert np.allclose(np.linalg.norm(ends[met] - (3.0, 1.0, 3.5), axis=1), 0.5)


def test_the_nearest_counts():
    walls = np.array([[5.0, -9.0, 5.0, 9.0, -9.0, 9.0], [4.0, -9.0, 4.0, 9.0, -9.0, 3.0]])
    seen, ends = scan(faces=walls, ground=-100.0)
    met = np.isfinite(seen.ranges)
    assert (
        np.allclose(ends[met][:, 0], np.where(ends[met][:, 2] <= 3.0 + 1e-9, 4.0, 5.0), atol=1e-6)
        or (np.isclose(ends[met][:, 0], 4.0) | (ends[met][:, 2] > 3.0)).all()
    )
