"""A team without a map: what its lidars see becomes one map, by which it plans its ways and its work.

Each robot scans where it truly is, and enters what it sees where it takes itself to be. What a silent robot sees
reaches the team when it is heard again. The map and its frontiers are the team's; the world's true map is used for what
lidars measure, and to compare ways in the report.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.execution.reports.report import Report
from muster.mission.model import Mission, Robot
from muster.motion.grid import Bools, Floats
from muster.motion.map_world import Body, body_of
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.unreachable_places import checked_world
from muster.perception.explored_paths import require_travel_by_map
from muster.perception.laser import LIDAR
from muster.perception.occupancy_map import Scan
from muster.perception.sphere_scanner import SPHERE_LIDAR
from muster.perception.team_map import TeamMap
from muster.perception.voxel_map import SpaceScan
from muster.running.exploration import Exploration, looks_m
from muster.running.team_ground import APART_CELLS, TeamGround
from muster.simulation import SimulatedWorld
from muster.state.robot_events import RobotAtEnd
from muster.state.task_events import Arrives, Ends

if TYPE_CHECKING:
    from muster.execution import ExecutionEvent, Executor
    from muster.motion.port import RobotPort, Telemetry

LOOK_S = 0.5
"""Seconds between two scans of a robot that moves."""
KEEP_S = 5.0
"""Seconds between two snapshots of the map."""
_ON_BORDER_M = 0.02
"""From the border of a zone in which a beam ends there."""


@dataclass
class _Way:
    """What a robot has driven between places of arrival, and what that takes with the map, metres."""

    at: Floats
    driven_before_m: float
    driven_m: float = 0.0
    with_map_m: float = 0.0


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
        self._with_map = RobotPaths(truth)
        self._lidars: dict[str, _Lidar] = {}
        self._ways: dict[str, _Way] = {}
        self._told = 0
        self._kept_s, self._kept = -math.inf, dict[str, Any]()
        self.due_s = -math.inf

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
        self.due_s = now + LOOK_S
        self._executor.set_clock(now)
        said = {name: port.telemetry() for name, port in self._ports.items()}
        self.follow_map(now, changed=self._scan(now, said))
        self._measure_ways()
        self.show(now)

    def with_ground(self, report: Report) -> Report:
        """Return a report with what was explored, and ways beside those with the map."""
        self._measure_ways()
        driven, known = (sum(getattr(way, name) for way in self._ways.values()) for name in ("driven_m", "with_map_m"))
        report = super().with_ground(report)
        assert report.ground is not None
        return replace(report, ground=replace(report.ground, driven_m=driven, with_map_m=known))

    def _scan(self, now: float, said: Mapping[str, Telemetry | None]) -> bool:
        """Let robots scan; return whether the map of obstacles has changed."""
        self.map.begin_look()
        for number, name in enumerate(self._world.ports):
            lidar = self._lidars.setdefault(name, _Lidar())
            place = self._world.positions[number].copy()
            still = math.dist(place, lidar.at) < self.map.cell_m
            if still and not lidar.unsent:
                continue
            heard = _is_heard(said.get(name), now, self._world.dt_s)
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
            scans.append(self._space_scan_of(name, number, told, said))
        if self.map.air is None or self.robot(name).kind != "air":
            scans.append(self._scan_of(name, number, told, said))
        return scans

    def _space_scan_of(
        self, name: str, number: int, told: Telemetry | None, said: Mapping[str, Telemetry | None]
    ) -> SpaceScan:
        """One scan all around; where another robot says that it is there is no obstacle."""
        eye, heading = self._world.positions[number].copy(), float(self._world.headings[number])
        if told is not None:
            eye, heading = np.array(told.position), told.heading
        seen = self._world.scan_space(name, SPHERE_LIDAR)
        scan = SpaceScan(eye, heading, seen.ranges, np.isfinite(seen.ranges) & ~seen.on_ground, seen.on_ground)
        ends, _ = scan.points(SPHERE_LIDAR)
        scan.hits[scan.hits] = self._are_things(name, ends, said)
        return scan

    def _are_things(self, robot: str, places: Floats, said: Mapping[str, Telemetry | None]) -> Bools:
        """Return which places (n, d) at which a robot met something are not where other robots say that they are."""
        is_thing = np.ones(len(places), dtype=np.bool_)
        margin_m = APART_CELLS * self.map.cell_m
        for one, other in said.items():
            if other is not None and one != robot:
                away = np.linalg.norm(places - np.array(other.position)[: places.shape[1]], axis=1)
                is_thing &= away > self.robot(one).radius_m + margin_m
        return is_thing

    def _scan_of(self, name: str, number: int, told: Telemetry | None, said: Mapping[str, Telemetry | None]) -> Scan:
        """One scan from where the robot truly is, with the pose that it takes for its own, as far as it is heard.

        Where another robot says that it is, and on the border of a zone that is closed by rule, there is no obstacle.
        """
        (x, y), heading = self._world.positions[number, :2], float(self._world.headings[number])
        if told is not None:
            (x, y), heading = told.position[:2], told.heading
        ranges = self._world.scan(name, LIDAR)
        scan = Scan.of((float(x), float(y), heading), ranges)
        angles = heading + LIDAR.bearings[scan.hits]
        ends = np.column_stack([x + ranges[scan.hits] * np.cos(angles), y + ranges[scan.hits] * np.sin(angles)])
        is_ruled = self._on_ruled_borders(body_of(self.robot(name)), ends)
        scan.hits[scan.hits] = self._are_things(name, ends, said) & ~is_ruled
        return scan

    def _on_ruled_borders(self, body: Body, places: Floats) -> Bools:
        """Whether places (n, 2) are on the border of a zone that a body may not enter, and that is no obstacle."""
        import shapely

        image = self._world_of_mission.image
        within_m = _ON_BORDER_M if image is None else image.resolution_m
        on = np.zeros(len(places), dtype=np.bool_)
        for area in self.paths.world.stopping(body, self._world_of_mission.dimensions == 3):
            on |= shapely.distance(area.polygon.exterior, shapely.points(places)) <= within_m
        return on

    def _measure_ways(self) -> None:
        """Compare what robots drove from arrival to arrival with the ways that the true map has."""
        driven, places = self._world.distances_m, self._world.positions
        for name, place in zip(self._world.ports, places, strict=True):
            self._ways.setdefault(name, _Way(place.copy(), driven[name]))
        events = self._executor.events
        for event in events.since(self._told):
            self._measure_way(event, driven)
        self._told = events.total

    def _measure_way(self, event: ExecutionEvent, driven: Mapping[str, float]) -> None:
        names: tuple[str, ...]
        if isinstance(event, Arrives | RobotAtEnd):
            names = (event.robot,)
        elif isinstance(event, Ends):
            names = tuple(one for one in (event.robot, *event.team) if one)
        else:
            return
        for name in names:
            way, number = self._ways[name], list(self._world.ports).index(name)
            place = self._world.positions[number].copy()
            if not isinstance(event, Ends):
                size = self._world_of_mission.dimensions
                leg = self._with_map.leg_m(body_of(self.robot(name)), tuple(way.at[:size]), tuple(place[:size]))
                if math.isfinite(leg):
                    way.with_map_m += leg
                    way.driven_m += driven[name] - way.driven_before_m
            way.at, way.driven_before_m = place, driven[name]


def _is_heard(said: Telemetry | None, now: float, dt_s: float) -> bool:
    return said is not None and said.time_s >= now - dt_s / 2


def unknown_ground_for(mission: Mission, unknown: bool, explore: bool) -> UnknownGround | None:
    """Return the ground of a run whose robots have no map; None where they have it."""
    return UnknownGround(mission, explore=explore) if unknown else None
