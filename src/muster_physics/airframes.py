"""Airframes of drones whose rotors are simulated one by one: masses, rotors, motors, gains, flight times.

`FIREFLY` is the AscTec Firefly of RotorS [furrer2016]: its vehicle parameters, its motor model and the gains of its
controller. `RB5` is the quadcopter of [tcf-thesis] with the mass, thrust and flight time of Table A.19. Its motors are
those that [dronecode2024] models, so that it has their constants; where its rotors sit and its inertia are ours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from muster.motion.grid import Floats

MOST_ROTORS = 6
GRAVITY_MPS2 = 9.81


@dataclass(frozen=True)
class Gains:
    """Gains of the controller of [lee2010]: x, y and z of the map for position and velocity, of the body for the rest.

    Parameters
    ----------
    position, velocity
        N/m and N s/m.
    attitude, angular_rate
        N m and N m s.
    """

    position: float
    velocity: float
    attitude: tuple[float, float, float]
    angular_rate: tuple[float, float, float]


@dataclass(frozen=True)
class Airframe:
    """A drone, its rotors in the plane of its body.

    Parameters
    ----------
    mass_kg, inertia_kgm2
        with rotors and sensors; about its axes.
    rotors
        x ahead and y to the left of each rotor, metres; 1 if it turns against the clock, seen from above, else -1.
    rotor_height_m, rotor_radius_m
        above the centre of mass; of the disc.
    motor_constant, moment_constant
        thrust in N is the first times the squared speed in rad/s; the moment about the axis in N m is the second, in
        metres, times thrust.
    most_radps, up_s, down_s
        the highest speed of a rotor, and the time constants in which speed follows its command up and down.
    drag, rolling
        of a rotor: N and N m for each rad/s and each m/s of air across its axis [martin2010].
    gains
        of its controller.
    flight_s
        for which a full battery lets it hover.
    """

    name: str
    mass_kg: float
    inertia_kgm2: tuple[float, float, float]
    rotors: tuple[tuple[float, float, int], ...]
    rotor_height_m: float
    rotor_radius_m: float
    motor_constant: float
    moment_constant: float
    most_radps: float
    up_s: float
    down_s: float
    drag: float
    rolling: float
    gains: Gains
    flight_s: float

    @property
    def radius_m(self) -> float:
        """From its middle to the tip of a rotor."""
        return max(math.hypot(x, y) for x, y, _ in self.rotors) + self.rotor_radius_m

    @property
    def allocation(self) -> Floats:
        """(4, rotors): from thrusts in N to moments about the body's x, y and z in N m, and the whole thrust."""
        x, y, turns = np.array(self.rotors, dtype=np.float64).T
        return np.array([y, -x, -self.moment_constant * turns, np.ones_like(x)])

    @property
    def hover_radps(self) -> float:
        """The speed of rotors at which their thrust equals the weight."""
        return math.sqrt(self.mass_kg * GRAVITY_MPS2 / (len(self.rotors) * self.motor_constant))

    @property
    def hover_w(self) -> float:
        """Power of the rotors while hovering: moments times speeds."""
        return self.moment_constant * self.mass_kg * GRAVITY_MPS2 * self.hover_radps

    def scaled(self, scale: float) -> Airframe:
        """With all lengths `scale` times as great, of equal density, and with equal motion.

        Rotors turn as fast and motors answer as fast; forces go with mass, moments with mass times length squared, so
        that accelerations and angular accelerations for equal errors are equal.
        """
        if scale == 1.0:
            return self
        mass, inertia = scale**3, scale**5
        gains = self.gains
        return replace(
            self,
            mass_kg=mass * self.mass_kg,
            inertia_kgm2=_times(self.inertia_kgm2, inertia),
            rotors=tuple((scale * x, scale * y, turns) for x, y, turns in self.rotors),
            rotor_height_m=scale * self.rotor_height_m,
            rotor_radius_m=scale * self.rotor_radius_m,
            motor_constant=mass * self.motor_constant,
            moment_constant=scale * self.moment_constant,
            drag=mass * self.drag,
            rolling=mass * scale * self.rolling,
            gains=Gains(
                mass * gains.position,
                mass * gains.velocity,
                _times(gains.attitude, inertia),
                _times(gains.angular_rate, inertia),
            ),
        )


