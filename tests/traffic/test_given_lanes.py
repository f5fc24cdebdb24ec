"""Roadmaps of given lanes: directions, capacities, widths, walls, and the places beside them."""

import numpy as np
import pytest
import shapely

from muster.mission.errors import MissionError
from muster.mission.lanes import Lane, Lanes
from muster.motion.free_space import PolygonSpace
from muster.motion.paths import PathFinder
from muster.traffic.journeys.roadmap_network import Standing, with_places
from muster.traffic.roadmaps.given_lanes import closed_lanes
from muster.traffic.roadmaps.roadmap import Roadmap
from muster.traffic.roadmaps.robot_spaces import RobotSpaces

RADIUS = 0.3
NODES = {"a": (0, 0), "b": (5, 0), "c": (5, 3)}


def lanes(*edges):
    return Lanes(nodes=NODES, edges=tuple(Lane(**edge) for edge in edges))


def placed(graph, *places):
    return with_places(Roadmap.of_lanes(graph, RADIUS), RobotSpaces(), [Standing(place, 0) for place in places])


def test_a_lane_leads_one_way_or_both():
    one = Roadmap.of_lanes(lanes({"start": "a", "end": "b", "capacity": 1}), RADIUS)
    assert one.edges.tolist() == [[0, 1]]
    assert one.one_way.tolist() == [True]
    both = Roadmap.of_lanes(lanes({"start": "a", "end": "b", "capacity": 1, "both_ways": True}), RADIUS)
    assert both.edges.tolist() == [[0, 1], [1, 0]]
    assert not both.one_way.any()
    assert both.names == ("a", "b", "c")


@pytest.mark.parametrize(("capacity", "pieces"), [(1, 1), (3, 3), (None, 8), (100, 8)])
def test_as_many_robots_fit_on_a_lane_as_its_capacity_and_length_say(capacity, pieces):
    """A lane of 5 m has room for eight pieces of at least 0.62 m."""
    roadmap = Roadmap.of_lanes(lanes({"start": "a", "end": "b", "capacity": capacity}), RADIUS)
    assert len(roadmap.edges) == pieces
    np.testing.assert_allclose(roadmap.lengths_m, 5 / pieces)
    inner = roadmap.points[3:]
    np.testing.assert_allclose(np.sort(inner[:, 0]), np.arange(1, pieces) * 5 / pieces)
    heads = {int(v) for _, v in roadmap.edges}
    assert len(heads) == pieces


def at_corner(degrees, **lane):
    """A lane of 8 m to a corner and one of 4 m out of it, with so many degrees between the two."""
    angle = np.radians(degrees)
    nodes = {"a": (8, 0), "b": (0, 0), "c": (4 * np.cos(angle), 4 * np.sin(angle))}
    return Lanes(nodes=nodes, edges=(Lane(start="a", end="b", **lane), Lane(start="b", end="c", **lane)))


@pytest.mark.parametrize("both_ways", [False, True])
@pytest.mark.parametrize("degrees", [3, 20, 40, 60, 75, 90, 135])
def test_who_stops_before_a_sharp_corner_is_out_of_the_way_of_who_leaves_it(degrees, both_ways):
    graph = at_corner(degrees, both_ways=both_ways)
    roadmap = Roadmap.of_lanes(graph, RADIUS)
    inner = shapely.points(roadmap.points[3:])
    own, other = (shapely.LineString([graph.nodes[lane.start], graph.nodes[lane.end]]) for lane in graph.edges)
    on_own = shapely.distance(inner, own) < 1e-9
    assert on_own.any()
    assert shapely.distance(inner[on_own], other).min() >= roadmap.reach
    assert shapely.distance(inner[~on_own], own).min(initial=np.inf) >= roadmap.reach


