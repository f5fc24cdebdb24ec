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
from muster.perception.explored_air import ExploredAir
from muster.perception.explored_ground import ExploredGround
from muster.perception.team_map import TeamMap


class ExploredPaths(RobotPaths):
    """Paths over ground and through air that is partly known; see `TeamMap`.

    Parameters
    ----------
    team_map : TeamMap
        The map; `grown` is to be called when its obstacles have changed.
    """

    def __init__(self, team_map: TeamMap) -> None:
        super().__init__(team_map.rules)
        self.team_map = team_map

    def grown(self) -> None:
        """Find ways by the map as it is now."""
        self._finders.clear()
        self._legs.clear()

    def close(self, closed: Collection[str]) -> None:
        """See `RobotPaths`."""
        super().close(closed)
        self.team_map.close(self.world)

    def _told(self, found: NoPath, body: Body, start: Point, goal: Point) -> NoPath:
        return found

    def _finder(self, body: Body) -> _Ways:  # type: ignore[override]
        return _Ways(self.team_map.of(body), body)


@dataclass(frozen=True)
class _Ways:
    """Ways of one body; see `PathFinder`."""

    ground: ExploredGround | ExploredAir
    body: Body

    def path(self, start: Point, goal: Point) -> Path | NoPath:
        return self.ground.way(self.body, start, goal)

    def clear(self, points: Floats) -> bool:
        return self.ground.is_free(self.body, points)

    def lengths(self, exits: Floats, entries: Floats, *, threads: int = 1) -> Floats:
        return self.ground.lengths(self.body, exits, entries)


def require_travel_by_map(mission: Mission) -> None:
    """Raise `ParameterError` unless a mission has a map by which its robots travel."""
    if mission.travel_rule != "map":
        value = "no map" if mission.map is None else f"travel {mission.travel_rule}"
        raise ParameterError(f"unknown: mission {mission.name} has {value}; expected one with a map and travel by it")
