"""Two robots that must swap: searched by a plain search of its own, and known cases."""

from collections import deque

import numpy as np
import pytest
import shapely

from muster.motion.free_space import PolygonSpace
from muster.motion.maps.polygons import free_region
from muster.traffic.blockages.impossible_crossings import Crossings, JointPositions
from muster.traffic.roadmaps.roadmap import Roadmap

RADIUS = 0.3
CORRIDOR = shapely.box(0, 0, 6, 0.9)
BAY = shapely.box(2.5, 0, 3.5, 2)


def roadmap_of(shape, places):
    return Roadmap.of(PolygonSpace(free_region(shape, [], RADIUS)), RADIUS, places)


def positions_reached(roadmap, one, other, gap):
    """Every joint position that two robots reach, move by move."""
    near = [
        {
            int(p)
            for p, d in zip(roadmap.reached(k), roadmap.reach_m[slice(*roadmap.reach_start[k : k + 2])], strict=True)
            if d < gap
        }
        for k in range(len(roadmap.edges))
    ]
    seen, left = {(one, other)}, deque([(one, other)])
    while left:
        here = left.popleft()
        for mover in (0, 1):
            stands = here[1 - mover]
            for k in range(roadmap.out_start[here[mover]], roadmap.out_start[here[mover] + 1]):
                there = int(roadmap.edges[k, 1])
                state = (there, stands) if mover == 0 else (stands, there)
                if stands not in near[k] and stands != here[mover] and state not in seen:
                    seen.add(state)
                    left.append(state)
    return seen


@pytest.mark.parametrize("shape", [CORRIDOR, CORRIDOR.union(BAY)], ids=["corridor", "bay"])
@pytest.mark.parametrize("other_radius", [0.05, 0.3])
def test_the_joint_positions_are_those_of_a_plain_search(shape, other_radius):
    roadmap = roadmap_of(shape, [(0.5, 0.45), (5.5, 0.45)])
    gap = RADIUS + other_radius + roadmap.margin_m
    one, other = (int(p) for p in roadmap.places)
    everywhere = np.arange(len(roadmap.points))
    joint = JointPositions.of(roadmap, everywhere, everywhere, gap)
    found = {(int(a), int(b)) for a, b in np.argwhere(joint.reached(one, other))}
    assert found == positions_reached(roadmap, one, other, gap)


@pytest.mark.parametrize(("shape", "swaps"), [(CORRIDOR, False), (CORRIDOR.union(BAY), True)], ids=["corridor", "bay"])
def test_robots_swap_where_there_is_a_bay_and_not_in_a_mere_corridor(shape, swaps):
    roadmap = roadmap_of(shape, [(0.5, 0.45), (5.5, 0.45)])
    west, east = (int(p) for p in roadmap.places)
    crossings = Crossings(roadmap, [west, east], [RADIUS, RADIUS])
    assert crossings.reaches(west, east)
    assert (crossings.blocking(0, [east]) is None) == swaps
    assert (crossings.ends_apart(0, 1, (east, west)) is None) == swaps
    assert crossings.blocking(0, [west]) is None
    assert crossings.ends_apart(0, 1, (west, east)) is None


def test_robots_in_different_rooms_are_not_in_each_others_way():
    rooms = shapely.MultiPolygon([CORRIDOR, shapely.box(0, 5, 6, 5.9)])
    regions = [free_region(room, [], RADIUS) for room in rooms.geoms]
    roadmap = Roadmap.of(PolygonSpace(shapely.MultiPolygon(regions)), RADIUS, [(0.5, 0.45), (5.5, 5.45), (5.5, 0.45)])
    west, other, east = (int(p) for p in roadmap.places)
    crossings = Crossings(roadmap, [west, other], [RADIUS, RADIUS])
    assert crossings.blocking(0, [east, other]) is None
    assert not crossings.reaches(west, other)
