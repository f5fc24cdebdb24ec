"""Doors on a roadmap: which edges lead into zones that are closed, or along lanes that are."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from muster.mission.model import Mission
from muster.motion.grid import Floats
from muster.motion.map_world import Body, World

if TYPE_CHECKING:
    import shapely

Bools = npt.NDArray[np.bool_]
Pieces = Floats
"""(n, 2 ends, 2) metres."""
_ON_LANE_M = 1e-6


@dataclass(frozen=True, eq=False)
class RoadmapDoors:
    """The doors of a mission as robots on a roadmap meet them.

    Parameters
    ----------
    zones
        by id the closed polygon, and how far from it the centre of the widest robot has to be.
    lanes
        by id the ends of a lane, (2, 2) metres.
    closed
        the ids of those that are closed at first.
    """

    zones: Mapping[str, tuple[shapely.Polygon, float]]
    lanes: Mapping[str, Floats]
    closed: frozenset[str]

    @classmethod
    def of(cls, mission: Mission, body: Body, world: World | None) -> RoadmapDoors:
        """Those that concern a body, of which `world` has the zones."""
        areas = () if world is None else world.areas
        stopping = [(area.zone.id, area.polygon) for area in areas if body.kind in area.zone.forbidden_to]
        zones = {name: (polygon, body.radius_m) for name, polygon in stopping if name is not None}
        given = ((), {}) if mission.lanes is None else (mission.lanes.edges, mission.lanes.nodes)
        lanes = {lane.id: np.array([given[1][lane.start], given[1][lane.end]]) for lane in given[0] if lane.id}
        return cls(zones, lanes, frozenset() if world is None else world.closed & zones.keys())

    def open_ways(self, pieces: Pieces, closed: Collection[str]) -> Bools:
        """Which straight pieces lead into no closed zone, and along no closed lane."""
        found = np.ones(len(pieces), dtype=np.bool_)
        for door in sorted(closed):
            if door in self.zones:
                found &= ~_into(pieces, *self.zones[door])
            elif door in self.lanes:
                found &= ~_along(pieces, self.lanes[door])
        return found


def _into(pieces: Pieces, polygon: shapely.Polygon, away_m: float) -> Bools:
    """Which pieces come nearer to a polygon than allowed, but for those that begin so near: robots get out again."""
    import shapely

    near = shapely.distance(shapely.linestrings(pieces), polygon) < away_m
    return np.asarray(near & (shapely.distance(shapely.points(pieces[:, 0]), polygon) >= away_m))


def _along(pieces: Pieces, lane: Floats) -> Bools:
    """Which pieces lie on a lane, its two ends included."""
    begin, along = lane[0], lane[1] - lane[0]
    long_m = float(np.hypot(*along))
    unit = along / long_m
    off = pieces - begin
    forward, aside = off @ unit, off @ np.array([-unit[1], unit[0]])
    within = (forward >= -_ON_LANE_M) & (forward <= long_m + _ON_LANE_M) & (np.abs(aside) <= _ON_LANE_M)
    return np.asarray(within.all(axis=1))


NO_DOORS = RoadmapDoors({}, {}, frozenset())
