"""A short run in the physics world, filmed."""

from importlib.util import find_spec

import pytest

import muster
from muster.mission.model import Mission

MISSION = """
schema: muster/1
name: short
robots:
  - {id: rover, position: [0, 0], radius_m: 0.3}
  - {id: uav, position: [0, 3], radius_m: 0.7, kind: air}
  - {id: idle, position: [5, 4], radius_m: 0.3, kinematics: differential-drive, speed_mps: 0.01}
tasks:
  - {id: near, position: [3, 0], only_robots: [rover]}
  - {id: far, position: [4, 2.5], only_robots: [uav]}
events:
  - {at_s: 2, robot_fails: idle}
"""


@pytest.fixture(scope="session")
def short_file(tmp_path_factory):
    file = tmp_path_factory.mktemp("missions") / "short.yaml"
    file.write_text(MISSION, encoding="utf-8")
    return file


@pytest.fixture(scope="session")
def short(short_file) -> Mission:
    return muster.load(short_file)


@pytest.fixture(scope="session")
def footage(short):
    """Of the whole run; skips where nothing draws."""
    if find_spec("mujoco") is None:
        pytest.skip("the extra `physics` is not installed")
    from muster.mission.errors import RenderingError
    from muster_physics.film import Footage

    filled = Footage(short)
    try:
        muster.simulate(short, muster.solve(short, iterations=20), world="physics", film=filled)
    except RenderingError as error:
        pytest.skip(str(error))
    return filled
