"""A session, message by message: what it says, when, and what it makes of what it hears."""

import math

import pytest
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

from muster.mission.errors import ParameterError
from muster.motion.port import Waypoint
from muster_robots.custody import Standing
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4, autopilot_of
from muster_robots.mavlink.faults import Kind


def test_the_upload_message_by_message():
    talk = Talk()
    (count,) = talk.fly((10.0, 0.0, 8.0), (10.0, 20.0, 8.0), hold_s=3.0)
    assert (count.get_type(), count.count, count.target_system, count.target_component) == ("MISSION_COUNT", 4, 7, 1)
    items = [talk.say(request(seq))[0] for seq in range(4)]
    assert [item.seq for item in items] == [0, 1, 2, 3]
    assert [item.command for item in items] == [22, 178, 16, 16]  # take off, speed, two way points
    assert [item.frame for item in items] == [6, 2, 6, 6]  # GLOBAL_RELATIVE_ALT_INT
    assert (items[0].x, items[0].y) == (470000000, 80000000)
    assert items[0].z == pytest.approx(8.0, abs=1e-6)
    assert items[1].param2 == 4.0
    assert items[3].param1 == 3.0
    assert items[3].x > items[2].x == pytest.approx(470000000, abs=2)  # latitude is x: 20 m to the north
    assert items[3].y == pytest.approx(items[2].y, abs=6)
    assert (items[2].y - 80000000) * 1e-7 * 76_057 == pytest.approx(10.0, abs=0.05)  # metres a degree at 47 north
    (arm,) = talk.say(mission_ack())
    assert (arm.command, arm.param1, arm.param2) == (400, 1.0, 0.0)  # never by force
    (current,) = talk.say(heartbeat(armed=True))
    assert (current.get_type(), current.seq) == ("MISSION_SET_CURRENT", 0)
    (start,) = talk.say(from_drone(M.MAVLink_mission_current_message(0)))
    assert start.command == M.MAV_CMD_MISSION_START


def test_ardupilot_has_home_first_and_is_armed_in_guided():
    talk = Talk(ARDUPILOT)
    (count,) = talk.fly((10.0, 0.0, 8.0))
    items = [talk.say(request(seq))[0] for seq in range(count.count)]
    assert [item.command for item in items] == [16, 22, 178, 16]
    talk.say(mission_ack())
    (current,) = talk.say(heartbeat(ARDUPILOT, armed=True))
    assert current.seq == 1


def test_what_is_not_answered_is_said_again_and_again_then_given_up():
    talk = Talk()
    said = [*talk.fly((10.0, 0.0, 8.0))]
    for _ in range(30):
        said += [*talk.say(position()), *talk.after(0.5)]
    assert [message.get_type() for message in said] == ["MISSION_COUNT"] * 8
    assert talk.session.fault.kind is Kind.NO_ANSWER


def test_an_item_that_is_asked_for_twice_is_said_twice():
    talk = Talk()
    talk.fly((10.0, 0.0, 8.0))
    first, again = talk.say(request(0), request(0))
    assert first.seq == again.seq == 0


def test_a_late_acknowledgement_of_the_mission_before_ends_no_upload():
    talk = Talk()
    talk.fly((10.0, 0.0, 8.0))
    assert talk.say(mission_ack()) == []
    assert talk.say(request(0))[0].get_type() == "MISSION_ITEM_INT"


def test_a_drone_that_no_heartbeat_has_shown_flying_is_held_before_another_mission():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    current = talk.say(heartbeat(armed=True))[0].seq
    talk.say(from_drone(M.MAVLink_mission_current_message(current)))
    talk.say(from_drone(M.MAVLink_mission_item_reached_message(current)), position(above=8.0))
    assert commands(talk.fly((20.0, 0.0, 8.0))) == [(HOLD, 1.0)]


def test_items_reached_count_once_and_lost_ones_are_made_up_for():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0), (10.0, 20.0, 8.0), (0.0, 20.0, 8.0))
    reached = from_drone(M.MAVLink_mission_item_reached_message(2))
    passed = []
    for message in (reached, reached, reached, from_drone(M.MAVLink_mission_current_message(4, 5, 3)), reached):
        talk.say(message)
        passed.append(talk.session.telemetry().passed)
    assert passed == [1, 1, 1, 2, 2]
    talk.say(from_drone(M.MAVLink_mission_current_message(4, 5, M.MISSION_STATE_COMPLETE)))
    assert talk.session.telemetry().passed == 3


def test_hold_return_and_land_are_modes():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    for at_end, sub in (("hold", 3), ("return", 5)):
        talk.session.end(at_end, talk.now)
        (said,) = talk.taken()
        assert (said.command, said.param1, said.param2, said.param3) == (176, 1.0, 4.0, float(sub))
    talk = Talk(ARDUPILOT)
    talk.flying((10.0, 0.0, 8.0))
    talk.session.end("land", talk.now)
    assert (talk.taken()[0].param2) == 9.0


