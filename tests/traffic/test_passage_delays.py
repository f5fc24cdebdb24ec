"""Delays at passages: learned from forecasts, and told for ways that go through them."""

import pytest
import shapely

from muster.mission.model import Robot
from muster.motion.free_space import PolygonSpace
from muster.motion.maps.polygons import free_region
from muster.traffic.journeys.forecast import Forecast
from muster.traffic.journeys.passage_delays import PassageDelays
from muster.traffic.journeys.roadmap_plan import RoadmapPlan
from muster.traffic.journeys.travellers import Stop, Traveller
from muster.traffic.roadmaps.roadmap import Roadmap

RADIUS = 0.3
WEST, EAST, NORTH_WEST = (2.0, 2.0), (10.0, 2.0), (2.0, 6.0)
PLACES = (WEST, EAST, NORTH_WEST)
WALL = [shapely.box(5.8, low, 6.2, high) for low, high in ((0, 1.6), (2.4, 8))]
"""A wall with a door for one."""


@pytest.fixture(scope="module")
def roadmap():
    return Roadmap.of(PolygonSpace(free_region(shapely.box(0, 0, 12, 8), WALL, RADIUS)), RADIUS, PLACES)


def traveller(name, start, end):
    return Traveller(Robot(id=name, position=start, radius_m=RADIUS), start, (Stop(end),))


def told(roadmap, *travellers):
    roads = RoadmapPlan(roadmap)
    journeys = roads.journeys(travellers, ways=8)
    return Forecast((), tuple(journeys.together), tuple(journeys.alone))


def test_a_door_where_two_meet_costs_ways_through_it_half_of_what_they_lose(roadmap):
    delays = PassageDelays(roadmap, speed_mps=1.0)
    meeting = told(roadmap, traveller("a", WEST, EAST), traveller("b", EAST, WEST))
    lost_s = sum(among.end_s - alone.end_s for among, alone in zip(meeting.together, meeting.alone, strict=True))
    assert lost_s > 0.5
    assert not delays
    delays.learn(meeting)
    assert delays
    west, east, north_west = roadmap.places.tolist()
    between_s = delays.between([west, north_west, -1], [east, north_west])
    assert between_s[:, 0] == pytest.approx([lost_s / 2, lost_s / 2, 0.0], rel=0.2)
    assert between_s[:, 1] == pytest.approx([0.0, 0.0, 0.0])


def test_delays_are_means_of_all_forecasts(roadmap):
    delays = PassageDelays(roadmap, speed_mps=1.0)
    west, east, _ = roadmap.places.tolist()
    delays.learn(told(roadmap, traveller("a", WEST, EAST), traveller("b", EAST, WEST)))
    once_s = delays.between([west], [east])
    delays.learn(told(roadmap, traveller("a", WEST, EAST)))
    assert delays.between([west], [east]) == pytest.approx(once_s / 2)
