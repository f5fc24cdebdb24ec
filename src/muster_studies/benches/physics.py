"""Speed of the physics world: part of `muster bench`."""

from __future__ import annotations

import math
import time

import numpy as np

from muster.mission.model import Mission, Robot
from muster.motion.port import Waypoint
from muster_studies.benches.measurement import Measurement

SIMULATED_S = 20.0
WIDTH, HEIGHT, PICTURES = 640, 480, 30


def team() -> Mission:
    """Six ground robots and three drones of Table A.2 of [tcf-thesis]."""
    ground = (
        Robot(id=f"r_{k}", position=(2.0 * k, 0.0, 0.0), kinematics="differential-drive", radius_m=0.3, speed_mps=0.26)
        for k in range(6)
    )
    drones = (
        Robot(
            id=f"d_{k}", position=(4.0 * k, 3.0, 2.0), kind="air", kinematics="quadcopter", radius_m=0.7, speed_mps=0.5
        )
        for k in range(3)
    )
    return Mission(robots=(*ground, *drones), tasks=())


def physics(runs: int) -> list[Measurement]:
    """Times real time of robots under way, and of pictures that a camera over them takes; one core.

    Raises
    ------
    MissingExtraError
        if MuJoCo is not installed.
    """
    from muster_physics import PhysicsWorld
    from muster_physics.rendering import Lens, Renderer

    rates, contacts = [], 0
    for seed in range(runs):
        world = PhysicsWorld(team(), seed=seed)
        for robot in team().robots:
            x, y, z = robot.position
            world.ports[robot.id].send([Waypoint((x + 1.0, y + 6.0, z)), Waypoint((x, y, z))])
        world.step()  # the model is made
        begin = time.process_time()
        while world.time_s < SIMULATED_S:
            world.advance(SIMULATED_S)
        rates.append(SIMULATED_S / (time.process_time() - begin))
        contacts += len(world.contacts)
    down = np.diag([1.0, -1.0, -1.0])
    lens, pace = Lens.of_view(WIDTH, HEIGHT, math.radians(60)), []
    with Renderer(world, WIDTH, HEIGHT) as renderer:
        renderer.seen_from(np.array([5.0, 2.0, 8.0]), down, lens)
        for _ in range(runs):
            begin = time.process_time()
            for _ in range(PICTURES):
                renderer.seen_from(np.array([5.0, 2.0, 8.0]), down, lens)
            pace.append(PICTURES / (time.process_time() - begin))
    note = f"{SIMULATED_S:.0f} s simulated, {contacts} contacts"
    return [
        Measurement.over_runs("physics, 6 ground robots, 3 drones", "x real time", rates, ">= 15", note),
        Measurement.over_runs(f"picture of {WIDTH} x {HEIGHT}", "1/s", pace, ">= 30", "drawn, nothing detected"),
    ]