@pytest.mark.parametrize("kind", [PX4, ARDUPILOT])
def test_way_points_one_by_one(kind):
    talk = Talk(kind, offboard=True)
    talk.say(from_drone(M.MAVLink_local_position_ned_message(0, 1.0, 2.0, 0.0, 0, 0, 0)), position())
    talk.session.follow([Waypoint((10.0, 20.0, 8.0), heading=math.pi / 2)], 0.0)
    said = talk.taken()
    if kind is PX4:  # told where before it is told to follow
        said += [message for _ in range(8) for message in talk.after(0.2)]
        commands = [k for k, message in enumerate(said) if message.get_type() == "COMMAND_LONG"]
        assert commands[0] >= 5  # a second long
        assert {said[k].command for k in commands} == {M.MAV_CMD_DO_SET_MODE}
        talk.say(heartbeat(kind, kind.guided))
    talk.say(heartbeat(kind, kind.guided, armed=True))
    if kind is ARDUPILOT:
        talk.say(position(above=8.0))
    targets = [m for _ in range(20) for m in talk.after(0.05) if m.get_type() == "SET_POSITION_TARGET_LOCAL_NED"]
    assert 4 <= len(targets) <= 6  # in a second: PX4 wants more than 2
    target = targets[-1]
    assert target.coordinate_frame == M.MAV_FRAME_LOCAL_NED
    assert target.type_mask == 2552
    assert (target.x, target.y, target.z) == pytest.approx((21.0, 12.0, -8.0), abs=0.02)
    assert target.yaw == pytest.approx(0.0)  # north


@pytest.mark.parametrize(("field", "value"), [("autopilot", M.MAV_AUTOPILOT_GENERIC), ("type", M.MAV_TYPE_FIXED_WING)])
def test_what_muster_does_not_fly_is_refused(field, value):
    with pytest.raises(ParameterError, match=r"r_0: (autopilot|vehicle) MAV_.*expected"):
        autopilot_of(heartbeat(**{field: value}), "r_0")


def test_refused_for_the_moment_is_asked_again_then_a_fault():
    talk = Talk()
    (count,) = talk.fly((10.0, 0.0, 8.0))
    for seq in range(count.count):
        talk.say(request(seq))
    talk.say(mission_ack())
    arms = 1
    for _ in range(3):
        talk.say(ack(400, M.MAV_RESULT_TEMPORARILY_REJECTED), heartbeat())
        arms += len(talk.after(1.1))
    assert arms == 3
    assert talk.session.fault.kind is Kind.ARM_REFUSED


def test_who_says_nothing_is_silent_and_is_told_nothing():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    assert [talk.after(1.0) for _ in range(12)] == [[]] * 12
    assert talk.session.custody.standing is Standing.SILENT
    assert talk.session.fault is None


def test_in_a_mode_that_muster_did_not_choose_it_lets_go():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    assert talk.beats(mode=3 << 16, armed=True) == []
    assert talk.session.custody.standing is Standing.PILOT
    assert talk.session.telemetry().suspended == "pilot: mode POSCTL"
    talk.session.hold(talk.now)
    assert talk.fly((1.0, 1.0, 5.0)) == []


def test_low_battery_on_the_ground_arms_nothing():
    talk = Talk()
    talk.say(from_drone(M.MAVLink_sys_status_message(0, 0, 0, 0, 11000, -1, 12, 0, 0, 0, 0, 0, 0)))
    assert talk.fly((10.0, 0.0, 8.0)) == []
    assert talk.session.fault.kind is Kind.LOW_BATTERY


def battery(number, percent):
    return from_drone(M.MAVLink_battery_status_message(number, 0, 0, 0, [0] * 10, 0, 0, 0, percent))


def test_the_first_battery_counts_alone():
    talk = Talk()
    talk.say(position(), battery(0, 90), battery(1, 10))
    assert talk.session.telemetry().charge == 0.9
    talk.flying((10.0, 0.0, 8.0))
    for _ in range(3):
        talk.say(battery(0, 10))
        talk.after(1.0)
    assert talk.session.fault.kind is Kind.LOW_BATTERY


def test_without_leave_what_is_not_harmless_is_refused_wherever_it_comes_from():
    talk = Talk(arm=False)
    with pytest.raises(ParameterError, match="r_0: MISSION_CLEAR_ALL; expected nothing of the kind without leave"):
        talk.session._say(M.MAVLink_mission_clear_all_message(7, 1))
    assert talk.taken() == []


def test_without_leave_there_are_no_way_points():
    talk = Talk(arm=False)
    with pytest.raises(ParameterError, match="leave to arm"):
        talk.fly((10.0, 0.0, 8.0))
    assert talk.taken() == []
