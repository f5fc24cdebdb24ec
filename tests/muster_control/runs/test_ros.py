"""Robots on ROS 1 and ROS 2, real masters and wires: paused, and found again after their runner was killed."""

import asyncio
import json
import math
import os
import signal
from collections import Counter

import pytest
from tests.muster_control.runs.store import ADA, planned, settings_of
from tests.muster_robots.ros1 import conftest as ros1
from tests.muster_robots.ros2 import conftest as ros2

from muster.mission.model import Mission, Robot, Task
from muster_control.services.runs import Runs

rospy_there, shared_master, ros = ros1.rospy_there, ros1.shared_master, ros1.ros
loopback, start, simulated = ros2.loopback, ros2.start, ros2.simulated

PLACES = {"r_0": (0.0, 0.0), "r_1": (0.0, 3.0)}


def mission(kinematics):
    robots = tuple(
        Robot(id=name, position=place, speed_mps=3.0, yaw_rate_radps=6.0, radius_m=0.2, kinematics=kinematics)
        for name, place in PLACES.items()
    )
    tasks = [Task(id="t_1", position=(2.0, 0.0)), Task(id="t_2", position=(2.0, 3.0))]
    tasks += [Task(id=f"t_{k}", position=(4.0, 3.0 * (k - 3)), duration_s=1.0) for k in (3, 4)]
    tasks += [Task(id="t_5", position=(5.0, 0.0), prerequisites=("t_3",))]
    return Mission(robots=robots, tasks=tuple(tasks))


async def through(store, world, there, **settings):
    """A run that is paused at the first task's end, and whose runner is killed at the third's begin."""
    runs = Runs(store, settings_of(store, bridges=(world,)))
    run = (await runs.start(ADA, planned(store, there), world, settings=settings)).id
    paused_at, stood, killed, ended = None, [], False, 0
    async for text in runs.subscribers(run).watch(0):
        said = json.loads(text)
        ended += said.get("kind") == "ends"
        if said["type"] == "run" and said["state"] == "paused" and paused_at is None:
            paused_at = asyncio.get_running_loop().time()
        if said["type"] == "states" and paused_at is not None:
            waited = asyncio.get_running_loop().time() - paused_at
            if waited > 0.6:
                stood.append(said["robots"])
            if waited > 1.2:
                paused_at = math.inf
                await runs.act(ADA, run, "resume")
        if said.get("kind") == "ends" and ended == 1:
            await runs.act(ADA, run, "pause")
        if said.get("kind") == "starts" and ended >= 2 and not killed:
            killed = True
            os.kill(runs.pid(run), signal.SIGKILL)
    while runs.subscribers(run) is not None:
        await asyncio.sleep(0.02)
    await runs.close()
    return store.runs.get(run), store.log.entries(run), stood


def judge(run, log, stood, there):
    assert (run.state, run.resumed, run.remark) == ("ended", 1, "")
    assert [entry.seq for entry in log] == list(range(1, len(log) + 1))
    assert Counter(run.report["tasks_done"]) == dict.fromkeys((task.id for task in there.tasks), 1)
    assert run.report["tasks_lost"] == []
    assert Counter(entry.data["task"] for entry in log if entry.kind == "ends") == Counter(run.report["tasks_done"])
    (resumed,) = (entry for entry in log if entry.kind == "resumed")
    before = {entry.data["task"] for entry in log[: resumed.seq] if entry.kind == "ends"}
    after = {entry.data["task"] for entry in log[resumed.seq :] if entry.kind in ("sets_out", "starts")}
    assert len(before) >= 2
    assert not before & after
    assert [entry.data["verb"] for entry in log if entry.kind == "command"] == ["pause", "resume"]
    for name in PLACES:  # who is paused stands
        assert math.dist(stood[0][name][:2], stood[-1][name][:2]) < 0.05


@pytest.mark.long
def test_robots_on_ros_1_are_paused_and_found_again(store, ros):
    for name, place in PLACES.items():
        ros.robot(name, *place)
    there = mission("differential-drive")
    judge(*asyncio.run(through(store, "ros1", there, master=ros.master.address, known_only=True)), there)


@pytest.mark.long
def test_robots_on_ros_2_are_paused_and_found_again(store, simulated):
    pytest.importorskip("cyclonedds")
    for name, place in PLACES.items():
        simulated(name, *place)
    there = mission("holonomic")
    judge(*asyncio.run(through(store, "ros2", there, by="dds", known_only=True)), there)