def test_stops_go_no_farther_back_from_a_corner_than_they_must():
    """At a right angle they are as far apart as on a straight lane; a short lane is in the way only where it is."""
    right = Roadmap.of_lanes(at_corner(90), RADIUS).points[3:]
    np.testing.assert_allclose(np.sort(right[right[:, 1] == 0.0, 0]), np.arange(1, 12) * 8 / 12)
    for degrees, clear_m in ((30, 0.62 / np.sin(np.radians(30))), (0, 4.62)):
        inner = Roadmap.of_lanes(at_corner(degrees), RADIUS).points[3:]
        first_m = inner[inner[:, 1] == 0.0, 0].min()
        assert clear_m <= first_m < clear_m + 0.15


def test_lanes_between_the_same_nodes_take_no_stops_of_each_other():
    graph = lanes({"start": "a", "end": "b"}, {"start": "b", "end": "a"})
    assert len(Roadmap.of_lanes(graph, RADIUS).edges) == 16


def test_lanes_have_their_speed_and_the_room_to_spare():
    given = (
        {"start": "a", "end": "b", "capacity": 1, "speed_mps": 0.5, "width_m": 1.0},
        {"start": "b", "end": "c", "capacity": 1},
    )
    roadmap = Roadmap.of_lanes(lanes(*given), RADIUS)
    assert roadmap.edges.tolist() == [[0, 1], [1, 2]]
    assert roadmap.speed_mps.tolist() == [0.5, np.inf]
    np.testing.assert_allclose(roadmap.clearance_m, [0.2, np.inf])


def test_lanes_that_are_too_narrow_or_lead_through_a_wall_are_left_out():
    graph = lanes(
        {"start": "a", "end": "b", "width_m": 0.5},
        {"start": "b", "end": "c", "capacity": 1},
        {"start": "c", "end": "a"},
    )
    space = PolygonSpace(shapely.box(-1, -1, 6, 4).difference(shapely.box(1, 1, 2, 2)))
    roadmap = Roadmap.of_lanes(graph, RADIUS, space=space)
    assert roadmap.edges.tolist() == [[1, 2]]
    found = closed_lanes(graph, RADIUS, PathFinder(space))
    assert [(one.number, one.reason) for one in found] == [
        (0, "0.5 m wide, diameter 0.6 m"),
        (2, "too near to an obstacle for radius 0.3 m"),
    ]


def test_a_place_is_joined_to_the_nearest_point_of_a_lane_to_which_the_way_is_free():
    """Where the nearest point of all is hidden, whole metres from it are tried."""
    space = PolygonSpace(shapely.box(-1, -3, 6, 4).difference(shapely.box(-1, -1.2, 1.4, -1)))
    roadmap = Roadmap.of_lanes(
        lanes({"start": "a", "end": "b", "both_ways": True}), RADIUS, [(0.4, -2), (5, 0), (1.3, 0.2)], space=space
    )
    behind, node, beside = (int(p) for p in roadmap.places)
    assert node == 1
    for place, joint in ((behind, (3.4, 0)), (beside, (1.3, 0))):
        (near,) = {int(v) for u, v in roadmap.edges if u == place}
        np.testing.assert_allclose(roadmap.points[near], joint)
        assert [near, place] in roadmap.edges.tolist()


def test_what_a_graph_of_lanes_may_not_be():
    for edges, value in (
        ([{"start": "a", "end": "d"}], '"d"'),
        ([{"start": "a", "end": "b"}, {"start": "a", "end": "b"}], "a lane from a to b"),
        ([{"start": "a", "end": "b", "id": "x"}, {"start": "b", "end": "c", "id": "x"}], '"x"'),
    ):
        with pytest.raises(MissionError) as error:
            lanes(*edges)
        assert error.value.findings[0].value == value


def test_lanes_of_any_length_have_points_that_can_be_counted():
    far = Lanes(nodes={"a": (0, 0), "b": (1e16, 0)}, edges=(Lane(start="a", end="b", both_ways=True),))
    roadmap = Roadmap.of_lanes(far, RADIUS)
    assert len(roadmap.points) < 50_000
    np.testing.assert_allclose(roadmap.lengths_m, 1e16 / (len(roadmap.edges) / 2))


def ways(roadmap):
    return {(tuple(roadmap.points[u]), tuple(roadmap.points[v])) for u, v in roadmap.edges.tolist()}


