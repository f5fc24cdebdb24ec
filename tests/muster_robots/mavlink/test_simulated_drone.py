"""The simulated autopilot is a witness of its own: it does not take places from the frames of the bridge."""

import math

import pytest
from tests.muster_robots.mavlink.drones import ORIGIN, Sky, mission

from muster.mission.errors import ParameterError
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.dialect import Codec, mavlink
from muster_robots.mavlink.frames import GlobalFrame
from muster_robots.mavlink.simulated.drone import SimulatedAutopilot
from muster_robots.mavlink.simulated.earth import degrees_of, ned_of, origin_at

# Radii of curvature of WGS84 at a latitude, metres: along a meridian, and of a parallel.
A, E2 = 6378137.0, 0.00669437999014
LAT = math.radians(ORIGIN.lat_deg)
W = math.sqrt(1 - E2 * math.sin(LAT) ** 2)
MERIDIAN, PARALLEL = A * (1 - E2) / W**3 + ORIGIN.alt_m, (A / W + ORIGIN.alt_m) * math.cos(LAT)


def test_places_on_earth_are_as_the_ellipsoid_has_them():
    lat = ORIGIN.lat_deg + math.degrees(200.0 / MERIDIAN)
    lon = ORIGIN.lon_deg + math.degrees(-100.0 / PARALLEL)
    assert ned_of(ORIGIN, lat, lon, 30.0) == pytest.approx((200.0, -100.0, -30.0), abs=0.02)
    assert degrees_of(ORIGIN, (200.0, -100.0, -30.0)) == pytest.approx((lat, lon), abs=2e-7)
    there = origin_at(ORIGIN, (-100.0, 200.0, 30.0))
    assert (there.lat_deg, there.lon_deg) == pytest.approx((lat, lon), abs=2e-7)
    assert there.alt_m == pytest.approx(130.0, abs=0.01)  # the map is flat, Earth is not


@pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
def test_a_bridge_that_swaps_latitude_and_longitude_flies_nowhere(kind, monkeypatch):
    to_drone, to_map = GlobalFrame.to_drone, GlobalFrame.to_map

    def swapped(frame, place):
        lat, lon, above = to_drone(frame, place)
        return lon, lat, above

    monkeypatch.setattr(GlobalFrame, "to_drone", swapped)
    assert flew_to(kind) != pytest.approx((0.0, 20.0, -10.0), abs=5.0)
    monkeypatch.setattr(GlobalFrame, "to_map", lambda frame, lat, lon, above: to_map(frame, lon, lat, above))
    there = mission(1)
    sky = Sky(there, kind)
    with pytest.raises(ParameterError, match="from its start in the mission"):
        sky.fleet(there)
    sky.close()


@pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
def test_a_bridge_that_does_not_flies_there(kind):
    assert flew_to(kind) == pytest.approx((0.0, 20.0, -10.0), abs=0.05)


def flew_to(kind):
    """Where a drone flies that is told by way of the bridge's items to be 20 m east and 10 m up."""
    drone, codec, ours = SimulatedAutopilot(kind, ORIGIN), Codec(), Codec()
    lat, lon, above = GlobalFrame(ORIGIN, (0.0, 0.0, 0.0)).to_drone((20.0, 0.0, 10.0))
    place = 6, mavlink.MAV_CMD_NAV_WAYPOINT, 0, 1, 0, 1, 0, math.nan, lat, lon, above
    count = 2 if kind.home_first else 1
    drone.receive(ours.pack(codec.make.mission_count_encode(1, 1, count)))
    for seq in range(count):
        drone.receive(ours.pack(codec.make.mission_item_int_encode(1, 1, seq, *place)))
    drone.armed, drone.mode = True, kind.mission
    for k in range(2000):
        drone.advance(0.02 * k)
    return drone.flight.place


@pytest.mark.parametrize(("frame", "mask"), [(mavlink.MAV_FRAME_BODY_NED, 3576), (mavlink.MAV_FRAME_LOCAL_NED, 3583)])
def test_set_points_of_another_frame_or_of_no_place_are_none(frame, mask):
    drone, codec = SimulatedAutopilot(ARDUPILOT, ORIGIN), Codec()
    drone.armed, drone.mode, drone.flight.place = True, ARDUPILOT.guided, (0.0, 0.0, -5.0)
    told = codec.make.set_position_target_local_ned_encode(0, 1, 1, frame, mask, 9, 9, -5, 0, 0, 0, 0, 0, 0, 0, 0)
    drone.receive(codec.pack(told))
    for k in range(100):
        drone.advance(0.02 * k)
    assert drone.flight.place == (0.0, 0.0, -5.0)
