"""Travel over the mission's map: by class of robots a table of the paths that will be driven (DESIGN section 4)."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from muster.allocation.doings import Doings
from muster.allocation.travel import require_room
from muster.mission.model import Mission, Robot
from muster.motion.actions.action import Leg
from muster.motion.path import NoPath
from muster.motion.roads import Roads
from muster.motion.world import Body, body_of

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MapTravel:
    """Shortest paths between the places of a problem, and along the way points of its actions.

    Parameters
    ----------
    roads
        of the mission.
    bodies
        of each class of robots.
    doings
        what they do at the tasks, by body.
    exits, entries
        (classes, p, 3) metres in the map frame: where places are left and entered.
    """

    roads: Roads
    bodies: tuple[Body, ...]
    doings: Doings
    exits: Floats
    entries: Floats

    @classmethod
    def of(cls, mission: Mission, robots: Sequence[Robot], doings: Doings, exits: Floats, entries: Floats) -> MapTravel:
        """Read the map.

        Raises
        ------
        MissionError
            for a map that is wrong, and for robots that start or end where they cannot stand.
        MissingExtraError
            if the extra `map` is not installed.
        NotSupportedError
            for more places than a table can hold.
        """
        require_room(mission, exits.shape[1], "travel over a map")
        bodies = tuple(body_of(robots[i]) for i in doings.firsts)
        return cls(Roads.of(mission), bodies, doings, exits, entries)

    @cached_property
    def costs(self) -> Floats:
        """(classes, n) metres along the way points of actions, else the typed costs; inf where there is no way."""
        costs = self.doings.costs.copy()
        for (k, j), doing in self.doings.moving.items():
            costs[k, j] = sum(self._metres(self.bodies[k], leg) for leg in doing.legs)
        return costs

    def table(self) -> Floats:
        """(classes, p, p) metres from the exit of each place to the entry of each other; inf where there is no way.

        There is none to a task whose own way points cannot all be passed.
        """
        threads = os.cpu_count() or 1
        lengths = zip(self.bodies, self.exits, self.entries, strict=True)
        table = np.array([self.roads.lengths(body, exits, entries, threads) for body, exits, entries in lengths])
        for k, j in np.argwhere(np.isinf(self.costs)):
            table[k, :, j] = math.inf
        return table

    def why_not(self, i: int, start: int, end: int) -> str:
        """Why robot i has no way from one place to another."""
        k = int(self.doings.classes[i])
        body, d = self.bodies[k], self.roads.world.dimensions
        found = self.roads.path(body, self.exits[k, start, :d].tolist(), self.entries[k, end, :d].tolist())
        if isinstance(found, NoPath):
            return f"{found.reason}: {found.detail}"
        doing = self.doings.moving.get((k, end))
        for leg in doing.legs if doing is not None else ():
            found = self.roads.path(body, *leg)
            if isinstance(found, NoPath):
                return f"{found.reason} on the way of its action: {found.detail}"
        return "there is no way to it"

    def _metres(self, body: Body, leg: Leg) -> float:
        found = self.roads.path(body, *leg)
        return math.inf if isinstance(found, NoPath) else found.length_m