def test_places_on_a_lane_are_points_of_it():
    """Nobody goes to a stop beside its place first, and no more robots stop there than on a lane without places."""
    graph = lanes({"start": "a", "end": "b", "capacity": 3, "speed_mps": 0.5})
    roadmap = Roadmap.of_lanes(graph, RADIUS, [(4.0, 0.0), (2.0, 0.0)])
    a, far, near, b = (0.0, 0.0), (4.0, 0.0), (2.0, 0.0), (5.0, 0.0)
    assert ways(roadmap) == {(a, near), (near, far), (far, b)}
    assert [tuple(roadmap.points[k]) for k in roadmap.places] == [far, near]
    assert set(roadmap.speed_mps.tolist()) == {0.5}


@pytest.mark.parametrize(("capacity", "both_ways"), [(1, False), (2, False), (2, True), (4, False)])
def test_places_on_a_lane_are_shared_by_as_many_robots_as_may_be_on_it(capacity, both_ways):
    """An edge that leads into a section of the lane is kept by who is anywhere in it, and one that leads on is not."""
    places = [(1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (4.0, 0.0)]
    edge = {"start": "a", "end": "b", "capacity": capacity, "both_ways": both_ways}
    roadmap = Roadmap.of_lanes(lanes(edge), RADIUS, places)
    held = {
        (roadmap.points[u][0], roadmap.points[v][0]): sorted(roadmap.points[roadmap.reached(k), 0].tolist())
        for k, (u, v) in enumerate(roadmap.edges.tolist())
    }
    each = 4 // capacity
    for x in (0.0, 1.0, 2.0, 3.0):
        into = x % each == 0.0
        assert held[x, x + 1.0] == ([x + 1.0 + k for k in range(each)] if into else [x + 1.0])
    if both_ways:
        assert held[5.0, 4.0] == [3.0, 4.0]
        assert held[3.0, 2.0] == [1.0, 2.0]


def test_a_place_on_a_lane_each_way_is_one_point_of_both():
    graph = lanes({"start": "a", "end": "b", "capacity": 1}, {"start": "b", "end": "a", "capacity": 1})
    roadmap = Roadmap.of_lanes(graph, RADIUS, [(2.0, 0.0)])
    a, at, b = (0.0, 0.0), (2.0, 0.0), (5.0, 0.0)
    assert ways(roadmap) == {(a, at), (at, b), (b, at), (at, a)}


def test_who_stands_on_a_lane_keeps_its_speed():
    graph = lanes(
        {"start": "a", "end": "b", "capacity": 1, "speed_mps": 0.5, "both_ways": True},
        {"start": "b", "end": "c", "capacity": 1, "both_ways": True},
    )
    roadmap = placed(graph, (2.0, 0.03), (2.0, 0.5))
    speeds = {
        (tuple(roadmap.points[u]), tuple(roadmap.points[v])): speed
        for (u, v), speed in zip(roadmap.edges.tolist(), roadmap.speed_mps.tolist(), strict=True)
    }
    assert speeds[(2.0, 0.03), (5.0, 0.0)] == speeds[(0.0, 0.0), (2.0, 0.03)] == 0.5
    assert speeds[(2.0, 0.5), (5.0, 0.0)] == speeds[(2.0, 0.5), (5.0, 3.0)] == np.inf


def test_who_stands_on_a_lane_drives_on_along_it():
    """It is joined to no other lane across ground that has none, and one-way not to what is behind it."""
    graph = lanes({"start": "a", "end": "b", "capacity": 1}, {"start": "b", "end": "c", "capacity": 1})
    roadmap = placed(graph, (2.0, 0.03), (3.0, 0.0), (4.9, 0.0))
    a, first, second, b, c = (0.0, 0.0), (2.0, 0.03), (3.0, 0.0), (5.0, 0.0), (5.0, 3.0)
    on_lanes = {way for way in ways(roadmap) if (4.9, 0.0) not in way}
    assert on_lanes == {(a, b), (b, c), (a, first), (first, b), (a, second), (second, b), (first, second)}
    assert (b, (4.9, 0.0)) in ways(roadmap)  # as good as at the node: it may get back there
