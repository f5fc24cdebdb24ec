"""Headings and holds, as each autopilot has them, and drones that turn."""

import math

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission
from tests.muster_robots.mavlink.talk import ORIGIN

from muster.motion.port import Waypoint
from muster_robots.follower import Follower
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.dialect import mavlink
from muster_robots.mavlink.frames import GlobalFrame
from muster_robots.mavlink.mission_items import route_of
from muster_robots.mavlink.position_targets import TURNED_RAD

KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
NORTH, WEST = math.pi / 2, math.pi


def items(kind, *waypoints):
    frame = GlobalFrame(ORIGIN, (0.0, 0.0, 0.0))
    return route_of(waypoints, (0.0, 0.0, 0.0), frame, kind, speed_mps=4.0, accept_m=1.0, take_off=True)


def test_ardupilot_is_turned_by_a_condition_before_the_way_point_and_holds_for_whole_seconds():
    route = items(ARDUPILOT, Waypoint((5.0, 0.0, 8.0), heading=WEST, hold_s=0.4), Waypoint((9.0, 0.0, 8.0), hold_s=2.0))
    assert [item.command for item in route.items] == [16, 22, 178, mavlink.MAV_CMD_CONDITION_YAW, 16, 16]
    assert route.items[3].params == (pytest.approx(270.0), 0.0, 0.0, 0.0)
    assert [item.params[0] for item in route.items[4:]] == [1, 2]
    assert all(math.isnan(item.params[3]) for item in route.items[4:])
    assert [route.passed(seq) for seq in range(6)] == [0, 0, 0, 0, 1, 2]


def test_px4_has_both_in_the_way_point():
    route = items(PX4, Waypoint((5.0, 0.0, 8.0), heading=NORTH, hold_s=0.4))
    assert [item.command for item in route.items] == [22, 178, 16]
    assert route.items[2].params == (0.4, 1.0, 0.0, pytest.approx(0.0))


@KINDS
def test_a_drone_is_told_where_it_may_not_fly_so_fast(kind):
    ways = [Waypoint((5.0, 0.0, 8.0)), Waypoint((9.0, 0.0, 8.0), speed_mps=1.5), Waypoint((12.0, 0.0, 8.0))]
    told = [item for item in items(kind, *ways).items if item.command in (16, 178)][-6:]
    assert [item.params[1] if item.command == 178 else item.command for item in told] == [4.0, 16, 1.5, 16, 4.0, 16]


def test_one_by_one_a_way_point_is_passed_when_the_drone_is_turned():
    follower = Follower(arrival_m=1.0, turned_rad=TURNED_RAD, flat=False)
    follower.take([Waypoint((0.0, 0.0, 10.0), heading=math.pi - 0.05, hold_s=2.0)])
    for heading, now in ((0.0, 0.0), (0.0, 5.0), (0.1 - math.pi, 6.0), (math.pi, 7.9)):
        follower.hear(now, (0.0, 0.0, 10.0), heading)
        assert follower.passed == 0
    follower.hear(8.1, (0.0, 0.0, 10.0), math.pi)
    assert follower.passed == 1


@KINDS
@pytest.mark.parametrize("offboard", [False, True])
def test_drones_look_where_they_are_told(kind, offboard):
    there = mission(1)
    sky = Sky(there, kind)
    fleet = sky.fleet(there, offboard=offboard)
    port, drone = fleet.ports["r_0"], sky.drones["r_0"]
    port.send([Waypoint((20.0, 0.0, 10.0), heading=WEST, hold_s=0.4), Waypoint((20.0, 20.0, 10.0))])
    until = fleet.time_s + 60.0
    while port.telemetry().passed < 1:
        assert fleet.time_s < until
        fleet.advance(fleet.time_s + 0.04)
    north, east, _ = drone.flight.place
    assert math.hypot(north, east - 20.0) < 2.0
    assert math.cos(port.telemetry().heading - WEST) > math.cos(math.radians(12.0))
    fleet.advance(fleet.time_s + 15.0)
    fleet.close()
    sky.close()
    assert fleet.faults == []
    assert drone.flight.place == pytest.approx((20.0, 20.0, -10.0), abs=1.0)
