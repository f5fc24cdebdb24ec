"""The closed loop of [furrer2016] as differential equations, solved by SciPy: rigid body, motors, [lee2010].

Nothing here is shared with the physics world: neither the integrator, nor the laws, nor the parameters.
"""

from __future__ import annotations

import math

import numpy as np

from muster.mission.values.arrays import Floats
from muster_studies.rotors import published as firefly

_PLACES = np.column_stack(
    [
        firefly.ARM_M * np.cos(firefly.ANGLES_RAD),
        firefly.ARM_M * np.sin(firefly.ANGLES_RAD),
        np.full(6, firefly.ROTOR_ABOVE_M),
    ]
)
_ALLOCATION = np.array(
    [_PLACES[:, 1], -_PLACES[:, 0], -firefly.MOMENT_CONSTANT * firefly.TURNS, np.ones(6)],
)
_TO_THRUSTS = _ALLOCATION.T @ np.linalg.inv(_ALLOCATION @ _ALLOCATION.T)
_UP = np.array([0.0, 0.0, 1.0])


def step_response(goal: Floats, heading: float, times: Floats) -> Floats:
    """(n, 4): x, y, z in metres and heading at `times`, after a step of place (3,) and heading from hovering."""
    from scipy.integrate import solve_ivp

    begin = np.concatenate([np.zeros(6), np.eye(3).ravel(), np.zeros(3), np.full(6, firefly.HOVER_RADPS)])
    solved = solve_ivp(
        lambda _, state: _rates(state, goal, heading),
        (0.0, float(times[-1])),
        begin,
        t_eval=times,
        method="LSODA",
        rtol=1e-8,
        atol=1e-9,
        max_step=0.01,
    )
    headings = np.arctan2(solved.y[9], solved.y[6])
    return np.column_stack([solved.y[:3].T, headings])


def _rates(state: Floats, goal: Floats, heading: float) -> Floats:
    position, velocity, spin, speeds = state[:3], state[3:6], state[15:18], state[18:]
    axes = state[6:15].reshape(3, 3)
    wanted = np.clip(_commanded(position - goal, velocity, axes, spin, heading), 0.0, firefly.MOST_RADPS)
    thrusts = firefly.MOTOR_CONSTANT * speeds**2
    force, moment = _air(velocity, axes, spin, speeds)
    moment = moment + (_ALLOCATION @ thrusts)[:3]
    acceleration = (thrusts.sum() * axes[:, 2] + force) / firefly.MASS_KG - firefly.GRAVITY_MPS2 * _UP
    turning = (moment - np.cross(spin, firefly.INERTIA_KGM2 * spin)) / firefly.INERTIA_KGM2
    lag = np.where(wanted > speeds, firefly.UP_S, firefly.DOWN_S)
    return np.concatenate([velocity, acceleration, (axes @ _skew(spin)).ravel(), turning, (wanted - speeds) / lag])


def _commanded(error: Floats, velocity: Floats, axes: Floats, spin: Floats, heading: float) -> Floats:
    """[lee2010] to the speeds of rotors."""
    force = -firefly.POSITION_GAIN * error - firefly.VELOCITY_GAIN * velocity
    force = force + firefly.MASS_KG * firefly.GRAVITY_MPS2 * _UP
    up = force / np.linalg.norm(force)
    left = np.cross(up, [math.cos(heading), math.sin(heading), 0.0])
    left /= np.linalg.norm(left)
    goal = np.column_stack([np.cross(left, up), left, up])
    off = 0.5 * (goal.T @ axes - axes.T @ goal)
    moment = -firefly.ATTITUDE_GAIN * [off[2, 1], off[0, 2], off[1, 0]] - firefly.RATE_GAIN * spin
    moment = moment + np.cross(spin, firefly.INERTIA_KGM2 * spin)
    thrusts: Floats = _TO_THRUSTS @ [*moment, force @ axes[:, 2]]
    return np.sqrt(np.maximum(thrusts, 0.0) / firefly.MOTOR_CONSTANT)


def _air(velocity: Floats, axes: Floats, spin: Floats, speeds: Floats) -> tuple[Floats, Floats]:
    """Force in the map frame and moment in the body frame of drag on each rotor."""
    met = (axes.T @ velocity)[None, :] + np.cross(spin[None, :], _PLACES)
    met = met * (1.0, 1.0, 0.0)
    drags = -firefly.ROTOR_DRAG * speeds[:, None] * met
    moments = np.cross(_PLACES, drags) - firefly.ROLLING_MOMENT * speeds[:, None] * met
    return axes @ drags.sum(axis=0), moments.sum(axis=0)


def _skew(spin: Floats) -> Floats:
    x, y, z = spin
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
