"""Travel over the mission's map: for each class of robots a table of path lengths (docs/design.md, Meaning)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from muster.mission.model import Robot
from muster.mission.values.arrays import Floats
from muster.model.lengths import Measured
from muster.model.task_geometry import TaskGeometry
from muster.motion.actions.action import Leg
from muster.motion.map_world import Body, body_of
from muster.motion.path import NoPath
from muster.motion.paths.robot_paths import RobotPaths


@dataclass(frozen=True, eq=False)
class MapTravel:
    """Shortest paths between the places of a problem, and along the way points of its actions.

    Parameters
    ----------
    robot_paths
        of the mission.
    bodies
        of each class of robots.
    geometry
        entries, exits and costs of the tasks for each class of robots.
    exits, entries
        (classes, p, 3) metres in the map frame: where places are left and entered; first the n tasks.
    """

    robot_paths: RobotPaths
    bodies: tuple[Body, ...]
    geometry: TaskGeometry
    exits: Floats
    entries: Floats

    @classmethod
    def of(
        cls, robot_paths: RobotPaths, robots: Sequence[Robot], geometry: TaskGeometry, exits: Floats, entries: Floats
    ) -> MapTravel:
        return cls(robot_paths, tuple(body_of(robots[i]) for i in geometry.firsts), geometry, exits, entries)

    @cached_property
    def costs(self) -> Floats:
        """(classes, n) metres along the way points of actions, else the typed costs; inf where there is no way."""
        costs = self.geometry.costs.copy()
        for k, row in enumerate(self.legs):
            for j, metres in row.items():
                costs[k, j] = sum(metres)
        for k, j in self._crossed:
            if math.isinf(self.robot_paths.leg_m(self.bodies[k], *self._across(k, j))):
                costs[k, j] = math.inf
        return costs

    @cached_property
    def legs(self) -> tuple[Mapping[int, tuple[float, ...]], ...]:
        """As `Measured.legs`; inf where there is no way."""
        return self.geometry.legs(lambda k, leg: self.robot_paths.leg_m(self.bodies[k], *leg))

    def measured(self, threads: int) -> Measured:
        """All lengths."""
        table = np.array([self.lengths(k, exits, threads) for k, exits in enumerate(self.exits)])
        classes = self.geometry.classes
        legs = tuple({j: m for j, m in row.items() if math.isfinite(sum(m))} for row in self.legs)
        return Measured(
            table,
            classes,
            np.where(np.isinf(self.costs), 0.0, self.costs),
            classes,
            legs,
            over_map=not self.robot_paths.straight,
        )

    def lengths(self, k: int, exits: Floats, threads: int) -> Floats:
        """(q, p) metres for class k from exits (q, 3) to the entry of each place; inf where there is no way.

        There is none to a task whose own way points cannot all be passed.
        """
        metres = self.robot_paths.lengths(self.bodies[k], exits, self.entries[k], threads)
        metres[:, np.flatnonzero(np.isinf(self.costs[k]))] = math.inf
        return metres

    def why_not(self, i: int, start: int, end: int) -> str:
        """Why robot i has no way from one place to another."""
        k = int(self.geometry.classes[i])
        body, d = self.bodies[k], self.robot_paths.world.dimensions
        found = self.robot_paths.path(body, self.exits[k, start, :d].tolist(), self.entries[k, end, :d].tolist())
        if isinstance(found, NoPath):
            return f"{found.reason}: {found.detail}"
        doing = self.geometry.moving.get((k, end))
        for leg in doing.legs if doing is not None else ():
            found = self.robot_paths.path(body, *leg)
            if isinstance(found, NoPath):
                return f"{found.reason} on the way of its action: {found.detail}"
        if (k, end) in self._crossed:
            found = self.robot_paths.path(body, *self._across(k, end))
            if isinstance(found, NoPath):
                return f"{found.reason} on the way to its exit: {found.detail}"
        return "there is no way to it"

    @cached_property
    def _crossed(self) -> frozenset[tuple[int, int]]:
        """Classes and tasks without geometry that are left elsewhere than entered."""
        n = self.geometry.costs.shape[1]
        apart = (self.entries[:, :n] != self.exits[:, :n]).any(axis=2)
        return frozenset((int(k), int(j)) for k, j in np.argwhere(apart)) - self.geometry.moving.keys()

    def _across(self, k: int, j: int) -> Leg:
        d = self.robot_paths.world.dimensions
        return tuple(self.entries[k, j, :d].tolist()), tuple(self.exits[k, j, :d].tolist())
