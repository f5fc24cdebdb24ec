"""A team of real robots without a common map: the maps that they build themselves become one.

Each robot maps as its own software does, and tells its map as an occupancy grid. The newest grid of each robot counts.
What one robot has as an obstacle is an obstacle, also where others have seen it to be free, unless more than nine
times as many have. Where a robot has been, others' maps have no obstacles: what they saw there was the robot.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from muster.execution.fleet import Fleet
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot
from muster.motion.grid import Bools, Grid
from muster.motion.map_world import World, body_of
from muster.perception.explored_paths import require_travel_by_map
from muster.perception.robot_grids import RobotGrid, SeenCells, in_cells_of
from muster.perception.team_map import TeamMap
from muster.running.exploration import Exploration
from muster.running.run_request import RunRequest
from muster.running.team_ground import APART_CELLS, TeamGround

if TYPE_CHECKING:
    from muster.execution import Executor
    from muster.motion.port import RobotPort, Telemetry


@runtime_checkable
class MappingFleet(Protocol):
    """A fleet whose robots tell the maps that they build."""

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        """See `Fleet`."""
        ...

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
        self._tracks: dict[str, _Track] = {}

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
        self._follow_robots()
        come = {robot: grid for robot, grid in self.fleet.new_maps().items() if robot in self._executor.crew}
        if not come:
            return False
        for robot, grid in come.items():
            cells = in_cells_of(self.map.ground.seen.frame, grid)
            for other, track in self._tracks.items():
                if other != robot:
                    cells.occupied[track.covered] = False
            self._maps[robot] = cells
        self.map.merge((body_of(self.robot(robot)), cells) for robot, cells in self._maps.items())
        return self.map.end_look()

    def _follow_robots(self) -> None:
        """Note which cells robots have covered: what others have there as an obstacle was the robot itself."""
        frame = self.map.ground.seen.frame
        for robot, state in self._executor.crew.items():
            said = self._ports[robot].telemetry() if robot in self._ports else None
            if said is not None:
                track = self._tracks.setdefault(robot, _Track(np.zeros(frame.shape, dtype=np.bool_)))
                track.follow(frame, said, state.robot)


@dataclass
class _Track:
    """The cells that a robot has covered, with some around them, and what it said last."""

    covered: Bools
    last: Telemetry | None = None

    def follow(self, frame: Grid, said: Telemetry, robot: Robot) -> None:
        """Add the cells between where it was and where it is; from anew where it cannot have driven between the two."""
        last, self.last = self.last, said
        ends = frame.to_grid(np.array([(last or said).position[:2], said.position[:2]]))
        within_m = robot.radius_m + APART_CELLS * frame.resolution_m
        if last is not None:
            gone_m = float(np.linalg.norm(ends[1] - ends[0])) * frame.resolution_m
            if gone_m == 0.0:
                return
            if gone_m > 2 * robot.speed_mps * (said.time_s - last.time_s) + within_m:
                ends[0] = ends[1]
        reach = within_m / frame.resolution_m
        low = np.maximum(np.floor(ends.min(axis=0) - reach), 0).astype(np.int64)
        high = np.ceil(ends.max(axis=0) + reach).astype(np.int64)
        part = np.s_[low[1] : max(high[1], 0), low[0] : max(high[0], 0)]
        rows, columns = self.covered[part].shape
        across, up = np.arange(columns) + low[0] + 0.5, (np.arange(rows) + low[1] + 0.5)[:, None]
        (x, y), along = ends[0], ends[1] - ends[0]
        share = ((across - x) * along[0] + (up - y) * along[1]) / max(float(along @ along), 1e-12)
        share = np.clip(share, 0.0, 1.0)
        self.covered[part] |= np.hypot(across - x - share * along[0], up - y - share * along[1]) <= reach


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
        raise ParameterError("unknown: true; expected false: robots of this fleet tell no maps")
    ground = MappedGround(mission, fleet, explore=request.explore)
    fleet.hear_maps()
    return ground
