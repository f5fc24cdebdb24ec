"""Simulates many robots that move to their goals and avoid each other by one method.

Holonomic bodies that keep a chosen velocity for a step: [tcf-thesis] (A.21), (A.22).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive
from muster.motion.avoidance.agents import NO_OBSTACLES, Agents, Obstacles
from muster.motion.avoidance.method import Method

Preference = Callable[[Floats, int], Floats]
"""From the places (n, d) of the robots and the number of the step to the velocities (n, d) that they would have."""

CONTACT_M = 1e-9
"""Of overlap: what is less is rounding."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Crowd:
    """Robots with a start and a goal each.

    Parameters
    ----------
    starts, goals
        (n, 2) or (n, 3) metres in the map frame.
    radii
        (n,) metres: of the bodies, by which contact is judged.
    max_speeds
        (n,) metres a second.
    inflated_radii
        (n,) metres: with which they avoid each other; those of the bodies by default.
    priorities
        as in `Agents`.
    """

    starts: Floats
    goals: Floats
    radii: Floats
    max_speeds: Floats
    inflated_radii: Floats | None = None
    priorities: Floats | None = None

    @property
    def avoided_radii(self) -> Floats:
        """The radii with which they avoid each other, (n,) metres."""
        return self.radii if self.inflated_radii is None else self.inflated_radii

    def arrived(self, positions: Floats, tolerance_m: float) -> npt.NDArray[np.bool_]:
        """Which robots are at their goals: (n,).

        A robot is at its goal within the tolerance. Two robots with the same goal, where only one can stand, are both
        there when they are beside each other and both so near to it: within the sum of their inflated radii, and the
        tolerance.
        """
        away = np.linalg.norm(positions - self.goals, axis=1)
        result: npt.NDArray[np.bool_] = away <= tolerance_m
        for i in np.flatnonzero(~result):
            room = self.avoided_radii + self.avoided_radii[i] + tolerance_m
            near = np.maximum(np.linalg.norm(positions - positions[i], axis=1), np.maximum(away, away[i])) <= room
            rivals = (self.goals == self.goals[i]).all(axis=1)
            rivals[i] = False
            result[i] = (near & rivals).any()
        return result


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectories:
    """The result of a crowd's run.

    Parameters
    ----------
    dt
        seconds a step.
    positions
        (steps + 1, n, d) metres in the map frame; between two of them robots move straight and evenly.
    velocities
        (steps, n, d) metres a second.
    arrivals_s
        (n,) seconds after which a robot was at its goal and stayed there until the end; NaN if it is not there.
    least_distances_m
        (steps,) least distance between two centres at any time of the step.
    least_gaps_m
        (steps,) the same less both radii; below 0 in contact.
    contacts
        pairs that ever touched.
    """

    dt: float
    positions: Floats
    velocities: Floats
    arrivals_s: Floats
    least_distances_m: Floats
    least_gaps_m: Floats
    contacts: tuple[tuple[int, int], ...]

    @property
    def all_arrived(self) -> bool:
        return not bool(np.isnan(self.arrivals_s).any())

    @property
    def duration_s(self) -> float:
        return self.dt * len(self.velocities)


def towards(goals: Floats, max_speeds: Floats, dt: float) -> Preference:
    """v_id (A.4): straight to the goal at full speed, and onto it where that is nearer than a step."""

    def preferred(positions: Floats, step: int) -> Floats:
        way = goals - positions
        distance = np.linalg.norm(way, axis=1)
        speed = np.minimum(max_speeds, distance / dt)
        wanted: Floats = way * np.divide(speed, distance, out=np.zeros_like(distance), where=distance > 0)[:, None]
        return wanted

    return preferred


def perturbed(preference: Preference, share: float, seed: int, hold: int = 1) -> Preference:
    """The same velocities, each perturbed at random by this share of its length, which breaks symmetries.

    A perturbation lasts for `hold` steps: one that changes at every step averages out where robots block each other.
    """

    def preferred(positions: Floats, step: int) -> Floats:
        velocities = preference(positions, step)
        noise = np.random.default_rng((seed, step // hold)).normal(size=velocities.shape)
        noise /= np.linalg.norm(noise, axis=1, keepdims=True)
        found: Floats = velocities + share * np.linalg.norm(velocities, axis=1, keepdims=True) * noise
        return found

    return preferred


def run(
    crowd: Crowd,
    method: Method,
    *,
    dt: float,
    until_s: float,
    arrival_m: float,
    preference: Preference | None = None,
    obstacles: Obstacles = NO_OBSTACLES,
) -> Trajectories:
    """Move all robots until they are at their goals, or time is up.

    Robots at their goals keep avoiding the others. `preference` is `towards` the goals by default.

    Raises
    ------
    ParameterError
        if a number is out of range, or arrays do not fit together.
    """
    require_finite_positive(dt=dt, until_s=until_s, arrival_m=arrival_m)
    if crowd.goals.shape != crowd.starts.shape:
        raise ParameterError(f"goals: shape {crowd.goals.shape}; expected {crowd.starts.shape}, as the starts")
    wanted = towards(crowd.goals, crowd.max_speeds, dt) if preference is None else preference
    places, velocities = [crowd.starts], [np.zeros_like(crowd.starts)]
    there = [crowd.arrived(crowd.starts, arrival_m)]
    while not there[-1].all() and len(places) * dt <= until_s + dt / 2:
        agents = Agents(
            positions=places[-1],
            velocities=velocities[-1],
            preferred=wanted(places[-1], len(places) - 1),
            radii=crowd.avoided_radii,
            max_speeds=crowd.max_speeds,
            priorities=crowd.priorities,
        )
        velocities.append(method.velocities(agents, obstacles, dt))
        places.append(places[-1] + dt * velocities[-1])  # (A.22)
        there.append(crowd.arrived(places[-1], arrival_m))
    return _trajectories(crowd, dt, np.array(places), np.array(velocities[1:]), np.array(there))


def _trajectories(
    crowd: Crowd, dt: float, positions: Floats, velocities: Floats, there: npt.NDArray[np.bool_]
) -> Trajectories:
    approach = core.closest_approach_in_plane if crowd.starts.shape[1] == 2 else core.closest_approach_in_space
    distances, gaps, contacts = approach(positions, crowd.radii, CONTACT_M)
    away = len(there) - np.argmax(~there[::-1], axis=0)  # the step after the last one away from the goal
    steps = np.where(there.all(axis=0), 0, away)
    return Trajectories(
        dt=dt,
        positions=positions,
        velocities=velocities.reshape(-1, *crowd.starts.shape),
        arrivals_s=np.where(there[-1], dt * steps, np.nan),
        least_distances_m=np.array(distances),
        least_gaps_m=np.array(gaps),
        contacts=tuple(contacts),
    )
