"""From velocities that robots are to have to what their motors do: closed loops over what is measured.

The crowd decides for a step of the world what velocity and yaw rate each robot has. Within the step a reference goes on
from where the robot is, at that velocity; wheels and forces follow the reference, so that the robot gets the way that
was meant though its motors answer late. Whoever is to stand keeps the place where it came to a stand.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.motion.frames import wrapped
from muster.motion.grid import Floats
from muster.simulation.physics.bodies import TRACK_M, WHEEL_RADIUS_M, Build
from muster.simulation.physics.stage import Motion, Stage

GRAVITY_MPS2 = 9.81
MOST_TILT = math.radians(35)


@dataclass(frozen=True)
class Commands:
    """Of all robots, for a step: velocities (n, 3) in the map frame, speeds ahead (n,) of those that face their way,
    yaw rates (n,)."""

    velocities: Floats
    ahead: Floats
    yaw_rates: Floats

    @property
    def moving(self) -> Floats:
        """Which of them are to move or turn, (n,) of bool."""
        return (self.velocities != 0).any(axis=1) | (self.yaw_rates != 0)


class Reference:
    """Where robots should be at a moment within a step: frames (n, 3) and headings (n,).

    `keeps_height`: in the plane nobody climbs.
    """

    def __init__(self, motion: Motion, *, keeps_height: bool) -> None:
        self.frames, self.headings = motion.frames.copy(), motion.headings
        self._axes = slice(0, 2 if keeps_height else 3)
        self._moved = np.ones(len(self.headings), dtype=bool)

    def begin(self, commands: Commands, motion: Motion) -> None:
        """A step begins: those that move, or did in the step before, go from where they are."""
        anew = commands.moving | self._moved
        self.frames[anew, self._axes] = motion.frames[anew, self._axes]
        self.headings = np.where(anew, motion.headings, self.headings)
        self._moved = commands.moving

    def go_on(self, commands: Commands, step_s: float) -> None:
        self.frames = self.frames + step_s * commands.velocities
        self.headings = self.headings + step_s * commands.yaw_rates


class Wheels:
    """Differential drives: servos of the wheels under a loop about the velocity of the body.

    Servos alone fall short of their speed, as wheels creep and casters are dragged.
    """

    ALONG, TURN = 12.0, 12.0
    """1/s: speed for each metre that it is behind, yaw rate for each radian."""
    MOST = 0.3
    """Of its reach, by which the loop may change a speed: m/s for a robot of nominal size."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._who = stage.having(Build.WHEELS)
        self._scale = np.array([stage.robots[k].body.scale for k in self._who])

    def drive(self, commands: Commands, reference: Reference, motion: Motion) -> None:
        who = self._who
        headings = motion.headings[who]
        behind = reference.frames[who, :2] - motion.frames[who, :2]
        along = behind[:, 0] * np.cos(headings) + behind[:, 1] * np.sin(headings)
        most = self.MOST * self._scale
        ahead = commands.ahead[who] + np.clip(self.ALONG * along, -most, most)
        off = wrapped(reference.headings[who] - headings)
        rims = (commands.yaw_rates[who] + self.TURN * off) * TRACK_M / 2 * self._scale
        rates = np.stack([ahead - rims, ahead + rims], axis=1) / (WHEEL_RADIUS_M * self._scale[:, None])
        self._stage.data.ctrl[self._stage.motors] = rates


