"""Travel over the mission's map: for each body a table of the paths that will be driven (DESIGN section 4)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import Finding, NotSupportedError
from muster.mission.model import Mission, Robot
from muster.motion.path import NoPath
from muster.motion.roads import Roads, body_of
from muster.motion.world import Body

Floats = npt.NDArray[np.float64]

_MOST_PLACES = 6_000  # tasks, starts and ends: 288 MB a table


@dataclass(frozen=True, eq=False)
class MapTravel:
    """Shortest paths between the places of a problem.

    Parameters
    ----------
    roads
        of the mission.
    bodies, classes
        the different bodies of the robots, and for each robot (m,) the number of its own.
    exits, entries
        (p, 3) metres in the map frame: where places are left and entered.
    """

    roads: Roads
    bodies: tuple[Body, ...]
    classes: npt.NDArray[np.int32]
    exits: Floats
    entries: Floats

    @classmethod
    def of(cls, mission: Mission, robots: Sequence[Robot], exits: Floats, entries: Floats) -> MapTravel:
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
        if len(exits) > _MOST_PLACES:
            places = f"{len(exits)} starts, ends and tasks"
            expected = f"at most {_MOST_PLACES} for travel over a map"
            raise NotSupportedError([Finding(mission.source.file, None, "map", places, expected)])
        bodies = tuple(dict.fromkeys(body_of(robot) for robot in robots))
        classes = np.array([bodies.index(body_of(robot)) for robot in robots], dtype=np.int32)
        return cls(Roads.of(mission), bodies, classes, exits, entries)

    def table(self) -> Floats:
        """(classes, p, p) metres from the exit of each place to the entry of each other; inf where there is no way."""
        threads = os.cpu_count() or 1
        return np.array([self.roads.lengths(body, self.exits, self.entries, threads) for body in self.bodies])

    def why_not(self, i: int, start: int, end: int) -> str:
        """Why robot i has no way from one place to another."""
        body = self.bodies[self.classes[i]]
        d = self.roads.world.dimensions
        found = self.roads.path(body, self.exits[start, :d].tolist(), self.entries[end, :d].tolist())
        return f"{found.reason}: {found.detail}" if isinstance(found, NoPath) else "there is no way to it"
