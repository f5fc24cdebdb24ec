"""The picture of a roadmap: every edge once, passages apart, an arrow on each one-way edge."""

import numpy as np
import pytest

from muster.mission.lanes import Lane, Lanes
from muster.mission.model import Map, Mission, Robot, Zone
from muster.report.maps.roadmap_picture import plot_roadmap
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.passages import passages

pytest.importorskip("matplotlib")
ROBOT = Robot(id="r", position=(1, 1), radius_m=0.3, end_position=(2.45, 8))
AISLE = Map(
    boundary=((0, 0), (8, 0), (8, 10), (0, 10)),
    zones=(Zone(polygon=((0, 3), (2, 3), (2, 10), (0, 10))), Zone(polygon=((2.9, 3), (8, 3), (8, 10), (2.9, 10)))),
)


def picture(mission):
    made = MissionRoadmap.of(mission)
    return made.roadmap, plot_roadmap(mission, made, passages(made.roadmap))


def segments(drawn, ax, gid):
    (collection,) = drawn(ax, gid)
    return [tuple(map(tuple, piece)) for piece in collection.get_segments()]


def test_each_edge_is_drawn_once_and_dead_ends_apart(drawn):
    roadmap, ax = picture(Mission(robots=(ROBOT,), tasks=(), map=AISLE))
    lanes, dead = segments(drawn, ax, "lane"), segments(drawn, ax, "dead-end")
    ends = {frozenset(map(tuple, roadmap.points[edge].tolist())) for edge in roadmap.edges}
    assert len(lanes) + len(dead) == len(ends) == len(roadmap.edges) / 2
    assert {frozenset(piece) for piece in lanes + dead} == ends
    assert all(2 < x < 2.9 for piece in dead for x, y in piece if y > 4)
    (holding,) = drawn(ax, "holding-place")
    np.testing.assert_array_equal(holding.get_xydata(), roadmap.points[roadmap.holding])
    assert ax.get_legend() is not None


def test_one_way_lanes_have_arrows_along_their_way(drawn):
    nodes = {"a": (0, 0), "b": (4, 0), "c": (4, 3)}
    lanes = Lanes(
        nodes=nodes,
        edges=(Lane(start="a", end="b", both_ways=True, capacity=1), Lane(start="c", end="b", capacity=1)),
    )
    roadmap, ax = picture(Mission(robots=(Robot(id="r", position=(0, 0), radius_m=0.3),), tasks=(), lanes=lanes))
    assert roadmap.one_way.sum() == 1
    (arrow,) = drawn(ax, "one-way-0")
    tail, head = arrow._posA_posB
    assert tail == (4, 3)
    np.testing.assert_allclose(head, (4, 3 - 0.6 * 3))
