"""The controller of drones that are simulated rotor by rotor.

The law is that of [lee2010]. Its position error is that of the position at which the drone would come to rest, which
follows the crowd's commanded velocity as that of all other bodies does; it comes with the command, as a velocity.
Forces that no model tells, as wind's, are estimated from the difference of measured and expected acceleration
[tomic2014] and fed forward.

What forces and moments that no model tells, as wind's, do to bodies: by acceleration, as in [tomic2014].
"""

from __future__ import annotations

import math

import numpy as np

from muster.motion.grid import Floats
from muster_physics.airframes import GRAVITY_MPS2
from muster_physics.bodies import BodyKind
from muster_physics.controller import Commands, no_wheels
from muster_physics.geometric_control import UP, GeometricController
from muster_physics.rotors import Rotors
from muster_physics.simulated_model import Motion, SimulatedModel
from muster_physics.vectors import cross, in_body, in_map

OBSERVER_S = 0.3
"""Time constant in which a disturbance is found out."""
MOST = np.array([4.0, 4.0, 4.0, 5.0, 5.0, 5.0])
"""The greatest accelerations that are taken for disturbances, m/s^2 and rad/s^2: rotors can hold against these."""


class DisturbanceObserver:
    """Low-passes the difference of measured and expected accelerations.

    Accelerations are (n, 6): of the frame in the map frame, m/s^2, and about the body's axes, rad/s^2.
    """

    def __init__(self, step_s: float) -> None:
        self._step_s, self._share = step_s, -math.expm1(-step_s / OBSERVER_S)
        self._before: tuple[Floats, Floats] | None = None

    def observed(self, estimate: Floats, velocities: Floats, expected: Floats) -> Floats:
        """The next estimate, (n, 6).

        Parameters
        ----------
        estimate
            the last one.
        velocities
            (n, 6) now: of the frame, and about the body's axes.
        expected
            accelerations from now on by all that is known.
        """
        before, self._before = self._before, (velocities, expected)
        if before is None:
            return estimate
        measured = (velocities - before[0]) / self._step_s
        return np.clip(estimate + self._share * (measured - before[1] - estimate), -MOST, MOST)


MOST_TILT = math.radians(35)