class Pushes:
    """Holonomic ground robots: a force in the plane and a torque about the upright axis."""

    VELOCITY, PLACE = 40.0, 300.0
    """1/s and 1/s^2: acceleration for what is missing of velocity and place, of heading alike."""
    MOST_MPS2 = 10.0

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._who = stage.having(Build.SLIDER)
        bodies = [stage.robots[k].body for k in self._who]
        self._mass = np.array([body.mass_kg for body in bodies])
        self._inertia = np.array([body.inertia_kgm2[2] for body in bodies])

    def drive(self, commands: Commands, reference: Reference, motion: Motion) -> None:
        who = self._who
        missing = (commands.velocities - motion.velocities)[who, :2]
        behind = (reference.frames - motion.frames)[who, :2]
        wanted = self.VELOCITY * missing + self.PLACE * behind
        size = np.linalg.norm(wanted, axis=1, keepdims=True)
        wanted *= np.minimum(1.0, self.MOST_MPS2 / np.maximum(size, 1e-12))
        off = wrapped(reference.headings[who] - motion.headings[who])
        spin = self.VELOCITY * (commands.yaw_rates[who] - motion.rates[who, 2]) + self.PLACE * off
        forces = self._stage.data.xfrc_applied
        forces[self._stage.bodies[who], :2] = self._mass[:, None] * wanted
        forces[self._stage.bodies[who], 5] = self._inertia * spin


class Rotors:
    """Quadcopters at the level of forces: four rotors give a thrust along the body's axis and torques.

    The velocity loop asks for an acceleration; thrust and tilt follow from it; the attitude loop tilts the body. Yaw is
    turned meanwhile.
    """

    VELOCITY, PLACE = 7.0, 14.0
    ATTITUDE, DAMPING = 900.0, 55.0
    """1/s^2 and 1/s: angular acceleration for each radian off, and against each radian a second."""
    YAW, YAW_RATE = 100.0, 20.0

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._who = stage.having(Build.ROTORS)
        bodies = [stage.robots[k].body for k in self._who]
        self._mass = np.array([body.mass_kg for body in bodies])
        self._inertia = np.array([body.inertia_kgm2 for body in bodies]).reshape(-1, 3)

    def drive(self, commands: Commands, reference: Reference, motion: Motion) -> None:
        who = self._who
        missing = (commands.velocities - motion.velocities)[who]
        wanted = self.VELOCITY * missing + self.PLACE * (reference.frames - motion.frames)[who]
        wanted[:, 2] = np.clip(wanted[:, 2], -0.5 * GRAVITY_MPS2, 0.5 * GRAVITY_MPS2) + GRAVITY_MPS2
        level = np.linalg.norm(wanted[:, :2], axis=1)
        wanted[:, :2] *= np.minimum(1.0, math.tan(MOST_TILT) * wanted[:, 2] / np.maximum(level, 1e-12))[:, None]
        up = motion.axes[who, :, 2]
        thrust = self._mass * np.maximum(0.0, (wanted * up).sum(axis=1))
        off = np.cross(up, wanted / np.linalg.norm(wanted, axis=1, keepdims=True))
        rates = motion.rates[who]
        turn = self.ATTITUDE * off - self.DAMPING * rates
        turned = wrapped(reference.headings[who] - motion.headings[who])
        turn[:, 2] = self.YAW * turned + self.YAW_RATE * (commands.yaw_rates[who] - rates[:, 2])
        forces = self._stage.data.xfrc_applied
        forces[self._stage.bodies[who], :3] = thrust[:, None] * up
        forces[self._stage.bodies[who], 3:] = self._inertia * turn


class Control:
    """Of all robots of a stage."""

    def __init__(self, stage: Stage, *, keeps_height: bool) -> None:
        self._stage = stage
        self._reference = Reference(stage.motion(), keeps_height=keeps_height)
        laws = ((Wheels, Build.WHEELS), (Pushes, Build.SLIDER), (Rotors, Build.ROTORS))
        self._laws = [law(stage) for law, build in laws if len(stage.having(build))]

    def carry_out(self, commands: Commands, step_s: float, count: int) -> Motion:
        """So many steps of physics under these commands; returns the motion at the end."""
        motion = self._stage.motion()
        self._reference.begin(commands, motion)
        for _ in range(count):
            self._reference.go_on(commands, step_s)
            for law in self._laws:
                law.drive(commands, self._reference, motion)
            self._stage.go_on()
            motion = self._stage.motion()
        return motion
