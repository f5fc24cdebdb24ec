"""A roadmap to which places were added is the same as one of which everything is computed anew."""

import random
from dataclasses import replace

import numpy as np
import pytest
from tests.traffic.test_robot_sizes import RADII, clumps, joined

from muster.mission.lanes import Lane, Lanes
from muster.motion.free_space import GridSpace
from muster.motion.maps.distances import inflated
from muster.traffic.journeys.roadmap_network import Standing, with_places
from muster.traffic.roadmaps.edge_conflicts import conflicts
from muster.traffic.roadmaps.roadmap import Roadmap
from muster.traffic.roadmaps.robot_spaces import RobotSpaces


def some_places(roadmap, chance, number):
    """Return places near points, on edges, and at points of the roadmap, each for the robots of its layer."""
    for _ in range(number):
        k = chance.randrange(len(roadmap.edges))
        (start, end), layer = roadmap.points[roadmap.edges[k]], int(roadmap.edge_layer[k])
        beside = [chance.choice((0.0, 0.0, chance.uniform(-0.4, 0.4))) for _ in range(2)]
        share = chance.choice((0.0, 0.5, chance.random()))
        yield Standing(tuple((start + share * (end - start) + beside).tolist()), layer)


def assert_as_anew(grown):
    start, point, metres = conflicts(grown.points, grown.edges, grown.reaches_m, grown.sections, grown.layer)
    assert (start == grown.reach_start).all()
    assert (point == grown.reach_point).all()
    assert metres == pytest.approx(grown.reach_m, abs=1e-12)
    anew = replace(grown, base=None)
    assert (anew.passed == grown.passed).all()
    assert (anew.holding == grown.holding).all()


@pytest.mark.parametrize("seed", range(4))
def test_of_free_space_for_robots_of_some_sizes(seed):
    chance = random.Random(seed)
    grid = clumps(seed)
    roadmap = joined({radius: GridSpace(inflated(grid, radius)) for radius in RADII}, [])
    for number in (1, 5, 30):
        grown = with_places(roadmap, RobotSpaces(), some_places(roadmap, chance, number))
        assert grown.base is roadmap
        assert_as_anew(grown)


@pytest.mark.parametrize("seed", range(4))
def test_of_lanes_some_of_which_are_closed(seed):
    chance = random.Random(seed)
    nodes = {f"{x} {y}": (4.0 * x, 4.0 * y) for x in range(4) for y in range(3)}
    edges = [(a, b) for a in nodes for b in nodes if a != b and np.hypot(*np.subtract(nodes[a], nodes[b])) < 4.1]
    lanes = [Lane(start=a, end=b, capacity=chance.choice((None, 1))) for a, b in edges if chance.random() < 0.8]
    roadmap = Roadmap.of_lanes(Lanes(nodes=nodes, edges=tuple(lanes)), 0.3)
    grown = with_places(roadmap, RobotSpaces(), some_places(roadmap, chance, 12))
    assert_as_anew(grown)
    is_open = np.hypot(*(grown.points[grown.edges].mean(axis=1) - (4.0, 4.0)).T) > 2.0
    base_open = np.hypot(*(roadmap.points[roadmap.edges].mean(axis=1) - (4.0, 4.0)).T) > 2.0
    kept = grown.keeping(is_open, roadmap.keeping(base_open))
    anew = grown.keeping(is_open)
    assert kept.base is not None
    assert (kept.passed == anew.passed).all()
    assert (kept.holding == anew.holding).all()
