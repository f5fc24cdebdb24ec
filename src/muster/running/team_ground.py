"""Ground that a team does not know: one map, by which the team plans its ways and its work; subclasses fill the map."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from muster.execution.reports.report import GroundReport, Report
from muster.mission.model import Map, Mission, Robot
from muster.motion.map_world import World, body_of
from muster.motion.maps.ros_yaml import write_ros_map
from muster.perception.explored_paths import ExploredPaths
from muster.perception.map_zones import zones_of
from muster.perception.team_map import TeamMap
from muster.running.exploration import Exploration
from muster.running.explored_cells import ShownMap
from muster.running.observed_run import files_of_map

if TYPE_CHECKING:
    from muster.execution import Executor

SHOW_S = 2.0
"""Seconds between two events that tell how the map has grown."""
APART_CELLS = 3
"""Cells around where another robot says that it is in which hits are no obstacles."""


class TeamGround:
    """The ground of a run whose robots have no map.

    Parameters
    ----------
    mission : Mission
        The mission; of its map the team knows the boundary, no-fly zones and doors.
    world : World
        The world of the mission.
    team_map : TeamMap
        The map that the team builds.
    exploration : Exploration, optional
        Makes tasks of the frontiers of the map.

    Attributes
    ----------
    mission : Mission
        The mission as the team knows it, without obstacles.
    paths : ExploredPaths
        The ways by the map as it is by now.
    """

    def __init__(self, mission: Mission, world: World, team_map: TeamMap, exploration: Exploration | None) -> None:
        self._world_of_mission = world
        self.map = team_map
        self.paths = ExploredPaths(team_map)
        self.mission = without_obstacles(mission, team_map.rules)
        self._shown = ShownMap(team_map)
        self._shown_s = -math.inf
        self._exploration = exploration
        self._turned = 0
        self._executor: Executor

    @property
    def cell_m(self) -> float:
        """The side of a cell of the map, metres."""
        return round(self.map.cell_m, 6)

    def save(self, file: Path) -> None:
        """Write the map in the form of ROS: a file (.yaml), its image (.pgm) beside it.

        In space that is the ground as it is for the widest robots on it; the mission is written beside it
        (.mission.yaml), with what was seen in the air as zones.
        """
        seen = self.map.ground.seen
        write_ros_map(file, seen.known, seen.occupied, seen.frame)
        if self.map.air is not None and self.mission.map is not None:
            zones = (*self.mission.map.zones, *zones_of(self.map.air.seen))
            built = replace(self.mission, map=replace(self.mission.map, zones=zones))
            built.save(files_of_map(file)[2])

    def follow_map(self, now: float, *, changed: bool) -> None:
        """Let robots go other ways where theirs turn out to be closed, and explore.

        Parameters
        ----------
        now : float
            The mission's clock, seconds.
        changed : bool
            Whether obstacles of the map have changed.
        """
        if changed:
            self.paths.grown()
            self._executor.forget_ways()
        closed = [name for name in self._executor.crew if self._is_closed(name)]
        self._turned += len(closed)
        self._executor.go_other_ways(closed)
        if self._exploration is not None:
            self._exploration.look(self._executor, now)

    def show(self, now: float) -> None:
        """Emit how the map has grown, if that is due."""
        if now >= self._shown_s + SHOW_S or self._executor.done:
            self._shown_s = now
            if (grown := self._shown.event()) is not None:
                self._executor.emit(grown)

    def with_ground(self, report: Report) -> Report:
        """Return a report with what was explored; frontiers that no robot had to go to are in no list of tasks."""
        tasks: set[str] = set() if self._exploration is None else self._exploration.tasks
        return replace(
            report,
            tasks_lost=tuple((task, why) for task, why in report.tasks_lost if task not in tasks),
            ground=GroundReport(
                explored_m2=self._shown.explored_m2,
                ways_closed=self._turned,
                frontiers=len(tasks),
                frontiers_seen=len(tasks - set(report.tasks_done)),
            ),
        )

    def robot(self, name: str) -> Robot:
        """Return a robot of the crew."""
        return self._executor.crew[name].robot

    def _is_closed(self, name: str) -> bool:
        """Whether obstacles that were not known are in the way of a robot."""
        state = self._executor.crew[name]
        if state.out or not state.points_left:
            return False
        size = self._world_of_mission.dimensions
        way = np.array([state.position[:size], *(point[:size] for point in state.points_left)])
        return self.map.is_closed(body_of(state.robot), way)


def without_obstacles(mission: Mission, rules: World) -> Mission:
    """Return a mission whose map has its boundary, no-fly zones and doors alone."""
    assert rules.boundary is not None
    corners = tuple((float(x), float(y)) for x, y in rules.boundary.exterior.coords[:-1])
    return replace(mission, map=Map(boundary=corners, zones=tuple(area.zone for area in rules.areas)))
