"""Doors on a roadmap: which edges lead into zones that are closed, or along lanes that are."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.lanes import Lanes
from muster.mission.model import Mission
from muster.mission.values.arrays import Bools
from muster.motion.grid import Floats
from muster.motion.map_world import Body, World
from muster.traffic.lane_sections import ON_LANE_M

if TYPE_CHECKING:
    import shapely

Pieces = Floats
"""(n, 2 ends, 2) metres."""


@dataclass(frozen=True, eq=False)
class RoadmapDoors:
    """The doors of a mission as robots on a roadmap meet them.

    Parameters
    ----------
    zones
        by id the closed polygon, and how far from it the centre of the widest robot has to be.
    lanes
        by id the ends of a lane, (2, 2) metres, and how far from its middle the centre of a robot is that is on it.
    closed
        the ids of those that are closed at first.
    """

    zones: Mapping[str, tuple[shapely.Polygon, float]]
    lanes: Mapping[str, tuple[Floats, float]]
    closed: frozenset[str]

    @classmethod
    def of(cls, mission: Mission, body: Body, world: World | None) -> RoadmapDoors:
        """Those that concern a body, of which `world` has the zones."""
        areas = () if world is None else world.areas
        stopping = [(area.zone.id, area.polygon) for area in areas if body.kind in area.zone.forbidden_to]
        zones = {name: (polygon, body.radius_m) for name, polygon in stopping if name is not None}
        lanes = {} if mission.lanes is None else _lane_doors(mission.lanes, max(ON_LANE_M, body.radius_m))
        return cls(zones, lanes, frozenset() if world is None else world.closed & zones.keys())

    def open_ways(self, pieces: Pieces, closed: Collection[str]) -> Bools:
        """Which straight pieces lead into no closed zone or lane; who is in one gets out again."""
        found = np.ones(len(pieces), dtype=np.bool_)
        for door in sorted(closed):
            if door in self.zones:
                found &= ~_into(pieces, *self.zones[door])
            elif door in self.lanes:
                found &= ~_along(pieces, *self.lanes[door])
        return found


def _lane_doors(given: Lanes, beside_m: float) -> dict[str, tuple[Floats, float]]:
    """The lanes with an id."""
    ends = {lane.id: (given.nodes[lane.start], given.nodes[lane.end]) for lane in given.edges if lane.id}
    return {name: (np.array(places)[:, :2], beside_m) for name, places in ends.items()}


def _into(pieces: Pieces, polygon: shapely.Polygon, away_m: float) -> Bools:
    """Which pieces come nearer to a polygon than allowed, but for those that begin so near: robots get out again."""
    import shapely

    near = shapely.distance(shapely.linestrings(pieces), polygon) < away_m
    return np.asarray(near & (shapely.distance(shapely.points(pieces[:, 0]), polygon) >= away_m))


def _along(pieces: Pieces, lane: Floats, beside_m: float) -> Bools:
    """Which pieces lead onto a lane between its ends or all along it, but for those that begin there."""
    begin, along = lane[0], lane[1] - lane[0]
    long_m = float(np.hypot(*along))
    unit = along / long_m
    off = pieces - begin
    forward, aside = off @ unit, np.abs(off @ np.array([-unit[1], unit[0]]))
    between = (forward > ON_LANE_M) & (forward < long_m - ON_LANE_M)
    begins_there = between[:, 0] & (aside[:, 0] <= beside_m)
    ends_there = between[:, 1] & (aside[:, 1] <= ON_LANE_M)
    overlaps = (forward.min(axis=1) < long_m - ON_LANE_M) & (forward.max(axis=1) > ON_LANE_M)
    all_along = overlaps & (aside <= ON_LANE_M).all(axis=1)
    return np.asarray((ends_there | all_along) & ~begins_there)


NO_DOORS = RoadmapDoors({}, {}, frozenset())