def _times(numbers: tuple[float, float, float], factor: float) -> tuple[float, float, float]:
    x, y, z = numbers
    return factor * x, factor * y, factor * z


def _ring(arm_m: float, angles_deg: tuple[float, ...]) -> tuple[tuple[float, float, int], ...]:
    """Rotors on a circle that turn by turns against and with the clock."""
    angles = [math.radians(angle) for angle in angles_deg]
    return tuple((arm_m * math.cos(a), arm_m * math.sin(a), 1 - 2 * (k % 2)) for k, a in enumerate(angles))


MOTOR_CONSTANT = 8.54858e-06
FIREFLY = Airframe(
    name="firefly",
    mass_kg=1.56779,
    inertia_kgm2=(0.0347563, 0.0458929, 0.0977),
    rotors=_ring(0.215, (30, 90, 150, -150, -90, -30)),
    rotor_height_m=0.037,
    rotor_radius_m=0.1,
    motor_constant=MOTOR_CONSTANT,
    moment_constant=0.016,
    most_radps=838.0,
    up_s=0.0125,
    down_s=0.025,
    drag=8.06428e-05,
    rolling=1e-06,
    gains=Gains(6.0, 4.7, (3.0, 3.0, 0.15), (0.52, 0.52, 0.18)),
    flight_s=13 * 60.0,
)
"""The Firefly in RotorS: `firefly.xacro`, `firefly.yaml`, `lee_controller_firefly.yaml`. The flight time is ours."""

RB5_FULL_N, RB5_HALF_N = 9.896, 3.068
"""Table A.19: thrust of a motor at 100 % and at 50 % throttle."""
RB5 = Airframe(
    name="rb5",
    mass_kg=1.235,
    inertia_kgm2=(0.0312, 0.0312, 0.0593),
    rotors=_ring(0.25, (45, 135, -135, -45)),
    rotor_height_m=0.037,
    rotor_radius_m=0.127,
    motor_constant=MOTOR_CONSTANT,
    moment_constant=0.016,
    most_radps=math.sqrt(RB5_FULL_N / MOTOR_CONSTANT),
    up_s=0.0125,
    down_s=0.025,
    drag=8.06428e-05,
    rolling=1e-06,
    gains=Gains(4.73, 3.70, (2.69, 2.69, 0.091), (0.467, 0.467, 0.109)),
    flight_s=20 * 60.0,
)
"""The thesis' drone. Its inertia is a cylinder's of 0.31 m; its gains give the motion that the Firefly's give."""


def rb5_thrust(throttle: float) -> float:
    """Thrust in N of a motor of the RB5 at a throttle of 0 to 1: the parabola through 0 and what Table A.19 has."""
    linear = 4 * RB5_HALF_N - RB5_FULL_N
    return linear * throttle + (RB5_FULL_N - linear) * throttle**2


def rb5_throttle(thrust_n: float) -> float:
    """The throttle, 0 to 1, at which a motor of the RB5 gives a thrust in N; the inverse of `rb5_thrust`."""
    linear = 4 * RB5_HALF_N - RB5_FULL_N
    square = RB5_FULL_N - linear
    return (math.sqrt(linear**2 + 4 * square * thrust_n) - linear) / (2 * square)


def throttle_of_pulse(pulse_us: float, least_us: float = 1000.0, most_us: float = 2000.0) -> float:
    """(A.23): the throttle, 0 to 1, of a motor's pulse in microseconds.

    (A.23) divides by the longest pulse, by which 2000 us would be a throttle of 50 %. Here the range of pulses divides.
    """
    return (pulse_us - least_us) / (most_us - least_us)
