"""Lanes with the places that are joined to them, beside what a plain reading of the mission's lanes gives."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.lanes import Lane, Lanes
from muster.motion.paths.lane_joints import ON_LANE_M, Joints, joined

NODES = {f"n{x}{y}": (float(x), float(y)) for x in range(4) for y in range(3)}
PAIRS = [(a, b) for a, p in NODES.items() for b, q in NODES.items() if abs(p[0] - q[0]) + abs(p[1] - q[1]) == 1]

edges = st.lists(st.tuples(st.sampled_from(PAIRS), st.booleans()), min_size=1, max_size=12, unique_by=lambda e: e[0])
tenths = st.integers(-5, 35).map(lambda k: k / 10)
points = st.lists(st.tuples(tenths, tenths), max_size=6, unique=True)


@given(edges, points, st.data())
def test_pieces_are_those_between_the_places_on_each_lane_in_order(edges, points, data):
    there = {pair for pair, _ in edges}
    edges = [((a, b), both and (b, a) not in there) for (a, b), both in edges]
    lanes = Lanes(nodes=NODES, edges=tuple(Lane(start=a, end=b, both_ways=both) for (a, b), both in edges))
    driven = data.draw(st.sets(st.integers(0, len(edges) - 1), min_size=1))
    joints = Joints.of(lanes, driven, None)
    places = np.array(points, dtype=np.float64).reshape(-1, 2)
    found = joined(joints, places)

    assert found.points[: len(NODES)].tolist() == [list(place) for place in NODES.values()]
    names, expected = list(NODES), []
    inner = [joints.joint(place) for place in places]
    for number in sorted(driven):
        (a, b), both = edges[number]
        at_m = sorted({round(m, 6) for joint in inner for lane, m in joint.on if lane == number})
        begin, end = (np.array(NODES[name]) for name in (a, b))
        stops = [names.index(a), *(point_at(found.points, begin + m * (end - begin)) for m in at_m), names.index(b)]
        pieces = [*pairwise(stops), *(pairwise(stops[::-1]) if both else ())]
        expected += [(*piece, number) for piece in pieces]
    ways = np.column_stack([found.arcs, found.lanes])
    assert list(map(tuple, ways[found.lanes >= 0].tolist())) == expected
    for place, joint, number in zip(places, inner, found.places.tolist(), strict=True):
        assert found.points[number] == pytest.approx(place, abs=ON_LANE_M)
        stubs = [(a, b) for a, b, lane in ways.tolist() if lane < 0 and number in (a, b)]
        if joint.away_m > ON_LANE_M:
            (there, back) = stubs
            assert there == back[::-1]
            assert found.points[there[1]] == pytest.approx(joint.at)


def point_at(points, at):
    return next(k for k, point in enumerate(points) if np.linalg.norm(point - at) < 1e-5)


def test_places_are_joined_once():
    lanes = Lanes(nodes=NODES, edges=(Lane(start="n00", end="n10"),))
    seen = []

    def sees(points):
        seen.append(points.tolist())
        return True

    joints = Joints.of(lanes, [0], sees)
    first = joints.joint(np.array([0.5, 1.0]))
    asked = len(seen)
    assert joints.joint(np.array([0.5, 1.0])) is first
    assert len(seen) == asked > 0
    assert joints.joint(np.array([0.6, 1.0])) is not first
