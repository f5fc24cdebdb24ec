"""What rays in the physics world meet: bodies as they are drawn, walls that stop a robot, the ground."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from muster.motion.grid import Bools, Floats
from muster_physics.library import mujoco
from muster_physics.model import FIRST_WALLS_BIT, UNSEEN
from muster_physics.simulated_model import SimulatedModel

_GROUPS = np.array([group != UNSEEN for group in range(6)], dtype=np.uint8)
"""Hulls of robots are for contacts: their bodies are seen as they are drawn."""


class Rays:
    """Laser rays from the robots of a model.

    A robot's rays pass through itself, through walls that do not stop it, and through scenery.

    Parameters
    ----------
    walls
        by robot the number of the set of walls that stops it.
    """

    def __init__(self, simulated: SimulatedModel, walls: Sequence[int]) -> None:
        self._simulated = simulated
        model = simulated.model
        owner = model.body_rootid[model.geom_bodyid]
        wall_set = _wall_sets(model.geom_contype, owner)
        scenery = (owner == 0) & (model.geom_contype == 0)
        self._unseen: list[Bools] = [
            (owner == body) | scenery | ((wall_set >= 0) & (wall_set != number))
            for body, number in zip(simulated.bodies, walls, strict=True)
        ]

    def lengths(self, robot: int, place: Floats, beams: Floats, reach_m: float) -> Floats:
        """From a place (3,) along beams (n, 3) of length 1 to what each meets first: (n,) metres, inf beyond reach."""
        model, groups = self._simulated.model, self._simulated.model.geom_group
        met = np.empty(len(beams))
        which = np.empty(len(beams), dtype=np.int32)
        before = groups.copy()
        groups[self._unseen[robot]] = UNSEEN  # MuJoCo itself leaves out no more than one body
        try:
            args = (place, beams.ravel(), _GROUPS, True, -1, which, met, None, len(beams), reach_m)
            mujoco.mj_multiRay(model, self._simulated.data, *args)
        finally:
            groups[:] = before
        return np.where((met >= 0) & (met <= reach_m), met, math.inf)


def _wall_sets(types: Floats, owner: Floats) -> Floats:
    """Of each geom the number of the set of walls that it is of; below 0 for what is no wall."""
    of_world = np.where(owner == 0, types, 0)
    return np.log2(np.maximum(of_world, 1)) - FIRST_WALLS_BIT
