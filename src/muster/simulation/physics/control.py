"""From velocities that robots are to have to what their motors do: closed loops over what is measured.

Motors answer late. A body that lags goes on for a while after it is told to stand; where it would then stand is its
position and its lag together, and that place moves at just the velocity that is asked for. So the crowd decides by that
place as if robots answered at once, and nobody overshoots (a predictor as in Smith 1957). Each law knows its own lag.

Within a step of the world a reference goes on at the velocity that the crowd chose, and the loops follow it. Whoever is
to stand keeps the place where it was to come to a stand.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from muster.motion.frames import wrapped
from muster.motion.grid import Floats
from muster.simulation.physics.bodies import TRACK_M, WHEEL_RADIUS_M, Build
from muster.simulation.physics.stage import Motion, Stage

GRAVITY_MPS2 = 9.81
MOST_TILT = math.radians(35)
FOLLOWING = 4.0
"""1/s: by how much faster a robot goes for each metre that it is behind its reference, and turns for each radian."""


@dataclass(frozen=True)
class Commands:
    """What some robots are to do.

    Parameters
    ----------
    velocities
        (n, 3) in the map frame, m/s.
    ahead
        (n,) speeds of those that face their way, m/s.
    yaw_rates
        (n,) rad/s.
    """

    velocities: Floats
    ahead: Floats
    yaw_rates: Floats

    def of(self, who: npt.NDArray[np.intp]) -> Commands:
        return Commands(self.velocities[who], self.ahead[who], self.yaw_rates[who])


class Law(Protocol):
    """Drives those robots of a stage that are built in one way; `who` are their numbers."""

    who: npt.NDArray[np.intp]

    def lags(self, motion: Motion) -> Floats:
        """By how much they would go on and turn on, were they told to stand: (k, 4), metres and radians."""
        ...

    def drive(self, commands: Commands, motion: Motion) -> None:
        """Set motors for a step of physics. Both are of these robots alone."""
        ...


class Wheels:
    """Differential drives: servos of the wheels."""

    LAG_S = 0.015

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self.who = stage.having(Build.WHEELS)
        self._scale = np.array([stage.robots[k].body.scale for k in self.who])

    def lags(self, motion: Motion) -> Floats:
        return self.LAG_S * np.column_stack([motion.velocities[:, :2], 0 * self._scale, motion.rates[:, 2]])

    def drive(self, commands: Commands, motion: Motion) -> None:
        rims = commands.yaw_rates * TRACK_M / 2 * self._scale
        speeds = np.stack([commands.ahead - rims, commands.ahead + rims], axis=1)
        self._stage.data.ctrl[self._stage.motors] = speeds / (WHEEL_RADIUS_M * self._scale[:, None])


class Pushes:
    """Holonomic ground robots: a force in the plane and a torque about the upright axis."""

    GAIN = 40.0
    """1/s: acceleration for what is missing of a velocity, and of a yaw rate."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self.who = stage.having(Build.SLIDER)
        bodies = [stage.robots[k].body for k in self.who]
        self._mass = np.array([body.mass_kg for body in bodies])
        self._inertia = np.array([body.inertia_kgm2[2] for body in bodies])

    def lags(self, motion: Motion) -> Floats:
        return np.column_stack([motion.velocities[:, :2], 0 * self._mass, motion.rates[:, 2]]) / self.GAIN

    def drive(self, commands: Commands, motion: Motion) -> None:
        missing = (commands.velocities - motion.velocities)[:, :2]
        forces, bodies = self._stage.data.xfrc_applied, self._stage.bodies[self.who]
        forces[bodies, :2] = self.GAIN * self._mass[:, None] * missing
        forces[bodies, 5] = self.GAIN * self._inertia * (commands.yaw_rates - motion.rates[:, 2])


