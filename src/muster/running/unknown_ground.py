"""A team without a map: what its lidars see becomes one map, by which it plans its ways and its work.

Each robot scans where it truly is, and enters what it sees where it takes itself to be. What a silent robot sees
reaches the team when it is heard again. The map and its frontiers are the team's; the world's true map is used for what
lidars measure, and to compare ways in the report.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.execution.reports.report import Report
from muster.mission.model import Mission, Robot
from muster.motion.grid import Floats
from muster.motion.map_world import body_of
from muster.motion.unreachable_places import checked_world
from muster.perception.explored_paths import require_travel_by_map
from muster.perception.laser import LIDAR
from muster.perception.occupancy_map import Scan
from muster.perception.sphere_scanner import SPHERE_LIDAR
from muster.perception.team_map import TeamMap
from muster.perception.voxel_map import SpaceScan
from muster.running.driven_ways import DrivenWays
from muster.running.exploration import Exploration, looks_m
from muster.running.lidar_scans import LidarScans, is_heard, look_s, room_m
from muster.running.team_ground import TeamGround
from muster.simulation import SimulatedWorld

if TYPE_CHECKING:
    from muster.execution import Executor
    from muster.motion.port import RobotPort, Telemetry

KEEP_S = 5.0
"""Seconds between two snapshots of the map."""


@dataclass
class _Lidar:
    """The lidar of a robot: where it scanned last, and the scans that have not reached the team."""

    at: Floats = field(default_factory=lambda: np.full(3, np.inf))
    unsent: list[Scan | SpaceScan] = field(default_factory=list)


class UnknownGround(TeamGround):
    """The ground of a simulated run whose robots have no map; see `TeamGround`.

    Parameters
    ----------
    mission : Mission
        The mission with its true map.
    explore : bool
        Whether frontiers become tasks; of themselves they do where there are tags to be found.

    Attributes
    ----------
    due_s : float
        When robots scan next.

    Raises
    ------
    ParameterError
        If the mission has no map by which robots travel.
    """

    def __init__(self, mission: Mission, *, explore: bool) -> None:
        require_travel_by_map(mission)
        truth = checked_world(mission)
        team_map = TeamMap(truth, mission)
        super().__init__(mission, truth, team_map, Exploration(mission, team_map) if explore or mission.tags else None)
        self._lidars: dict[str, _Lidar] = {}
        self._ways = DrivenWays(truth)
        self._told = 0
        self._kept_s, self._kept = -math.inf, dict[str, Any]()
        self.due_s = -math.inf
        self.take_in(*mission.all_robots)

    def take_in(self, *robots: Robot) -> None:
        """Take in robots, or one that joins."""
        in_plane = [robot for robot in robots if self.map.air is None or robot.kind != "air"]
        self.map.keep_off(room_m(in_plane))

    def snapshot(self) -> Mapping[str, Any]:
        """Return the map as plain data for `begin`; it is some seconds old at most."""
        now = self._world.time_s
        if now >= self._kept_s + KEEP_S:
            self._kept_s, self._kept = now, self.map.snapshot()
        return self._kept

    def begin(
        self,
        world: SimulatedWorld,
        ports: Mapping[str, RobotPort],
        executor: Executor,
        snapshot: Mapping[str, Any] | None,
    ) -> None:
        """Scan for the first time, in a world whose robots these are; with the map of a run that was interrupted."""
        self._world, self._ports, self._executor = world, ports, executor
        self._scans = LidarScans(world, self._world_of_mission, lambda: self.paths.world, self.map.cell_m, self.robot)
        if snapshot is not None:
            self.map.resume(snapshot)
            self.paths.grown()
            if self._exploration is not None:
                self._exploration.resume(executor)
        self.look(world.time_s)

    def look(self, now: float) -> None:
        """Let robots scan if that is due, go other ways where theirs turn out to be closed, and explore."""
        if now < self.due_s - 1e-9:
            return
        self.due_s = now + look_s(self.map.ground.least_m)
        self._executor.set_clock(now)
        crew = self._executor.crew  # a robot that joins is in the world before it is one of it
        said = {name: port.telemetry() for name, port in self._ports.items() if name in crew}
        self.follow_map(now, changed=self._scan(now, said))
        self._follow_ways()
        self.show(now)

    def with_ground(self, report: Report) -> Report:
        """Return a report with what was explored, and ways beside those with the map."""
        self._follow_ways()
        return self._ways.with_ways(super().with_ground(report))

    def _follow_ways(self) -> None:
        events = self._executor.events
        self._ways.follow(self._world, events.since(self._told), self.robot)
        self._told = events.total

    def _scan(self, now: float, said: Mapping[str, Telemetry | None]) -> bool:
        """Let robots scan; return whether the map of obstacles has changed."""
        self.map.begin_look()
        for number, name in enumerate(self._world.ports):
            if name not in self._executor.crew:
                continue
            lidar = self._lidars.setdefault(name, _Lidar())
            place = self._world.positions[number].copy()
            still = math.dist(place, lidar.at) < self.map.cell_m
            if still and not lidar.unsent:
                continue
            heard = is_heard(said.get(name), now, self._world.dt_s)
            if not still:
                lidar.at = place
                told = said.get(name) if heard else None
                lidar.unsent += self._scans_of(name, number, told, said)
            for scan in lidar.unsent if heard else ():
                self._enter(scan, self.robot(name))
            if heard:
                lidar.unsent.clear()
        return self.map.end_look()

    def _enter(self, scan: Scan | SpaceScan, robot: Robot) -> None:
        if isinstance(scan, SpaceScan):
            self.map.see_space(scan, SPHERE_LIDAR, looks_m(robot))
        else:
            self.map.see(scan, LIDAR, body_of(robot), looks_m(robot))

    def _scans_of(
        self, name: str, number: int, told: Telemetry | None, said: Mapping[str, Telemetry | None]
    ) -> list[Scan | SpaceScan]:
        """Return what a robot sees: around itself where the team maps the air, and in its plane unless it is there."""
        scans: list[Scan | SpaceScan] = []
        if self.map.air is not None:
            scans.append(self._scans.around(self.robot(name), number, told, said))
        if self.map.air is None or self.robot(name).kind != "air":
            scans.append(self._scans.in_plane(self.robot(name), number, told, said))
        return scans


def unknown_ground_for(mission: Mission, unknown: bool, explore: bool) -> UnknownGround | None:
    """Return the ground of a run whose robots have no map; None where they have it."""
    return UnknownGround(mission, explore=explore) if unknown else None
