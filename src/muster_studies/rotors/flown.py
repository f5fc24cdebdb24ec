"""The Firefly of the physics world under the plain law of [furrer2016]: hovering, steps, and its motors."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from muster.mission.values.arrays import Floats

if TYPE_CHECKING:
    from muster_physics.simulated_model import SimulatedModel

STEP_S = 0.005
"""The world's step of physics."""
_BEGIN = (0.0, 0.0, 10.0)


def hovering(seconds: float) -> Floats:
    """(6,): the speeds of rotors after hovering for a while, rad/s."""
    simulated = _firefly()
    _fly(simulated, np.zeros(3), 0.0, round(seconds / STEP_S))
    found: Floats = simulated.rotors.speeds[0]
    return found


def step_response(goal: Floats, heading: float, seconds: float) -> Floats:
    """(n, 4): x, y, z and heading after each step of physics, from the begin of a step of position and heading."""
    return _fly(_firefly(), goal, heading, round(seconds / STEP_S))


def motor_constants() -> tuple[float, float]:
    """The time constants of a rotor's speed, up and down, in seconds: by what is left of a change after a step."""
    from muster_physics.airframes import FIREFLY
    from muster_physics.rotors import Rotors

    found = []
    for begin, end in ((500.0, 600.0), (600.0, 500.0)):
        after = Rotors([FIREFLY], STEP_S).followed(np.full((1, 6), begin), np.full((1, 6), end))[0, 0]
        found.append(-STEP_S / float(np.log((end - after) / (end - begin))))
    return found[0], found[1]


def _firefly() -> SimulatedModel:
    from muster_physics.airframes import FIREFLY
    from muster_physics.bodies import BodyKind, RobotBody
    from muster_physics.model import PlacedRobot
    from muster_physics.scenery import Scenery
    from muster_physics.simulated_model import SimulatedModel

    body = RobotBody(BodyKind.ROTORCRAFT, 1.0, FIREFLY)
    return SimulatedModel([PlacedRobot(body, _BEGIN, 0.0, None)], (), Scenery(None, (), 0.0), STEP_S)


def _fly(simulated: SimulatedModel, goal: Floats, heading: float, steps: int) -> Floats:
    """Errors of place and heading come with the command: gain times error over the gain of velocity."""
    from muster_physics.controller import Commands
    from muster_physics.rotorcraft_control import RotorcraftController

    controller = RotorcraftController(simulated, compensates=False)
    wanted, poses = np.array([*(np.array(_BEGIN) + goal), heading]), np.empty((steps + 1, 4))
    for step in range(steps + 1):
        motion = controller.group.motion()
        poses[step] = motion.poses[0]
        rates = controller.following * (wanted - motion.poses)
        controller.drive(Commands(rates, np.zeros(1)), motion)
        simulated.go_on()
    poses[:, :3] -= _BEGIN
    return poses
