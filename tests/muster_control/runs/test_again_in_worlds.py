"""Killed and resumed a run goes on in each world: with physics, noise, cameras that find tasks, and walls."""

from dataclasses import replace
from importlib.util import find_spec
from random import Random

import numpy as np
import pytest
from tests.action_missions import walled
from tests.muster_control.runs.stage import performed_with_crashes, require_whole
from tests.random_missions import random_mission
from tests.running import test_camera_search as looking

import muster
from muster import Map, Mission, Robot, Task
from muster.mission.model import Zone

PHYSICS = pytest.mark.skipif(not find_spec("mujoco"), reason="no MuJoCo")
AWAY = "robot_removed", "robot_returns"
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


@pytest.mark.long
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


HALL = Map(
    boundary=((-2, -2), (22, -2), (22, 12), (-2, 12)), zones=(Zone(polygon=((9, 2), (11, 2), (11, 12), (9, 12))),)
)
BESIDE = 4.0, 9.0
"""Where nobody has anything to do."""


@pytest.mark.long
@pytest.mark.parametrize("traffic", ["reserve", "free"])
@pytest.mark.parametrize("world", WORLDS)
def test_robots_that_were_taken_away_or_moved(world, traffic):
    """Who was taken away is nowhere after a crash, and comes back where it was; who was moved is where it was put."""
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 3.0 * k), radius_m=0.3) for k in range(3))
    tasks = tuple(Task(id=f"t_{k}", position=(16.0, 3.0 * k), duration_s=2.0) for k in range(3))
    mission = Mission(robots=robots, tasks=tasks, map=HALL)
    asked = [
        (2.0, "event", {"robot_removed": "r_0"}),
        (3.0, "event", {"robot_moved": {"robot": "r_1", "position": BESIDE}}),
        (4.0, "event", {"robot_moved": {"robot": "r_2", "position": [10.0, 6.0]}}),  # in the wall
        (14.0, "event", {"robot_returns": "r_0"}),
    ]
    how = {"world": world, "settings": {"traffic": traffic}}
    kept = performed_with_crashes(mission, muster.solve(mission, iterations=50), asked, (9, 12, 9), **how)
    require_whole(kept, mission)
    assert [entry["kind"] for entry in kept.log].count("resumed") == 3
    outcomes = [entry["data"]["outcome"] for entry in kept.log if entry["kind"] == "command"]
    refused = "robot_moved.position: [10.0, 6.0]; expected a place where r_2 is free"
    assert outcomes == ["done", "done", refused, "done"]
    assert set(kept.log[-1]["data"]["tasks_done"]) == {"t_0", "t_1", "t_2"}
    away_s, back_s = (next(e for e in kept.log if e["kind"] == kind)["time_s"] for kind in AWAY)
    tracks = tracks_of(kept, "r_0")
    assert back_s - away_s > 10
    assert not [time_s for time_s in tracks if away_s + 0.15 < time_s < back_s - 0.15]
    comes_back_to = next(place for time_s, place in tracks.items() if time_s > back_s + 0.15)
    assert comes_back_to == pytest.approx((2.0, 0.0), abs=0.8)  # where it was after 2 s at 1 m/s
    put_to = next(place for time_s, place in tracks_of(kept, "r_1").items() if time_s > 3.15)
    assert put_to == pytest.approx(BESIDE, abs=0.5)


def tracks_of(kept, robot):
    """By time where a robot was, seconds and metres, while it was there."""
    stretches = [steps for _, _, steps in kept.tracks if robot in steps.robots]
    rows = [
        (t, row[steps.robots.index(robot), :2])
        for steps in stretches
        for t, row in zip(steps.times_s, steps.states, strict=True)
    ]
    return {time_s: tuple(place) for time_s, place in rows if not np.isnan(place).any()}
