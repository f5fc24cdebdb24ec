"""Killed and resumed a run goes on in each world: with physics, noise, cameras that find tasks, and walls."""

from dataclasses import replace
from importlib.util import find_spec
from random import Random

import pytest
from tests.action_missions import walled
from tests.muster_control.runs.stage import performed_with_crashes, require_whole
from tests.random_missions import random_mission
from tests.running import test_camera_search as looking

import muster

PHYSICS = pytest.mark.skipif(not find_spec("mujoco"), reason="no MuJoCo")
WORLDS = ["kinematic", pytest.param("physics", marks=PHYSICS)]
NOISE = {"velocity": 0.1, "slip": 0.05, "odometry": 0.05, "position_m": 0.05, "heading_rad": 0.02}


def killed_anywhere(mission, asked=(), crashes=(0, 12, 9), **how):
    """The log of a run that is killed each time when so many more entries are kept, and resumed."""
    plan = muster.solve(mission, iterations=50)
    kept = performed_with_crashes(mission, plan, asked, crashes, **how)
    require_whole(kept, mission)
    assert [entry["kind"] for entry in kept.log].count("resumed") == len(crashes) - (crashes[0] == 0)
    return kept.log


def kinds(log):
    return {entry["kind"] for entry in log}


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("world", WORLDS)
def test_robots_that_err(world):
    whole = muster.load("6T-2R")
    mission = replace(whole, tasks=whole.tasks[:3])
    asked = [(5.0, "event", {"robot_fails": "r_0"}), (9.0, "pause", {}), (9.0, "resume", {})]
    plain = killed_anywhere(mission, asked, crashes=(7,), world=world)
    noisy = killed_anywhere(mission, asked, world=world, settings={"seed": 3, "noise": NOISE})
    assert "robot_fails" in kinds(plain) & kinds(noisy)
    assert plain != noisy


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("world", WORLDS)
def test_what_cameras_have_found_is_known_after_a_crash(world):
    drone = replace(looking.DRONE, camera=replace(looking.CAMERA, rate_hz=2))
    log = killed_anywhere(
        looking.mission(robots=(drone, looking.ROVER)), crashes=(20,), world=world, settings={"seed": 2}
    )
    assert {"found", "new_task"} <= kinds(log)
    assert {"found-4", "found-9"} <= set(log[-1]["data"]["tasks_done"])


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(3))
def test_walls(seed):
    mission = walled(random_mission(seed, tasks=6, robots=3), Random(seed))
    place = (0.0,) * mission.dimensions
    asked = [(8.0, "event", {"new_task": {"id": "new", "position": place, "type": "D"}})]
    log = killed_anywhere(replace(mission, name="walls"), asked)
    lines = [line for entry in log if entry["kind"] == "plan" for line in entry["data"]["lines"].values()]
    assert any(len(line) > 3 for line in lines)
