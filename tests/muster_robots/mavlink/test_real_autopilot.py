"""A real autopilot, or its makers' simulation, where MUSTER_MAVLINK_ENDPOINT names one. It is never armed."""

import math
import os

import pytest
from tests.muster_robots.mavlink.drones import ORIGIN, mission

from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink import MavlinkFleet

VARIABLE = "MUSTER_MAVLINK_ENDPOINT"
pytestmark = [
    pytest.mark.hardware,
    pytest.mark.skipif(VARIABLE not in os.environ, reason=f"{VARIABLE} names no autopilot"),
]


@pytest.fixture
def fleet():
    there = mission(1, origin_wgs84=ORIGIN)
    made = MavlinkFleet(there, {"r_0": os.environ[VARIABLE]}, FlightSettings(arm=False, far_m=1e9))
    made.connect(20.0)
    yield made
    made.close()


def test_it_says_who_and_where_it_is(fleet):
    drone = fleet.sessions["r_0"].drone
    assert drone.kind.name in ("PX4", "ArduPilot")
    first = fleet.ports["r_0"].telemetry()
    fleet.advance(fleet.time_s + 3.0)
    last = fleet.ports["r_0"].telemetry()
    assert last.time_s > first.time_s
    assert all(math.isfinite(c) for c in (*last.position, *last.velocity, last.heading))
    assert last.charge is None or 0 <= last.charge <= 1


def test_without_leave_its_mode_and_its_arming_stay_as_they_are(fleet):
    telemetry = fleet.sessions["r_0"].drone.telemetry
    before = telemetry.mode, telemetry.armed
    fleet.stop()
    fleet.end("return")
    fleet.end("land")
    assert (telemetry.mode, telemetry.armed) == before
