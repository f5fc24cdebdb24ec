"""Passages for one: how many there are, which are dead ends, and where robots can rest."""

import numpy as np
import pytest
import shapely

from muster.mission.lanes import Lane, Lanes
from muster.motion.free_space import PolygonSpace
from muster.motion.maps.polygons import free_region
from muster.traffic.passages import passages
from muster.traffic.roadmaps.roadmap import Roadmap

RADIUS = 0.3
HALL = shapely.box(0, 0, 12, 4)


def roadmap_of(shape, places=()):
    return Roadmap.of(PolygonSpace(free_region(shape, [], RADIUS)), RADIUS, places)


def exits(roadmap):
    return sorted(one.exits for one in passages(roadmap))


def aisles(*columns, top):
    return [shapely.box(x, 4, x + 0.8, top) for x in columns]


def test_a_hall_has_no_passages():
    roadmap = roadmap_of(HALL)
    assert passages(roadmap) == ()
    assert roadmap.holding.all()


def test_aisles_are_dead_ends_until_they_open_into_another_hall():
    dead = roadmap_of(shapely.union_all([HALL, *aisles(2, 5, 8, top=9)]))
    assert exits(dead) == [1, 1, 1]
    assert all(one.is_dead_end for one in passages(dead))
    racks = [shapely.box(left, 4, right, 9) for left, right in ((0, 2), (2.8, 5), (5.8, 8), (8.8, 12))]
    through = Roadmap.of(PolygonSpace(free_region(shapely.box(0, 0, 12, 12), racks, RADIUS)), RADIUS)
    assert exits(through) == [2, 2, 2]
    assert not any(one.is_dead_end for one in passages(through))


def test_the_points_of_a_passage_are_those_in_it():
    roadmap = roadmap_of(shapely.union_all([HALL, *aisles(5, top=9)]))
    (one,) = passages(roadmap)
    deep = np.flatnonzero(roadmap.points[:, 1] > 4)
    assert set(deep) <= set(one.points)
    assert (roadmap.points[one.points, 1] > 3).all()


def test_a_task_at_the_end_of_an_aisle_opens_no_way_out():
    roadmap = roadmap_of(shapely.union_all([HALL, *aisles(5, top=9)]), [(5.4, 8.65), (5.4, 8.5)])
    assert exits(roadmap) == [1]


def test_a_door_is_a_passage_between_rooms():
    rooms = shapely.union_all([shapely.box(0, 0, 5, 5), shapely.box(5.3, 0, 10, 5), shapely.box(4, 2, 6, 2.9)])
    roadmap = roadmap_of(rooms)
    (door,) = passages(roadmap)
    assert door.exits == 2
    sill = roadmap.points[door.points]
    assert np.abs(sill - (5.15, 2.45)).max(axis=1).min() < 0.06


def test_a_corridor_that_is_closed_at_both_ends_is_one_passage_without_an_exit():
    roadmap = roadmap_of(shapely.box(0, 0, 6, 0.9))
    (one,) = passages(roadmap)
    assert (one.exits, one.is_dead_end) == (0, False)
    assert len(one.points) == len(roadmap.points)


@pytest.mark.parametrize("width", [1.4, 2.0])
def test_where_two_get_past_each_other_is_no_passage_for_one(width):
    shape = shapely.union_all([shapely.box(0, 0, 5, 5), shapely.box(11, 0, 16, 5), shapely.box(4, 2, 12, 2 + width)])
    roadmap = roadmap_of(shape)
    assert passages(roadmap) == ()


def test_the_ends_of_a_corridor_have_points():
    """A place near an end is no reason to leave it out: two robots stand left of the third."""
    roadmap = roadmap_of(shapely.box(0, 0, 10, 0.9), [(1, 0.45), (9, 0.45)])
    assert roadmap.points[:, 0].min() < 0.38
    assert roadmap.points[:, 0].max() > 9.62


def test_a_ring_of_lanes_is_a_passage_and_a_siding_is_not():
    """A robot that waits on a siding lets others pass; the ring has none."""
    corners = {"a": (0, 0), "b": (4, 0), "c": (4, 4), "d": (0, 4)}
    ring = [Lane(start=u, end=v, capacity=1) for u, v in ("ab", "bc", "cd", "da")]
    roadmap = Roadmap.of_lanes(Lanes(nodes=corners, edges=tuple(ring)), RADIUS)
    assert not roadmap.holding.any()
    siding = [Lane(start="b", end="e", both_ways=True, capacity=1)]
    nodes = corners | {"e": (6, 0)}
    with_siding = Roadmap.of_lanes(Lanes(nodes=nodes, edges=(*ring, *siding)), RADIUS)
    assert with_siding.holding.tolist() == [False] * 4 + [True]
