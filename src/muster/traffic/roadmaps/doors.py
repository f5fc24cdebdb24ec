"""Doors on a roadmap: which edges lead into zones that are closed, or along lanes that are."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from muster.mission.lanes import Lanes
from muster.mission.model import Mission
from muster.mission.values.arrays import Bools
from muster.motion.grid import Floats
from muster.motion.map_world import World
from muster.traffic.roadmaps.lane_sections import ON_LANE_M

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
        by id the closed polygon.
    lanes
        by id the ends of a lane, (2, 2) metres.
    closed
        the ids of those that are closed at first.
    """

    zones: Mapping[str, shapely.Polygon]
    lanes: Mapping[str, Floats]
    closed: frozenset[str]

    @classmethod
    def of(cls, mission: Mission, kind: str, world: World | None) -> RoadmapDoors:
        """Those that concern a kind of robots, of which `world` has the zones."""
        areas = () if world is None else world.areas
        stopping = [(area.zone.id, area.polygon) for area in areas if kind in area.zone.forbidden_to]
        zones = {name: polygon for name, polygon in stopping if name is not None}
        lanes = {} if mission.lanes is None else _lane_doors(mission.lanes)
        return cls(zones, lanes, frozenset() if world is None else world.closed & zones.keys())

    def open_ways(self, pieces: Pieces, closed: Collection[str], radius_m: npt.ArrayLike) -> Bools:
        """Which straight pieces lead into no closed zone or lane; who is in one gets out again.

        `radius_m` (n,) of the robot on each piece, or of all: its centre stays so far from a closed zone.
        """
        found = np.ones(len(pieces), dtype=np.bool_)
        radii_m = np.asarray(radius_m, dtype=np.float64)
        for door in sorted(closed):
            if door in self.zones:
                found &= ~_into(pieces, self.zones[door], radii_m)
            elif door in self.lanes:
                found &= ~_along(pieces, self.lanes[door], np.maximum(ON_LANE_M, radii_m))
        return found


def _lane_doors(given: Lanes) -> dict[str, Floats]:
    """The lanes with an id."""
    ends = {lane.id: (given.nodes[lane.start], given.nodes[lane.end]) for lane in given.edges if lane.id}
    return {name: np.array(places)[:, :2] for name, places in ends.items()}


def _into(pieces: Pieces, polygon: shapely.Polygon, away_m: Floats) -> Bools:
    """Which pieces come nearer to a polygon than allowed, but for those that begin so near: robots get out again."""
    import shapely

    near = shapely.distance(shapely.linestrings(pieces), polygon) < away_m
    return np.asarray(near & (shapely.distance(shapely.points(pieces[:, 0]), polygon) >= away_m))


def _along(pieces: Pieces, lane: Floats, beside_m: Floats) -> Bools:
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
