"""The ground of one robot of a team that has neither a map nor a centre: what it sees itself, and what others send it.

The robot maps what its lidar sees, and sends what has changed as pieces (`perception.map_pieces`). Its ways are by the
map of all pieces that it has. What is agreed is by the map of those that all members of an epoch have, as all compute
the same prices.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import deepcopy
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Task
from muster.model.problem import Problem
from muster.motion.map_world import body_of
from muster.perception.explored_paths import ExploredPaths
from muster.perception.laser import LIDAR
from muster.perception.map_pieces import PieceMaker, PooledMap
from muster.perception.occupancy_map import Scan
from muster.perception.team_map import TeamMap
from muster.running.lidar_scans import LOOK_S
from muster.running.team_ground import TeamGround
from muster_team.auctions.valuation import TeamValuer
from muster_team.knowledge.messages import Reach
from muster_team.network.map_link import PIECE_BYTES, MapLink

if TYPE_CHECKING:
    from muster.execution import Executor
    from muster_team.negotiators.negotiator import Negotiator
    from muster_team.processes.node import Node


class RobotGround(TeamGround):
    """The ground as one robot knows it; see `TeamGround`.

    Parameters
    ----------
    problem : Problem
        The mission, of whose map the boundary, no-fly zones and doors are known.
    known : TeamMap
        The map as it is known beforehand.
    robot : str
        The robot.
    link : MapLink
        How it shares pieces with the others.

    Attributes
    ----------
    link : MapLink
        As above.
    """

    def __init__(self, problem: Problem, known: TeamMap, robot: str, link: MapLink) -> None:
        super().__init__(problem.mission, known.rules, deepcopy(known), None)
        self.link = link
        self._body = body_of(problem.robots[problem.robot_index[robot]])
        self._own, self._common = deepcopy(known), deepcopy(known)
        self._pieces = PieceMaker(self._own, PIECE_BYTES)
        self._pool = PooledMap(self.map)
        self._due_s = -math.inf

    @property
    def ways_closed(self) -> int:
        """How often the robot has gone another way, as its own was closed."""
        return self._turned

    def join(self, node: Node) -> None:
        """Share pieces over a node, and let its negotiator price ways by them."""
        node.beside = self.link
        self.inform(node.negotiator)

    def inform(self, negotiator: Negotiator) -> None:
        """Let a negotiator declare which pieces the robot has, and price ways by those that all have."""
        negotiator.seen = lambda: self.link.reach
        assert isinstance(negotiator.valuer, TeamValuer)
        negotiator.valuer.by_map = self.priced

    def begin(self, executor: Executor) -> None:
        """Find the ways of the robot of this executor from now on."""
        self._executor = executor

    def see(self, scan: Scan) -> list[bytes]:
        """Map what the robot's lidar sees, and send the others what is new; return the pieces of that."""
        self._own.see(scan, LIDAR, self._body, 0.0)
        self._pieces.cover(np.array(scan.pose[:2]), self._body.radius_m)
        pieces = self._pieces.pieces()
        self.link.add(pieces)
        return pieces

    def look(self, now: float) -> None:
        """Take in the pieces that have come, if that is due, and go another way where the robot's own is closed."""
        if now < self._due_s:
            return
        self._due_s = now + LOOK_S
        self._take_in()
        self.map.begin_look()
        self._pool.settle()
        self.follow_map(now, changed=self.map.end_look())

    def reaches(self, place: Sequence[float], task: Task) -> bool:
        """Return whether the robot's map leaves a way from a place to a task."""
        size = self._world_of_mission.dimensions
        return math.isfinite(self.paths.leg_m(self._body, tuple(place[:size]), tuple(task.position[:size])))

    def priced(self, problem: Problem, seen: tuple[Reach, ...]) -> Problem:
        """Return a problem with the ways of the map that the first pieces of each robot make, as many as `seen` has."""
        if not seen:
            return problem
        self._take_in()
        self._pool.enter_first({(one.robot, one.life): one.pieces for one in seen}, self._common)
        by_map = replace(problem, known=None, mapped=ExploredPaths(self._common))
        return replace(by_map, known=by_map.measured)

    def _take_in(self) -> None:
        for track, piece in self.link.take_new():
            try:
                self._pool.add(track, piece)
            except ParameterError:
                continue  # it counts as an empty one, for all robots alike
