"""A team of real robots without a common map: the maps that they build themselves become one.

Each robot maps as its own software does, and tells its map as an occupancy grid. The newest grid of each robot counts.
What one robot has as an obstacle is an obstacle, also where others have seen it to be free, unless more than nine
times as many have.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from muster.execution.fleet import Fleet
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.motion.map_world import World, body_of
from muster.perception.explored_paths import require_travel_by_map
from muster.perception.robot_grids import RobotGrid, SeenCells, in_cells_of
from muster.perception.team_map import TeamMap
from muster.running.exploration import Exploration
from muster.running.run_request import RunRequest
from muster.running.team_ground import TeamGround

if TYPE_CHECKING:
    from muster.execution import Executor
    from muster.motion.port import RobotPort, Telemetry


@runtime_checkable
class MappingFleet(Protocol):
    """A fleet whose robots tell the maps that they build."""

    def hear_maps(self) -> None:
        """Listen to the maps of all robots from now on; robots without one are not ready then."""
        ...

    def new_maps(self) -> Mapping[str, RobotGrid]:
        """Return the maps that have come since the last call, the newest of each robot, in the mission's frame."""
        ...

    def robots_not_ready(self) -> Mapping[str, str]:
        """Return robots of the mission that cannot be sent anywhere yet, and what is missing."""
        ...


class MappedGround(TeamGround):
    """The ground of real robots that map it themselves; see `TeamGround`.

    Parameters
    ----------
    mission : Mission
        The mission; of its map the boundary, no-fly zones and doors are known.
    fleet : MappingFleet
        The robots, which have told their maps.
    explore : bool
        Whether frontiers become tasks.

    Attributes
    ----------
    fleet : MappingFleet
        The robots.

    Raises
    ------
    ParameterError
        If the mission has no map by which robots travel, or robots in the air of a mission in space.
    """

    def __init__(self, mission: Mission, fleet: MappingFleet, *, explore: bool) -> None:
        require_travel_by_map(mission)
        world = World.of(mission)
        team_map = TeamMap(world, mission, fills_cells=True)
        if team_map.air is not None:
            name = next(robot.id for robot in mission.all_robots if robot.kind == "air")
            raise ParameterError(f"unknown: robot {name} is in the air; expected robots whose maps are of the ground")
        mission_without_tags = replace(mission, tags=())  # whose frontiers are those of cameras
        super().__init__(mission, world, team_map, Exploration(mission_without_tags, team_map) if explore else None)
        self.fleet = fleet
        self._maps: dict[str, SeenCells] = {}

    def begin(self, ports: Mapping[str, RobotPort], executor: Executor) -> None:
        """Merge the maps of the robots as they are now."""
        self._ports, self._executor = ports, executor
        self.look(executor.now_s)

    def look(self, now: float) -> None:
        """Merge maps that have come, let robots go other ways where theirs turn out to be closed, and explore."""
        self.map.begin_look()
        changed = self._merge_new()
        self.follow_map(now, changed=changed)
        self.show(now)

    def _merge_new(self) -> bool:
        """Merge the maps that have come; return whether obstacles have changed."""
        come = {robot: grid for robot, grid in self.fleet.new_maps().items() if robot in self._executor.crew}
        if not come:
            return False
        said = {name: port.telemetry() for name, port in self._ports.items() if name in self._executor.crew}
        for robot, grid in come.items():
            self._maps[robot] = self._without_robots(robot, in_cells_of(self.map.ground.seen.frame, grid), said)
        self.map.merge((body_of(self.robot(robot)), cells) for robot, cells in self._maps.items())
        return self.map.end_look()

    def _without_robots(self, robot: str, cells: SeenCells, said: Mapping[str, Telemetry | None]) -> SeenCells:
        """Return a map without the obstacles that are other robots, where these say that they are."""
        occupied = np.argwhere(cells.occupied)
        robots = occupied[~self.are_things(robot, self.map.ground.seen.centres(occupied), said)]
        cells.occupied[tuple(robots.T)] = False
        return cells


def mapped_ground_for(mission: Mission, fleet: Fleet, request: RunRequest) -> MappedGround | None:
    """Return the ground of a run whose robots have no common map, and listen to theirs; None where they have one.

    Raises
    ------
    ParameterError
        If robots of this fleet tell no maps; as `MappedGround`.
    """
    if not request.unknown:
        return None
    if not isinstance(fleet, MappingFleet):
        raise ParameterError(f"unknown: true; expected false: robots of fleet {request.world} tell no maps")
    ground = MappedGround(mission, fleet, explore=request.explore)
    fleet.hear_maps()
    return ground
