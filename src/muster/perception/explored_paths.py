"""The paths of a team over ground that it explores: what plans and orders ask for, by the map as it is by now."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Point
from muster.mission.values.arrays import Floats
from muster.motion.map_world import Body
from muster.motion.path import NoPath, Path
from muster.motion.paths.robot_paths import RobotPaths
from muster.perception.explored_ground import ExploredGround


class ExploredPaths(RobotPaths):
    """Paths over ground that is partly known; see `ExploredGround`.

    Parameters
    ----------
    ground : ExploredGround
        The ground; `grown` is to be called when its map of obstacles has changed.
    """

    def __init__(self, ground: ExploredGround) -> None:
        super().__init__(ground.rules)
        self.ground = ground

    def grown(self) -> None:
        """Find ways by the map as it is now."""
        self.ground.grown()
        self._finders.clear()
        self._legs.clear()

    def close(self, closed: Collection[str]) -> None:
        """See `RobotPaths`."""
        super().close(closed)
        self.ground.close(self.world)

    def _told(self, found: NoPath, body: Body, start: Point, goal: Point) -> NoPath:
        return found

    def _finder(self, body: Body) -> _Ways:  # type: ignore[override]
        return _Ways(self.ground, body)


@dataclass(frozen=True)
class _Ways:
    """Ways of one body; see `PathFinder`."""

    ground: ExploredGround
    body: Body

    def path(self, start: Point, goal: Point) -> Path | NoPath:
        return self.ground.way(self.body, start, goal)

    def clear(self, points: Floats) -> bool:
        return self.ground.is_free(self.body, points[:, :2])

    def lengths(self, exits: Floats, entries: Floats, *, threads: int = 1) -> Floats:
        return self.ground.lengths(self.body, exits, entries)


def require_flat(mission: Mission) -> None:
    """Raise `ParameterError` unless a mission has a map in the plane, by which its robots travel."""
    if mission.dimensions != 2:
        raise ParameterError(f"unknown: mission {mission.name} is in space; expected one in the plane")
    if mission.travel_rule != "map":
        value = "no map" if mission.map is None else f"travel {mission.travel_rule}"
        raise ParameterError(f"unknown: mission {mission.name} has {value}; expected one with a map and travel by it")
