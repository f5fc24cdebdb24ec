"""What no dialect knows, and numbers that are none: they end in words, not in errors."""

import math

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission
from tests.muster_robots.mavlink.talk import (
    HOLD,
    M,
    Talk,
    ack,
    commands,
    from_drone,
    heartbeat,
    mission_ack,
    position,
    request,
)

from muster.motion.port import Waypoint
from muster_robots.mavlink.autopilots import PX4
from muster_robots.mavlink.drone import final_state_of
from muster_robots.mavlink.faults import Kind


def test_a_breach_of_an_unknown_kind():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    assert commands(talk.say(from_drone(M.MAVLink_fence_status_message(1, 1, 9, 0)))) == [(HOLD, 1.0)]
    assert [(fault.kind, fault.detail) for fault in talk.session.faults] == [(Kind.FENCE_BREACHED, "9")]


def test_results_that_are_unknown():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    talk.say(ack(M.MAV_CMD_COMPONENT_ARM_DISARM, 77))
    assert talk.session.fault.kind is Kind.ARM_REFUSED
    assert talk.session.fault.detail == "MAV_CMD_COMPONENT_ARM_DISARM: 77"
    talk = Talk()
    for seq in range(talk.fly((10.0, 0.0, 8.0))[0].count):
        talk.say(request(seq))
    talk.say(mission_ack(200))
    assert talk.session.faults[0].kind is Kind.ITEM_REJECTED
    assert talk.session.telemetry().refused.endswith(": 200")


def test_numbers_that_are_none_are_no_place_and_no_heading():
    talk = Talk(offboard=True)
    talk.session.drone.telemetry.earth = None
    good = from_drone(M.MAVLink_local_position_ned_message(0, 1.0, 2.0, -3.0, 0, 0, 0))
    bad = from_drone(M.MAVLink_local_position_ned_message(0, math.nan, 2.0, -3.0, 0, 0, 0))
    talk.say(good, from_drone(M.MAVLink_attitude_message(0, 0, 0, 0.5, 0, 0, 0)))
    before = talk.session.telemetry()
    talk.now += 1.0
    talk.say(bad, from_drone(M.MAVLink_attitude_message(0, 0, 0, math.nan, 0, 0, 0)))
    assert talk.session.telemetry() == before


@pytest.mark.parametrize("verb", ["hear", "tick", "hold"])
def test_an_error_over_one_drone_ends_its_part_alone_and_all_hover(verb):
    there = mission(2)
    sky = Sky(there)
    fleet = sky.fleet(there)
    for port in fleet.ports.values():
        port.send([Waypoint((300.0, 6.0, 10.0))])
    fleet.advance(fleet.time_s + 8.0)

    def fails(*anything):
        raise KeyError(9)

    one = fleet.sessions["r_0"]
    where = {
        "hear": (one.drone.telemetry, "hear"),
        "tick": (one._fault_detector, "check_clock"),
        "hold": (one, "_take_order"),
    }
    setattr(*where[verb], fails)
    if verb != "hold":
        assert [event.robot_fails for event in fleet.advance(fleet.time_s + 2.0)] == ["r_0"]
        assert sky.drones["r_1"].mode == PX4.mission
    fleet.stop()
    fleet.close()
    sky.close()
    assert [(found.robot, found.kind, found.detail) for found in fleet.faults] == [
        ("r_0", Kind.NOT_UNDERSTOOD, "KeyError: 9")
    ]
    assert [drone.mode for drone in sky.drones.values()] == [PX4.hold, PX4.hold]


def test_a_drone_that_has_not_said_where_it_is_is_not_said_to_be_on_the_ground():
    talk = Talk()
    drone = talk.session.drone
    drone.telemetry.place = None
    talk.say(heartbeat(armed=True))
    told = final_state_of(drone, talk.now)
    assert (told.state, told.position, told.moving) == ("armed, its height not known", None, True)
    talk.say(position(above=0.0))
    assert final_state_of(drone, talk.now).state == "on the ground, armed"
    talk.say(position(above=10.0))
    assert final_state_of(drone, talk.now).moving
