"""Travel over the mission's map: for each body a table of the paths that will be driven (DESIGN section 4)."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import Finding, NotSupportedError
from muster.mission.model import Mission, Robot
from muster.motion.path import NoPath
from muster.motion.paths import WayFinder
from muster.motion.places import checked_world
from muster.motion.spaces import PrismSpace, Space

Floats = npt.NDArray[np.float64]

_MOST_PLACES = 6_000  # tasks, starts and ends: 288 MB a table


@dataclass(frozen=True, eq=False)
class MapTravel:
    """Shortest paths between the places of a problem.

    Parameters
    ----------
    spaces, finders
        of each class of robots: those with one radius and kind.
    classes
        (m,) the class of each robot.
    exits, entries
        (p, 3) metres in the map frame: where places are left and entered.
    """

    spaces: tuple[Space, ...]
    finders: tuple[WayFinder, ...]
    classes: npt.NDArray[np.int32]
    exits: Floats
    entries: Floats

    @classmethod
    def of(cls, mission: Mission, robots: tuple[Robot, ...], exits: Floats, entries: Floats) -> MapTravel:
        """Read the map, and look at it once for each class.

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
            places = f"{len(exits)} places of tasks and robots"
            raise NotSupportedError([Finding(mission.name, None, "map", places, f"at most {_MOST_PLACES} with a map")])
        world = checked_world(mission)
        bodies = sorted({_body(robot) for robot in robots})
        spaces = tuple(world.free_space(radius, kind) for radius, kind in bodies)
        classes = np.array([bodies.index(_body(robot)) for robot in robots], dtype=np.int32)
        return cls(spaces, tuple(map(WayFinder, spaces)), classes, exits, entries)

    def table(self) -> Floats:
        """(classes, p, p) metres from the exit of each place to the entry of each other; inf where there is no way."""
        threads = os.cpu_count() or 1
        return np.array([self._lengths(c, threads) for c in range(len(self.spaces))])

    def why_not(self, i: int, start: int, end: int) -> str:
        """Why robot i has no way from one place to another."""
        answer = self.finders[self.classes[i]].path(self.exits[start], self.entries[end])
        return f"{answer.reason}: {answer.detail}" if isinstance(answer, NoPath) else "there is no way to it"

    def _lengths(self, c: int, threads: int) -> Floats:
        """Of a way in the plane between places at different heights, the height changes evenly along it."""
        plane = self.finders[c].lengths(self.exits, self.entries, threads=threads)
        if isinstance(self.spaces[c], PrismSpace):
            return plane
        return np.hypot(plane, self.exits[:, None, 2] - self.entries[None, :, 2])


def _body(robot: Robot) -> tuple[float, str]:
    return robot.radius_m, robot.kind
