"""Travel over the mission's map: for each class of robots a table of path lengths (docs/design.md, Meaning)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from muster.mission.values.arrays import Floats
from muster.model.lengths import Measured
from muster.model.task_geometry import TaskGeometry
from muster.motion.actions.action import Leg, TaskMotion
from muster.motion.leg_times import LegTimes
from muster.motion.map_world import Body
from muster.motion.path import NoPath
from muster.motion.paths.robot_paths import RobotPaths


@dataclass(frozen=True, eq=False)
class MapTravel:
    """Shortest paths between the places of a problem, and along the way points of its actions.

    Parameters
    ----------
    robot_paths
        of the mission.
    bodies, times
        of each class of robots: their bodies, and how long legs take them.
    geometry
        entries, exits and costs of the tasks for each class of robots.
    exits, entries
        (classes, p, 3) metres in the map frame: where places are left and entered; first the n tasks.
    """

    robot_paths: RobotPaths
    bodies: tuple[Body, ...]
    times: tuple[LegTimes, ...]
    geometry: TaskGeometry
    exits: Floats
    entries: Floats

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
        return self.geometry.legs(lambda k, leg, doing: self.robot_paths.leg_m(self._body(k, doing), *leg))

    def measured(self, threads: int) -> Measured:
        """All lengths."""
        found = [self.lengths(k, exits, threads) for k, exits in enumerate(self.exits)]
        classes, along_lanes = self.geometry.classes, self.robot_paths.lanes is not None
        legs = tuple({j: m for j, m in row.items() if math.isfinite(sum(m))} for row in self.legs)
        return Measured(
            np.array([metres for metres, _ in found]),
            classes,
            np.where(np.isinf(self.costs), 0.0, self.costs),
            classes,
            legs,
            over_map=not self.robot_paths.straight,
            seconds=np.array([seconds for _, seconds in found]) if along_lanes else np.empty(0),
            driven_s=tuple(map(self._driven_s, range(len(self.bodies)))) if along_lanes else (),
        )

    def lengths(self, k: int, exits: Floats, threads: int) -> tuple[Floats, Floats]:
        """(q, p) metres, and seconds, for class k from exits (q, 3) to the entry of each place.

        They are inf where there is no way, and to a task whose own way points cannot all be passed.
        """
        entries = self.entries[k]
        metres, seconds = self.robot_paths.measured(self.bodies[k], exits, entries, threads)
        if seconds is None:
            apart = entries[None] - exits[:, None]
            with np.errstate(invalid="ignore"):  # there may be no way
                seconds = self.times[k].seconds(metres, np.abs(apart[..., 2]), np.linalg.norm(apart, axis=2))
            seconds = np.where(np.isinf(metres), math.inf, seconds)
        cut_off = np.flatnonzero(np.isinf(self.costs[k]))
        metres[:, cut_off] = seconds[:, cut_off] = math.inf
        return metres, seconds

    def _driven_s(self, k: int) -> Mapping[int, float]:
        """For a class of robots as `Measured.driven_s`."""
        body = self.bodies[k]
        if body.times is None:
            return {}
        travels = {j: doing.legs for (c, j), doing in self.geometry.moving.items() if c == k and doing.is_travel}
        seconds = {j: sum(self.robot_paths.leg_s(body, *leg) for leg in legs) for j, legs in travels.items()}
        return {j: s for j, s in seconds.items() if math.isfinite(s)}

    def _body(self, k: int, doing: TaskMotion) -> Body:
        """The body of a class at work: beside the lanes, but where work is travel."""
        return self.bodies[k] if doing.is_travel else self.bodies[k].off_lanes

    def why_not(self, i: int, start: int, end: int) -> str:
        """Why robot i has no way from one place to another."""
        k = int(self.geometry.classes[i])
        body, d = self.bodies[k], self.robot_paths.world.dimensions
        found = self.robot_paths.path(body, self.exits[k, start, :d].tolist(), self.entries[k, end, :d].tolist())
        if isinstance(found, NoPath):
            return f"{found.reason}: {found.detail}"
        doing = self.geometry.moving.get((k, end))
        for own, leg in [(self._body(k, doing), leg) for leg in doing.legs] if doing is not None else ():
            found = self.robot_paths.path(own, *leg)
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
