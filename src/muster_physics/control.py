"""Closed-loop controllers: from commanded velocities to the forces of motors.

Motors answer late: a body moves on for a while after a command to stand. The position at which it would come to rest,
its position plus its lag, moves at exactly the commanded velocity. The crowd therefore decides by that predicted
position, as if robots answered at once, and no robot overshoots (a predictor as in [smith1957]). Each controller
computes its own lag.

Within a step of the world a reference moves at the velocity that the crowd chose, and the loops follow it. A robot that
is to stand keeps the position at which it was to come to rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.motion.grid import Floats
from muster.motion.wheels import body_speeds
from muster_physics.bodies import SUNK_M, TRACK_M, WHEEL_RADIUS_M, BodyKind
from muster_physics.controller import Commands, Controller, lags_of, no_wheels
from muster_physics.model import SERVO_S
from muster_physics.rotorcraft_control import RotorcraftController
from muster_physics.simulated_model import Motion, SimulatedModel

GRAVITY_MPS2 = 9.81
MOST_TILT = math.radians(35)


@dataclass(frozen=True)
class StepResult:
    """The result of commands, at the end of a step of the world.

    Parameters
    ----------
    poses, lags
        (n, 4): x, y, z and heading, and by how much each would still change after a command to stand.
    counted
        (n, 2) metres and radians that wheel encoders counted; NaN for robots without wheels.
    """

    poses: Floats
    lags: Floats
    counted: Floats


class WheelController:
    """Differential drives: servos of the wheels."""

    following = 15.0

    def __init__(self, simulated: SimulatedModel) -> None:
        self.group = simulated.group(BodyKind.WHEELS)
        self._lag_s = SERVO_S - simulated.step_s  # the sum over steps, not the integral
        self._motors, self._angles = simulated.motors(self.group.who), simulated.wheels(self.group.who)
        self._spins, self._energy_j, self._step_s = (
            simulated.wheel_speeds(self.group.who),
            simulated.energy_j,
            simulated.step_s,
        )
        self._model, self._gains = simulated.model, simulated.model.actuator_gainprm[self._motors, 0]
        scale = np.array([body.scale for body in self.group.robots])
        self._half_track, self._radius = TRACK_M / 2 * scale, WHEEL_RADIUS_M * scale

    def lags(self, motion: Motion) -> Floats:
        return lags_of(motion.velocities[:, 0], motion.velocities[:, 1], 0.0, motion.rates[:, 2], self._lag_s)

    def drive(self, commands: Commands, motion: Motion) -> None:
        data = self.group.data
        powers = data.actuator_force[self._motors] * data.qvel[self._spins]
        self._energy_j[self.group.who] += self._step_s * np.abs(powers).sum(axis=1)
        rims = commands.rates[:, 3] * self._half_track
        self.group.data.ctrl[self._motors[:, 0]] = (commands.ahead - rims) / self._radius
        self.group.data.ctrl[self._motors[:, 1]] = (commands.ahead + rims) / self._radius

    def set_force_shares(self, shares: Floats) -> None:
        self._model.actuator_gainprm[self._motors, 0] = shares * self._gains
        self._model.actuator_biasprm[self._motors, 2] = -shares * self._gains

    def odometers(self) -> Floats:
        rims = (self._radius - SUNK_M)[:, None] * self.group.data.qpos[self._angles]
        return body_speeds(rims, 2 * self._half_track)


class ForceController:
    """Holonomic ground robots: a force in the plane and a torque about the upright axis."""

    following = 10.0
    GAIN = 40.0
    """1/s: from the error of a velocity, or of a yaw rate, to acceleration."""

    def __init__(self, simulated: SimulatedModel) -> None:
        self.group = simulated.group(BodyKind.SLIDER)
        self._lag_s = 1 / self.GAIN - simulated.step_s
        self._energy_j, self._step_s = simulated.energy_j, simulated.step_s
        self._mass = np.array([body.mass_kg for body in self.group.robots])
        self._inertia = np.array([body.inertia_kgm2[2] for body in self.group.robots])
        self.set_force_shares(np.ones((len(self.group.who), 2)))

    def lags(self, motion: Motion) -> Floats:
        return lags_of(motion.velocities[:, 0], motion.velocities[:, 1], 0.0, motion.rates[:, 2], self._lag_s)

    def drive(self, commands: Commands, motion: Motion) -> None:
        missing = commands.rates[:, :2] - motion.velocities[:, :2]
        forces, bodies = self.group.data.xfrc_applied, self.group.bodies
        powers = (forces[bodies, :2] * motion.velocities[:, :2]).sum(axis=1)
        self._energy_j[self.group.who] += self._step_s * np.abs(powers)
        forces[bodies, :2] = self.GAIN * self._pushes[:, None] * missing
        forces[bodies, 5] = self.GAIN * self._turns * (commands.rates[:, 3] - motion.rates[:, 2])

    def set_force_shares(self, shares: Floats) -> None:
        self._pushes, self._turns = shares[:, 0] * self._mass, shares[:, 1] * self._inertia

    def odometers(self) -> Floats:
        return no_wheels(self.group)


class RotorController:
    """Quadcopters at the level of forces: four rotors give a thrust along the body's axis and torques.

    The velocity loop commands an acceleration; thrust and tilt follow from it; the attitude loop tilts and turns the
    body. With velocity v, acceleration a and jerk j the way until it stands is (v + D/A a + j/A) / V, the
    integral of the loops' equations, where V, A, D are the gains below.
    """

    following = 4.0
    VELOCITY, YAW_RATE = 6.0, 20.0
    """1/s: from the error of a velocity, or of a yaw rate, to acceleration."""
    ATTITUDE, DAMPING = 900.0, 55.0
    """1/s^2 and 1/s: from the angular error, and from the angular velocity, to angular acceleration."""

    def __init__(self, simulated: SimulatedModel) -> None:
        self.group = simulated.group(BodyKind.ROTORS)
        self._lag_s, self._yaw_lag_s = 1 / self.VELOCITY - simulated.step_s, 1 / self.YAW_RATE - simulated.step_s
        self._mass = np.array([body.mass_kg for body in self.group.robots])
        self._inertia = np.array([body.inertia_kgm2 for body in self.group.robots]).reshape(-1, 3)
        self.set_force_shares(np.ones((len(self.group.who), 2)))

    def lags(self, motion: Motion) -> Floats:
        tilted, jerk = GRAVITY_MPS2 * self.DAMPING / self.ATTITUDE, GRAVITY_MPS2 / self.ATTITUDE
        up, rates = motion.axes[:, :, 2], motion.rates
        level = motion.velocities[:, :2] + tilted * up[:, :2] / up[:, 2:]
        x, y = level[:, 0] + jerk * rates[:, 1], level[:, 1] - jerk * rates[:, 0]
        turn = rates[:, 2] * (self._yaw_lag_s / self._lag_s)
        return lags_of(x, y, motion.velocities[:, 2], turn, self._lag_s)

    def drive(self, commands: Commands, motion: Motion) -> None:
        wanted = self.VELOCITY * (commands.rates[:, :3] - motion.velocities)
        climb = GRAVITY_MPS2 + np.clip(wanted[:, 2], -0.5 * GRAVITY_MPS2, 0.5 * GRAVITY_MPS2)
        level = np.hypot(wanted[:, 0], wanted[:, 1])
        tilt = np.minimum(level, math.tan(MOST_TILT) * climb) / np.maximum(level, 1e-12)
        x, y = wanted[:, 0] * tilt, wanted[:, 1] * tilt
        up, rates = motion.axes[:, :, 2], motion.rates
        length = np.sqrt(x * x + y * y + climb * climb)
        turn = -self.DAMPING * rates
        turn[:, 0] += self.ATTITUDE * (up[:, 1] * climb - up[:, 2] * y) / length  # up x wanted
        turn[:, 1] += self.ATTITUDE * (up[:, 2] * x - up[:, 0] * climb) / length
        turn[:, 2] = self.YAW_RATE * (commands.rates[:, 3] - rates[:, 2])
        forces, bodies = self.group.data.xfrc_applied, self.group.bodies
        forces[bodies, :3] = (self._pushes * climb / up[:, 2])[:, None] * up
        forces[bodies, 3:] = self._turns * turn

    def set_force_shares(self, shares: Floats) -> None:
        self._pushes, self._turns = shares[:, 0] * self._mass, shares[:, 1:] * self._inertia

    def odometers(self) -> Floats:
        return no_wheels(self.group)


class CommandFollower:
    """The robots of one controller, and their references.

    Parameters
    ----------
    keeps_height
        whether robots keep their height, as in a mission in the plane.
    """

    def __init__(self, controller: Controller, *, keeps_height: bool) -> None:
        self.controller = controller
        self._motion = controller.group.motion()
        self._reference = self._motion.poses
        self._free = np.array([True, True, not keeps_height, True])
        self._odometers = controller.odometers()

    @property
    def poses(self) -> Floats:
        """The poses now, (n, 4)."""
        return self._motion.poses

    @property
    def lags(self) -> Floats:
        """See `Controller.lags`."""
        return self.controller.lags(self._motion)

    def counted(self) -> Floats:
        """Metres and radians (n, 2) that wheel encoders counted since the last call; NaN for robots without wheels."""
        before, self._odometers = self._odometers, self.controller.odometers()
        counted = self._odometers - before
        counted[:, 0] = np.abs(counted[:, 0])
        return counted

    def begin(self, commands: Commands) -> None:
        """Begin a step of the world: the references of robots that move start at their predicted poses."""
        self._commands = commands
        anew = (commands.rates != 0).any(axis=1)[:, None] & self._free
        self._reference = np.where(anew, self.poses + self.lags, self._reference)

    def put(self, robot: int) -> None:
        """Take a robot that was put elsewhere as standing there; nothing changes if it is not one of these."""
        self._motion = self.controller.group.motion()
        is_it = self.controller.group.who == robot
        self._reference = np.where(is_it[:, None], self._motion.poses, self._reference)

    def drive(self) -> None:
        """Set motors for a step of physics."""
        commands, poses = self._commands, self.poses
        behind = self._reference - poses - self.lags
        behind[:, 3] = np.remainder(behind[:, 3] + math.pi, 2 * math.pi) - math.pi
        more = self.controller.following * behind
        along = more[:, 0] * np.cos(poses[:, 3]) + more[:, 1] * np.sin(poses[:, 3])
        self.controller.drive(Commands(commands.rates + more, commands.ahead + along), self._motion)

    def measure(self, step_s: float) -> None:
        """Move the references on, and measure the robots, after a step of physics."""
        self._reference += step_s * self._commands.rates
        self._motion = self.controller.group.motion()


class Control:
    """Drives all robots of a model."""

    def __init__(self, simulated: SimulatedModel, *, keeps_height: bool) -> None:
        self._simulated = simulated
        controllers: tuple[Controller, ...] = (
            WheelController(simulated),
            ForceController(simulated),
            RotorController(simulated),
            RotorcraftController(simulated),
        )
        used = [controller for controller in controllers if len(controller.group.who)]
        self._followers = [CommandFollower(controller, keeps_height=keeps_height) for controller in used]

    def put(self, robot: int) -> None:
        """Take a robot, by its number in the model, that was put elsewhere as standing there."""
        for follower in self._followers:
            follower.put(robot)

    def carry_out(self, commands: Commands, count: int, force_shares: Floats | None = None) -> StepResult:
        """Take `count` steps of physics; `force_shares` (n, 2) as `Controller.set_force_shares` has it; None: all 1."""
        for follower in self._followers:
            who = follower.controller.group.who
            follower.begin(commands.of(who))
            if force_shares is not None:
                follower.controller.set_force_shares(force_shares[who])
        for _ in range(count):
            for follower in self._followers:
                follower.drive()
            self._simulated.go_on()
            for follower in self._followers:
                follower.measure(self._simulated.step_s)
        robots = len(self._simulated.robots)
        done = StepResult(np.empty((robots, 4)), np.empty((robots, 4)), np.empty((robots, 2)))
        for follower in self._followers:
            who = follower.controller.group.who
            done.poses[who], done.lags[who], done.counted[who] = follower.poses, follower.lags, follower.counted()
        return done