class RotorcraftController:
    """Drones at the level of rotors.

    Parameters
    ----------
    compensates
        whether it holds against drag and estimated disturbances; the controller of [furrer2016] does not.
    """

    def __init__(self, simulated: SimulatedModel, *, compensates: bool = True) -> None:
        self._compensates = compensates
        self.group = simulated.group(BodyKind.ROTORCRAFT)
        airframes = [body.rotorcraft for body in self.group.robots]
        self._energy_j = simulated.energy_j
        self._step_s, self._state = simulated.step_s, simulated.rotors
        self._rotors, self._law = Rotors(airframes, simulated.step_s), GeometricController(airframes)
        self._observer = DisturbanceObserver(simulated.step_s)
        law, up_s, down_s = self._law, [one.up_s for one in airframes], [one.down_s for one in airframes]
        self._motor_s = (np.array(up_s) + np.array(down_s)) / 2
        self._velocity_gain = law.velocity / law.mass
        self._lag_s = 1 / self._velocity_gain - simulated.step_s
        self._yaw_lag_s = (law.inertia / law.angular_rate)[:, 2] - simulated.step_s
        self._damped_s = (law.angular_rate / law.attitude)[:, :1]
        self._jerk = GRAVITY_MPS2 * law.inertia / law.attitude
        following = (law.position / law.velocity)[:, None]
        yaw_following = (law.attitude / law.angular_rate)[:, 2:]
        self.following: Floats = np.hstack([following, following, following, yaw_following])
        self.set_force_shares(np.ones((len(airframes), 2)))

    def lags(self, motion: Motion) -> Floats:
        """The way until it stands is (v + D/A a + j/A + T/A j')/V in the plane, (v + T a)/V upright.

        V, A and D are the gains of velocity, attitude and angular rate, T the mean time constant of motors; a, j and j'
        the acceleration by tilt, beyond that which holds against disturbances, and its derivatives. It is the integral
        of the loops' equations.
        """
        who, up = self.group.who, motion.axes[:, :, 2]
        thrusts = self._rotors.thrusts(self._state.speeds[who])
        known = self._fed_forward(motion)
        steady = GRAVITY_MPS2 * up[:, :2] / up[:, 2:] - known[:, :2]
        turning = self._rotors.moments(thrusts) / self._law.inertia + self._state.disturbances[who, 3:]
        spun = self._jerk * (in_body(motion.axes, motion.rates) + self._motor_s[:, None] * turning)
        jerk = in_map(motion.axes, np.column_stack([spun[:, 1], -spun[:, 0], np.zeros(len(who))]))
        level = motion.velocities[:, :2] + self._damped_s * steady + jerk[:, :2]
        climbing = thrusts.sum(axis=1) * up[:, 2] / self._law.mass - GRAVITY_MPS2 - known[:, 2]
        upright = motion.velocities[:, 2] + self._motor_s * climbing
        turn = self._yaw_lag_s * motion.rates[:, 2]
        return np.column_stack([self._lag_s[:, None] * level, self._lag_s * upright, turn])

    def drive(self, commands: Commands, motion: Motion) -> None:
        who, law = self.group.who, self._law
        velocity_error = motion.velocities - commands.rates[:, :3]
        force = law.wanted_force(np.zeros_like(velocity_error), velocity_error, self._fed_forward(motion))
        force = within_tilt(force, law.mass)
        heading = np.arctan2(motion.axes[:, 1, 0], motion.axes[:, 0, 0])
        rates = in_body(motion.axes, motion.rates)
        moments = law.moments(force, motion.axes, rates, heading, commands.rates[:, 3])
        if self._compensates:
            moments -= law.inertia * self._state.disturbances[who, 3:]
        wanted = self._rotors.allocated(moments, law.thrust(force, motion.axes))
        self._state.speeds[who] = self._rotors.followed(self._state.speeds[who], wanted)
        self._apply(motion, rates)

    def set_force_shares(self, shares: Floats) -> None:
        self._thrust_shares, self._moment_shares = shares[:, :1], shares[:, 1:]

    def odometers(self) -> Floats:
        return no_wheels(self.group)

    def _fed_forward(self, motion: Motion) -> Floats:
        """(n, 3): the acceleration that holds against the drag of calm air and against the estimated disturbance."""
        who = self.group.who
        if not self._compensates:
            return np.zeros_like(motion.velocities)
        return self._calm_drag(motion) - self._state.disturbances[who, :3]

    def _calm_drag(self, motion: Motion) -> Floats:
        """(n, 3): the deceleration by the drag of rotors in air that stands."""
        who = self.group.who
        drag = (self._rotors.drag * self._state.speeds[who]).sum(axis=1) / self._law.mass
        up = motion.axes[:, :, 2]
        across = motion.velocities - (motion.velocities * up).sum(axis=1, keepdims=True) * up
        found: Floats = drag[:, None] * across
        return found

    def _apply(self, motion: Motion, rates: Floats) -> None:
        """Put the forces of rotors on bodies, and estimate what else accelerates these."""
        who, state, up = self.group.who, self._state, motion.axes[:, :, 2]
        speeds = state.speeds[who]
        thrusts = self._rotors.thrusts(speeds)
        pushes = (self._thrust_shares * thrusts.sum(axis=1, keepdims=True)) * up
        airspeeds = in_body(motion.axes, motion.velocities - state.wind[who])
        drag, turning = self._rotors.drags(speeds, airspeeds, rates)
        moments = self._moment_shares * self._rotors.moments(thrusts) + turning
        forces, bodies = self.group.data.xfrc_applied, self.group.bodies
        forces[bodies, :3] = pushes + in_map(motion.axes, drag)
        forces[bodies, 3:] = in_map(motion.axes, moments)
        self._energy_j[who] += self._rotors.power(speeds) * self._step_s
        self._observe(motion, rates, thrusts)

    def _observe(self, motion: Motion, rates: Floats, thrusts: Floats) -> None:
        """Estimate what else than thrust, weight and the drag of calm air accelerates the bodies."""
        who, inertia, disturbances = self.group.who, self._law.inertia, self._state.disturbances
        lift = (thrusts.sum(axis=1) / self._law.mass)[:, None] * motion.axes[:, :, 2]
        turning = (self._rotors.moments(thrusts) - cross(rates, inertia * rates)) / inertia
        expected = np.hstack([lift - GRAVITY_MPS2 * UP - self._calm_drag(motion), turning])
        velocities = np.hstack([motion.velocities, rates])
        disturbances[who] = self._observer.observed(disturbances[who], velocities, expected)


def within_tilt(force: Floats, mass: Floats) -> Floats:
    """Wanted forces (n, 3) N with a lift of 0.5 to 1.5 times the weight, and a tilt of at most `MOST_TILT`."""
    weight = mass * GRAVITY_MPS2
    lift = np.clip(force[:, 2], 0.5 * weight, 1.5 * weight)
    level = np.hypot(force[:, 0], force[:, 1])
    share = np.minimum(level, math.tan(MOST_TILT) * lift) / np.maximum(level, 1e-12)
    return np.column_stack([share * force[:, 0], share * force[:, 1], lift])
