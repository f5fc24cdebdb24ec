"""Bodies of the physics world that somebody puts elsewhere, or takes away: they stand there."""

from dataclasses import replace

import numpy as np
import pytest

from muster import Mission, Robot, Task
from muster.motion.port import Waypoint
from muster.simulation.world import standing

pytest.importorskip("mujoco", reason="the extra `physics` is not installed")

from muster_physics import PhysicsWorld

MISSION = Mission(
    robots=tuple(
        Robot(id=name, position=(0.0, 4.0 * k), radius_m=0.3, **how)
        for k, (name, how) in enumerate(
            {
                "slider": {"kinematics": "holonomic"},
                "wheels": {"kinematics": "differential-drive"},
                "drone": {"kind": "air"},
            }.items()
        )
    ),
    tasks=(Task(id="t", position=(5, 5)),),
)
PLACES = {"slider": (7.0, 1.0), "wheels": (-3.0, 4.0), "drone": (2.0, 12.0)}


def in_motion():
    """A world whose robots are under way."""
    world = PhysicsWorld(MISSION)
    for name, port in world.ports.items():
        x, y, z = port.telemetry().position
        port.send([Waypoint((x + 20.0, y, z))])
        assert name in PLACES
    world.advance(2.0)
    return world


def resumed(world):
    """A world that continues another."""
    snapshot = world.snapshot()
    robots = tuple(standing(robot, snapshot) for robot in MISSION.robots)
    return PhysicsWorld(replace(MISSION, robots=robots), snapshot=snapshot)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("stands", [False, True])
def test_who_is_put_elsewhere_stays_there(stands):
    world = in_motion()
    if stands:
        for port in world.ports.values():
            port.cancel()
        world.advance(6.0)
    for name, place in PLACES.items():
        world.place(name, place)
    world.advance(world.time_s + 2.0)
    assert world.positions[:, :2] == pytest.approx(np.array(list(PLACES.values())), abs=0.02)
    assert np.abs(world.velocities).max() < 0.01


def test_who_is_taken_away_is_nowhere_until_it_is_put_back_where_it_was_also_in_a_world_that_continues():
    world = in_motion()
    before = world.positions.copy()
    for name in PLACES:
        world.remove(name)
    far = world.frames.copy()
    for _ in range(2):
        world.advance(world.time_s + 1.0)
        assert np.isnan(world.positions).all()
        assert world.frames[:, :2] == pytest.approx(far[:, :2], abs=1.0)
        world = resumed(world)
    for name in PLACES:
        world.recover(name)
    world.advance(world.time_s + 1.0)
    assert world.positions == pytest.approx(before, abs=0.05)