class Rotors:
    """Quadcopters at the level of forces: four rotors give a thrust along the body's axis and torques.

    The velocity loop asks for an acceleration; thrust and tilt follow from it; the attitude loop tilts the body, and
    turns it meanwhile. With velocity v, acceleration a and jerk j the way until it stands is (v + D/A a + j/A) / V, the
    integral of the loops' equations, where V, A, D are the gains below.
    """

    VELOCITY, YAW_RATE = 6.0, 20.0
    """1/s: acceleration for what is missing of a velocity, and of a yaw rate."""
    ATTITUDE, DAMPING = 900.0, 55.0
    """1/s^2 and 1/s: angular acceleration for each radian off, and against each radian a second."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self.who = stage.having(Build.ROTORS)
        bodies = [stage.robots[k].body for k in self.who]
        self._mass = np.array([body.mass_kg for body in bodies])
        self._inertia = np.array([body.inertia_kgm2 for body in bodies]).reshape(-1, 3)

    def lags(self, motion: Motion) -> Floats:
        up = motion.axes[:, :, 2]
        level = motion.velocities.copy()
        level[:, :2] += self.DAMPING / self.ATTITUDE * GRAVITY_MPS2 * up[:, :2] / up[:, 2:]
        level[:, 0] += GRAVITY_MPS2 / self.ATTITUDE * motion.rates[:, 1]
        level[:, 1] -= GRAVITY_MPS2 / self.ATTITUDE * motion.rates[:, 0]
        return np.column_stack([level / self.VELOCITY, motion.rates[:, 2] / self.YAW_RATE])

    def drive(self, commands: Commands, motion: Motion) -> None:
        wanted = self.VELOCITY * (commands.velocities - motion.velocities)
        wanted[:, 2] = np.clip(wanted[:, 2], -0.5 * GRAVITY_MPS2, 0.5 * GRAVITY_MPS2) + GRAVITY_MPS2
        level = np.linalg.norm(wanted[:, :2], axis=1)
        wanted[:, :2] *= np.minimum(1.0, math.tan(MOST_TILT) * wanted[:, 2] / np.maximum(level, 1e-12))[:, None]
        up = motion.axes[:, :, 2]
        thrust = self._mass * wanted[:, 2] / up[:, 2]
        off = np.cross(up, wanted / np.linalg.norm(wanted, axis=1, keepdims=True))
        turn = self.ATTITUDE * off - self.DAMPING * motion.rates
        turn[:, 2] = self.YAW_RATE * (commands.yaw_rates - motion.rates[:, 2])
        forces, bodies = self._stage.data.xfrc_applied, self._stage.bodies[self.who]
        forces[bodies, :3] = thrust[:, None] * up
        forces[bodies, 3:] = self._inertia * turn


class Control:
    """Of all robots of a stage. `keeps_height`: in the plane nobody climbs."""

    def __init__(self, stage: Stage, *, keeps_height: bool) -> None:
        self._stage = stage
        laws: tuple[Law, ...] = (Wheels(stage), Pushes(stage), Rotors(stage))
        self._laws = [law for law in laws if len(law.who)]
        self._moving_axes = np.array([True, True, not keeps_height, True])
        self._reference = poses(stage.motion())

    def carry_out(self, commands: Commands, step_s: float, count: int) -> Motion:
        """So many steps of physics under these commands; returns the motion at the end."""
        motion = self._stage.motion()
        rates = np.column_stack([commands.velocities, commands.yaw_rates])
        anew = (rates != 0).any(axis=1)[:, None] & self._moving_axes
        self._reference = np.where(anew, poses(motion) + self.lags(motion), self._reference)
        for _ in range(count):
            self._reference += step_s * rates
            self._drive(commands, motion)
            self._stage.go_on()
            motion = self._stage.motion()
        return motion

    def lags(self, motion: Motion) -> Floats:
        """See `Law.lags`; of all robots, (n, 4)."""
        lags = np.zeros((len(motion.frames), 4))
        for law in self._laws:
            lags[law.who] = law.lags(motion.of(law.who))
        return lags

    def _drive(self, commands: Commands, motion: Motion) -> None:
        behind = self._reference - poses(motion) - self.lags(motion)
        behind[:, 3] = wrapped(behind[:, 3])
        more = FOLLOWING * behind
        headings = motion.headings
        along = more[:, 0] * np.cos(headings) + more[:, 1] * np.sin(headings)
        corrected = Commands(commands.velocities + more[:, :3], commands.ahead + along, commands.yaw_rates + more[:, 3])
        for law in self._laws:
            law.drive(corrected.of(law.who), motion.of(law.who))


def poses(motion: Motion) -> Floats:
    """Frames and headings (n, 4)."""
    return np.column_stack([motion.frames, motion.headings])
