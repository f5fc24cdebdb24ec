"""The ground of a negotiated run whose robots have no map: what lidars measure, and the map for those who look on.

The map is that of all pieces that robots have made. No robot sees it: each has its own pieces, and those that reach it.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from muster.execution.reports.report import Report
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot
from muster.motion.grid import Floats
from muster.motion.unreachable_places import checked_world
from muster.perception.explored_paths import require_travel_by_map
from muster.perception.map_pieces import PooledMap
from muster.perception.occupancy_map import Scan
from muster.perception.team_map import TeamMap
from muster.running.driven_ways import DrivenWays
from muster.running.lidar_scans import LidarScans, look_s, room_m
from muster.running.state_estimation import RobotsInWorld
from muster.running.team_ground import SHOW_S, TeamGround
from muster.simulation import SimulatedWorld
from muster.state.ground_events import GroundUnknown
from muster_team.runs.team_log import TeamLog


class ScannedGround(TeamGround):
    """The ground of a negotiated run; see `TeamGround`.

    Parameters
    ----------
    mission : Mission
        The mission with its true map.

    Attributes
    ----------
    known : TeamMap
        The map as robots know it beforehand.

    Raises
    ------
    ParameterError
        If the mission has no map by which robots travel, or has robots in the air of a mission in space.
    """

    def __init__(self, mission: Mission) -> None:
        require_travel_by_map(mission)
        truth = checked_world(mission)
        self.known, team_map = TeamMap(truth, mission), TeamMap(truth, mission)
        if team_map.air is not None:
            name = next(robot.id for robot in mission.all_robots if robot.kind == "air")
            raise ParameterError(
                f"unknown: robot {name} is in the air; expected robots on the ground where robots negotiate, or a plan"
            )
        for built in (self.known, team_map):
            built.keep_off(room_m(mission.all_robots))
        super().__init__(mission, truth, team_map, None)
        self._pool = PooledMap(team_map)
        self._by_id = {robot.id: robot for robot in mission.all_robots}
        self._ways = DrivenWays(truth)
        self._scanned_at: dict[str, Floats] = {}
        self._due_s = -math.inf
        self._told = 0

    def robot(self, name: str) -> Robot:
        """Return a robot of the mission."""
        return self._by_id[name]

    def begin_in(self, world: SimulatedWorld, robots: RobotsInWorld, log: TeamLog) -> None:
        """Let the robots of a world scan from now on."""
        self._world, self._robots, self._log = world, robots, log
        self._scans = LidarScans(world, self._world_of_mission, lambda: self.paths.world, self.map.cell_m, self.robot)
        log.tell(GroundUnknown(time_s=world.time_s, cell_m=self.cell_m))

    def scans(self, living: Collection[str], connected: Collection[str]) -> Mapping[str, Scan]:
        """Return the scans of robots that have moved, if scans are due.

        Robots that are connected tell each other where they are: there each has no obstacle.
        """
        if self._world.time_s < self._due_s - 1e-9:
            return {}
        self._due_s = self._world.time_s + look_s(self.map.ground.least_m)
        said = {name: port.telemetry() for name, port in self._robots.ports.items()}
        told = {name: said[name] for name in connected if name in said}
        scans = {}
        for number, name in enumerate(self._world.ports):
            place = self._world.positions[number].copy()
            if name in living and math.dist(place, self._scanned_at.get(name, np.full(3, np.inf))) >= self.map.cell_m:
                self._scanned_at[name] = place
                others = told if name in connected else {}
                scans[name] = self._scans.in_plane(self.robot(name), number, said.get(name), others)
        return scans

    def forget(self, robot: str) -> None:
        """A robot starts anew: it scans where it stands."""
        self._scanned_at.pop(robot, None)

    def take(self, robot: str, life: int, pieces: Sequence[bytes]) -> None:
        """Take in the pieces that a robot has made in one of its lives."""
        for piece in pieces:
            self._pool.add((robot, life), piece)

    def follow(self, *, over: bool = False) -> None:
        """Compare ways, and tell how the map has grown if that is due."""
        events = self._log.events
        self._ways.follow(self._world, events[self._told :], self.robot)
        self._told = len(events)
        now = self._world.time_s
        if now >= self._shown_s + SHOW_S or over:
            self._shown_s = now
            self.map.begin_look()
            self._pool.settle()
            self.map.end_look()
            if (grown := self._shown.event()) is not None:
                self._log.tell(grown.at(now))

    def with_all(self, report: Report, ways_closed: int) -> Report:
        """Return a report with what was explored, and ways beside those with the map."""
        self._turned = ways_closed
        return self._ways.with_ways(self.with_ground(report))
