"""Pictures: what lies where is drawn where a pinhole camera has it."""

import math
import os
import subprocess
import sys
from importlib.util import find_spec

import numpy as np
import pytest
from tests.simulation.scenes import mission, robot

if find_spec("mujoco") is None:  # not imported here: first it must be said how it draws
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)

from muster.mission.errors import ParameterError
from muster_physics import PhysicsWorld
from muster_physics.optional_parts import BACKENDS, _is_there
from muster_physics.rendering import Lens, Renderer

if not any(map(_is_there, BACKENDS.values())):
    pytest.skip("neither EGL nor OSMesa is installed", allow_module_level=True)

SIZE = (320, 240)
DOWN = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])


def blue_middle(picture):
    """Columns and rows of the middle of what is bluer than it is red: a holonomic robot."""
    r, b = picture[..., 0].astype(int), picture[..., 2].astype(int)
    rows, columns = np.nonzero(b - r > 30)
    return columns.mean() + 0.5, rows.mean() + 0.5


def printed_by(program, **given):
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, **given)
    return ran.stdout.strip()


@pytest.fixture
def world():
    return PhysicsWorld(mission(robot(position=(1.0, 0.5), radius_m=0.3)))


@pytest.mark.parametrize("centre", [None, (140.0, 150.0)])
def test_a_pinhole_camera_sees_a_robot_where_it_projects_to(world, centre):
    lens = Lens(*SIZE, focal_px=200.0, centre_px=centre)
    tilt = math.radians(20)
    axes = DOWN @ np.array(
        [[1, 0, 0], [0, math.cos(tilt), math.sin(tilt)], [0, -math.sin(tilt), math.cos(tilt)]], dtype=float
    )
    eye = np.array([0.8, 0.4, 3.0])
    x, y, z = axes.T @ (np.array([1.0, 0.5, 0.1]) - eye)
    across, down = centre or (SIZE[0] / 2, SIZE[1] / 2)
    with Renderer(world, *SIZE) as renderer:
        found = blue_middle(renderer.seen_from(eye, axes, lens))
    assert found == pytest.approx((across + 200 * x / z, down + 200 * y / z), abs=2.5)


def test_the_view_from_above_has_north_up_and_the_scale_asked_for(world):
    with Renderer(world, *SIZE) as renderer:
        picture = renderer.seen_from_above((0.0, 0.0), 2.4)
    assert picture.shape == (240, 320, 3)
    assert blue_middle(picture) == pytest.approx((160 + 100, 120 - 50), abs=1.0)


def test_who_joined_is_seen(world):
    with Renderer(world, *SIZE) as renderer:
        before = renderer.seen_from_above((0.0, 0.0), 2.4)
        world.join(robot("s", (-0.5, -0.5), radius_m=0.3))
        after = renderer.seen_from_above((0.0, 0.0), 2.4)
    assert np.abs(after[170, 110].astype(int) - before[170, 110]).max() > 30


def test_a_lens_of_another_size_and_one_too_large_are_told(world):
    with Renderer(world, *SIZE) as renderer, pytest.raises(ParameterError, match="lens: 64 x 48 pixels; expected 320"):
        renderer.seen_from(np.zeros(3), DOWN, Lens(64, 48, 50.0))
    with pytest.raises(ParameterError, match="picture: 4000 x 3000 pixels; expected up to 1920 x 1440"):
        Lens(4000, 3000, 500.0)


@pytest.mark.long
def test_the_backend_is_chosen_before_mujoco_comes():
    program = (
        "import os; os.environ.pop('MUJOCO_GL', None); import muster_physics.rendering; print(os.environ['MUJOCO_GL'])"
    )
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.strip()
    assert said in BACKENDS


@pytest.mark.long
def test_nothing_of_it_comes_with_muster():
    program = (
        "import sys, muster.running.simulation, muster.cli.verbs.simulate; from muster.running.worlds import WORLDS; "
        "WORLDS['physics']; print('mujoco' in sys.modules)"
    )
    assert (
        subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout == "False\n"
    )


def test_a_backend_that_there_is_not_is_one_line():
    program = (
        "from muster.mission.errors import ParameterError\n"
        "try:\n    from muster_physics import PhysicsWorld\n"
        "except ParameterError as error:\n    print(error)\n"
    )
    said = printed_by(program, env={**os.environ, "MUJOCO_GL": "nonsense"})
    assert said.startswith("MUJOCO_GL: nonsense; expected it unset, or one of egl, osmesa")
