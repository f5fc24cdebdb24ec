"""Detours round an autopilot's own fence: they keep to it, and to the mission's map, and are as short as may be."""

import math
import random
from itertools import pairwise

import pytest
import shapely
from tests.muster_robots.mavlink.talk import Talk
from tests.muster_robots.mavlink.test_own_fence import INSIDE, L_SHAPE, OUTSIDE, SQUARE, fence

from muster.motion.port import Waypoint
from muster_robots.mavlink.fence_detours import within_limits
from muster_robots.mavlink.mission_items import Detour, given_in
from muster_robots.mavlink.simulated.geofence import Area

HERE = (0.0, 0.0, 10.0)


def free(here, waypoints):
    return ""


def closed(here, waypoints):
    return "the map forbids it"


def kept(own, *places, here=HERE, check=free):
    """What a drone with this fence is sent, or why not."""
    drone = Talk().session.drone
    drone.limits.fence = own
    return within_limits(drone, [Waypoint((*place, 10.0)) for place in places], here, check)


def length(here, waypoints):
    return sum(math.dist(a, b) for a, b in pairwise([here, *(waypoint.position for waypoint in waypoints)]))


def test_what_the_fence_allows_stays_as_it_is():
    assert kept(fence(Area(INSIDE, L_SHAPE)), (60.0, 0.0), (0.0, 0.0), (0.0, 60.0)) == [
        Waypoint((60.0, 0.0, 10.0)),
        Waypoint((0.0, 0.0, 10.0)),
        Waypoint((0.0, 60.0, 10.0)),
    ]


@pytest.mark.parametrize("side", [INSIDE, OUTSIDE])
def test_a_place_that_is_refused_stays_refused(side):
    outside = (100.0, 100.0) if side is INSIDE else (20.0, 20.0)
    assert "expected a place" in kept(fence(Area(side, SQUARE)), outside, here=(-20.0, -20.0, 10.0))


def test_the_detour_of_a_concave_fence_turns_at_its_inner_corner_alone():
    sent = kept(fence(Area(INSIDE, L_SHAPE)), (0.0, 70.0), here=(70.0, 0.0, 10.0))
    (corner, goal) = sent
    assert isinstance(corner, Detour)
    assert math.dist(corner.position[:2], (20.0, 20.0)) < 8.0
    assert corner.position[2] == 10.0
    assert goal == Waypoint((0.0, 70.0, 10.0))


def test_where_a_passage_is_narrow_the_detour_keeps_less_distance():
    walls = [
        Area(OUTSIDE, ((20.0, low), (24.0, low), (24.0, high), (20.0, high))) for low, high in ((-99, 30), (33, 99))
    ]
    around = Area(INSIDE, ((-20.0, -90.0), (90.0, -90.0), (90.0, 90.0), (-20.0, 90.0)))
    sent = kept(fence(around, *walls), (50.0, 0.0))
    assert given_in(sent) == 1
    assert any(30 < waypoint.position[1] < 33 for waypoint in sent)


def test_a_detour_that_the_map_forbids_is_not_flown():
    own = fence(Area(INSIDE, L_SHAPE))
    assert "straight from" in kept(own, (0.0, 70.0), here=(70.0, 0.0, 10.0), check=closed)


def test_way_points_that_are_added_are_not_counted():
    own = fence(Area(OUTSIDE, ((35.0, 0.0),), 20.0))
    sent = kept(own, (70.0, 0.0), HERE[:2], (70.0, 0.0))
    ends = [k for k, waypoint in enumerate(sent, 1) if not isinstance(waypoint, Detour)]
    assert [given_in(sent[:end]) for end in ends] == [1, 2, 3]
    assert all(isinstance(sent[end - 2], Detour) for end in ends)  # each of the three legs is flown round the circle


@pytest.mark.parametrize("seed", range(12))
def test_each_leg_keeps_to_random_fences_and_is_nearly_as_short_as_it_can_be(seed):
    chance = random.Random(seed)
    areas = [
        Area(OUTSIDE, ((chance.uniform(10, 90), chance.uniform(10, 90)),), chance.uniform(3, 15))
        for _ in range(chance.randint(2, 6))
    ]
    own = fence(Area(INSIDE, ((-40.0, -40.0), (150.0, -40.0), (150.0, 150.0), (-40.0, 150.0))), *areas)
    goal = (100.0, 100.0)
    sent = kept(own, goal)
    assert not isinstance(sent, str)
    assert own.refusal([waypoint.position for waypoint in sent], HERE) == ""
    assert sent[-1].position[:2] == goal
    hull = shapely.union_all([shapely.LineString([HERE[:2], goal])] + [area.shape for area in own.areas[1:]])
    one_side = hull.convex_hull.buffer(6.0).length / 2  # at most, of the shorter of the two
    assert math.dist(HERE[:2], goal) <= length(HERE, sent) <= one_side
