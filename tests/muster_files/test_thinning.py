"""Fewer way points around corners: how far they may lie off, what stays, and that no wall is cut."""

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples

import muster
from muster.execution.reports.itinerary import Itinerary, Passage, itineraries
from muster.mission.model import Robot
from muster.motion.map_world import body_of
from muster.motion.paths.robot_paths import RobotPaths
from muster.verification import verify
from muster_files.thinning import thinned

ARC = [(math.cos(a), math.sin(a), 3.0) for a in np.radians(np.arange(0, 91, 10))]
"""A quarter of a circle about the origin, by ten places."""


def itinerary(places, **told):
    passages = [Passage(place, float(k), float(k)) for k, place in enumerate(places)]
    passages[-1] = Passage(places[-1], len(places) - 1.0, len(places) + 4.0, "goal")
    for k, change in told.items():
        passages[int(k[1:])] = change
    return Itinerary(Robot(id="r", position=places[0]), tuple(passages), has_end=False)


def places(itinerary):
    return [passage.place for passage in itinerary.passages]


def free(_):
    return True


AROUND = [(1, -2, 3), *ARC, (-2, 1, 3)]


def test_a_quarter_of_a_circle_becomes_the_corner_around_it():
    corner = thinned(itinerary(AROUND), 0.5, free)
    assert len(corner.passages) == 3
    assert corner.passages[1].place == pytest.approx((1, 1, 3), abs=1e-5)
    assert corner.passages[1].arrives_s == pytest.approx(5.5)
    assert (corner.passages[0], corner.passages[-1]) == (itinerary(AROUND).passages[0], itinerary(AROUND).passages[-1])


def test_a_smaller_tolerance_keeps_more():
    counts = [len(thinned(itinerary(AROUND), metres, free).passages) for metres in (0.5, 0.1, 0.02, 1e-9)]
    assert counts == sorted(counts)
    assert counts[0] == 3 < counts[1] < counts[2] < counts[3] == 12


def test_a_wall_outside_keeps_the_bends():
    corner = shapely.box(0.95, 0.95, 2, 2)
    clear = lambda line: not shapely.intersects(shapely.LineString(line), corner)  # noqa: E731
    bends = thinned(itinerary(AROUND), 0.5, clear)
    assert 3 < len(bends.passages) < 12
    assert clear(places(bends))


@pytest.mark.parametrize(
    "busy", [Passage(ARC[4], 5, 7), Passage(ARC[4], 5, 5, heading=1.0), Passage(ARC[4], 5, 5, task="look")]
)
def test_where_something_is_done_stays(busy):
    assert busy in thinned(itinerary(AROUND, _5=busy), 0.5, free).passages


steps = st.tuples(st.floats(0.01, 1), st.floats(-1.2, 1.2), st.floats(-0.2, 0.2))


@examples(60)
@given(st.lists(steps, min_size=3, max_size=12), st.floats(0.01, 0.5))
def test_no_bend_is_farther_off_than_said(walk, tolerance_m):
    heading, line = 0.0, [(0.0, 0.0, 5.0)]
    for length, turn, climb in walk:
        heading += turn
        x, y, z = line[-1]
        line.append((x + length * math.cos(heading), y + length * math.sin(heading), z + climb))
    found = thinned(itinerary(line), tolerance_m, free)
    new = places(found)
    assert (new[0], new[-1]) == (line[0], line[-1])
    assert len(new) <= len(line)
    assert max(away(point, line) for point in new) <= tolerance_m + 1e-9
    assert max(away(point, new) for point in line) <= 2 * tolerance_m  # from both corners beside it
    times = [passage.arrives_s for passage in found.passages]
    assert times == sorted(times)


def away(point, line):
    """Metres from a point to a line, by a fine division of its pieces."""
    shares = np.linspace(0, 1, 2001)[:, None]
    return min(
        np.linalg.norm(np.array(a) + shares * (np.array(b) - np.array(a)) - np.array(point), axis=1).min() - 5e-4
        for a, b in pairwise(line)
    )


@pytest.mark.long
@pytest.mark.parametrize("name", ["floor", "yard"])
def test_robots_stay_clear_of_walls(name):
    mission = muster.load(name)
    robot_paths = RobotPaths.of(mission)
    team = itineraries(mission, verify(mission, muster.solve(mission, "greedy")), robot_paths)
    fewer = 0
    for whole in team:
        body = body_of(whole.robot)
        found = thinned(whole, 0.1, lambda line, body=body: robot_paths.clear(body, line))
        fewer += len(whole.passages) - len(found.passages)
        places_of = places(found)
        ways = [way for way in pairwise(places_of) if way not in set(pairwise(places(whole)))]
        for a, b in ways:
            along = np.linspace(a, b, 50)[:, : mission.dimensions]
            assert robot_paths.world.clearance(along, body.kind, body.radius_m).min() >= body.radius_m - 1e-4
        tasks = [passage for passage in whole.passages if passage.stays_s or passage.heading is not None]
        assert [passage for passage in found.passages if passage in tasks] == tasks
    assert fewer > 10
