"""Frames: there and back, the axes, and which is latitude."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.model import Origin
from muster_robots.mavlink.frames import GlobalFrame, LocalFrame, StartFrame

METRES = st.floats(-3000, 3000)
PLACES = st.tuples(METRES, METRES, st.floats(-50, 500))
ORIGINS = st.builds(Origin, lat_deg=st.floats(-80, 80), lon_deg=st.floats(-179, 179), alt_m=st.floats(-100, 3000))


@given(ORIGINS, PLACES, PLACES)
def test_on_earth_and_back_is_within_a_rounding_of_degrees(origin, start, place):
    frame = GlobalFrame(origin, start)
    back = frame.to_map(*frame.to_drone(place))
    assert math.dist(place, back) < 0.012  # 1e-7 degrees are 11 mm


@given(ORIGINS, PLACES)
def test_home_is_at_height_0(origin, start):
    assert GlobalFrame(origin, start).to_drone(start)[2] == pytest.approx(0.0, abs=1e-6)


@given(PLACES, PLACES, PLACES)
def test_the_local_frame_and_back(place, ned, other):
    frame = LocalFrame.matched(place, ned)
    assert frame.to_map(ned) == pytest.approx(place, abs=1e-6)
    assert frame.to_map(frame.to_drone(other)) == pytest.approx(other, abs=1e-6)


@given(PLACES, st.floats(-math.pi, math.pi), PLACES, st.floats(-3.0, 3.0))
def test_without_a_compass_forward_at_power_up_is_north(start, heading, place, aim):
    """By trigonometry alone: ahead is the local north, to the right the local east."""
    frame = StartFrame(start, heading)
    east, north = place[0] - start[0], place[1] - start[1]
    ahead = math.cos(heading) * east + math.sin(heading) * north
    right = math.sin(heading) * east - math.cos(heading) * north
    assert frame.to_drone(place) == pytest.approx((ahead, right, start[2] - place[2]), abs=1e-6)
    assert frame.to_map(frame.to_drone(place)) == pytest.approx(place, abs=1e-6)
    turned_right = frame.heading_to_drone(aim)
    assert math.cos(turned_right) == pytest.approx(math.cos(heading - aim), abs=1e-9)
    assert math.sin(turned_right) == pytest.approx(math.sin(heading - aim), abs=1e-9)
    assert math.cos(frame.heading_to_map(turned_right) - aim) == pytest.approx(1.0, abs=1e-9)
    assert frame.velocity_to_map((1.0, 0.0, 0.0))[:2] == pytest.approx((math.cos(heading), math.sin(heading)), abs=1e-6)


@given(ORIGINS)
def test_north_is_more_latitude_and_x_of_ned(origin):
    frame = GlobalFrame(origin, (0.0, 0.0, 0.0))
    lat, lon, _ = frame.to_drone((0.0, 0.0, 0.0))
    north, east = frame.to_drone((0.0, 100.0, 0.0)), frame.to_drone((100.0, 0.0, 0.0))
    assert (north[0] - lat) * 1e-7 * 111_000 == pytest.approx(100, rel=0.02)
    assert abs(north[1] - lon) < 20
    assert east[1] - lon > 8000
    assert abs(east[0] - lat) < 1000
    assert LocalFrame((0.0, 0.0, 0.0)).to_drone((1.0, 2.0, 3.0)) == (2.0, 1.0, -3.0)
