"""A session, message by message: what it says, when, and what it makes of what it hears."""

import math

import pytest

from muster.bridges.mavlink.autopilots import ARDUPILOT, PX4, autopilot_of
from muster.bridges.mavlink.craft import Craft
from muster.bridges.mavlink.dialect import mavlink
from muster.bridges.mavlink.faults import Kind
from muster.bridges.mavlink.fence import no_fence
from muster.bridges.mavlink.frames import GlobalFrame
from muster.bridges.mavlink.seen import Seen
from muster.bridges.mavlink.session import Session
from muster.bridges.mavlink.settings import Settings
from muster.mission.errors import ParameterError
from muster.mission.model import Origin, Robot
from muster.motion.port import Waypoint

ORIGIN = Origin(lat_deg=47.0, lon_deg=8.0, alt_m=400.0)
M = mavlink


def from_drone(message):
    message._header.srcSystem, message._header.srcComponent = 7, 1
    return message


def heartbeat(kind=PX4, mode=None, armed=False, **more):
    known = M.MAV_AUTOPILOT_PX4 if kind is PX4 else M.MAV_AUTOPILOT_ARDUPILOTMEGA
    base = 1 | (128 if armed else 0)
    fields = {"type": 2, "autopilot": known, "custom_mode": kind.ready if mode is None else mode, **more}
    return from_drone(
        M.MAVLink_heartbeat_message(fields["type"], fields["autopilot"], base, fields["custom_mode"], 4, 3)
    )


def position(above=0.0, lat=470000000, lon=80000000):
    return from_drone(M.MAVLink_global_position_int_message(0, lat, lon, 450000, round(above * 1000), 0, 0, 0, 0))


def ack(command, result):
    return from_drone(M.MAVLink_command_ack_message(command, result))


def request(seq):
    return from_drone(M.MAVLink_mission_request_int_message(255, 190, seq))


def mission_ack(result=0):
    return from_drone(M.MAVLink_mission_ack_message(255, 190, result))


class Talk:
    """A session that is spoken to, at times that only grow."""

    def __init__(self, kind=PX4, **settings):
        robot = Robot(id="r_0", position=(0.0, 0.0, 0.0), kind="air", speed_mps=4.0)
        seen = Seen((0.0, 0.0, 0.0), GlobalFrame(ORIGIN, (0.0, 0.0, 0.0)))
        self.session = Session(Craft(robot, seen, Settings(**{"arm": True, **settings}), None), no_fence)
        self.kind, self.now = kind, 0.0
        self.say(heartbeat(kind), position())

    def say(self, *messages):
        """What is answered at once, heartbeats and requests for telemetry left out."""
        for message in messages:
            self.session.hear(message, self.now)
        return self.taken()

    def after(self, seconds):
        self.now += seconds
        self.session.tick(self.now)
        return self.taken()

    def taken(self):
        quiet = ("HEARTBEAT",)
        said = [m for m in self.session.take() if m.get_type() not in quiet]
        return [m for m in said if getattr(m, "command", None) != M.MAV_CMD_SET_MESSAGE_INTERVAL]

    def fly(self, *places, hold_s=0.0):
        self.session.follow([Waypoint(place, hold_s=hold_s) for place in places], self.now)
        return self.taken()

    def arming(self, *places):
        """Until it is asked to arm; what it is told then."""
        for seq in range(self.fly(*places)[0].count):
            self.say(request(seq))
        return self.say(mission_ack())

    def flying(self, *places):
        """Until a mission of these places is under way."""
        first = self.arming(*places)
        if first[0].get_type() == "COMMAND_LONG":
            first = self.say(heartbeat(self.kind, armed=True))
        self.say(from_drone(M.MAVLink_mission_current_message(first[0].seq)))
        assert self.say(heartbeat(self.kind, self.kind.mission, armed=True), position(above=8.0)) == []


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
    talk = Talk(link_lost_s=100)
    said = [*talk.fly((10.0, 0.0, 8.0))]
    for _ in range(20):
        said += talk.after(0.5)
    assert [message.get_type() for message in said] == ["MISSION_COUNT"] * 5
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
    for act, sub in ((talk.session.hold, 3), (talk.session.go_back, 5)):
        act(talk.now)
        (said,) = talk.taken()
        assert (said.command, said.param1, said.param2, said.param3) == (176, 1.0, 4.0, float(sub))
    talk = Talk(ARDUPILOT)
    talk.flying((10.0, 0.0, 8.0))
    talk.session.land(talk.now)
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


def test_a_silent_heartbeat_is_a_lost_link_and_a_dead_drone_is_told_nothing():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    assert [talk.after(1.0) for _ in range(5)] == [[]] * 5
    assert talk.session.fault.kind is Kind.LINK_LOST


def test_in_a_mode_that_muster_did_not_choose_it_lets_go():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    assert talk.say(heartbeat(mode=3 << 16, armed=True), heartbeat(mode=3 << 16, armed=True)) == []
    assert talk.session.fault.kind is Kind.TAKEN_OVER
    talk.session.hold(talk.now)
    assert talk.fly((1.0, 1.0, 5.0)) == []


def test_low_battery_on_the_ground_arms_nothing():
    talk = Talk()
    talk.say(from_drone(M.MAVLink_sys_status_message(0, 0, 0, 0, 11000, -1, 12, 0, 0, 0, 0, 0, 0)))
    assert talk.fly((10.0, 0.0, 8.0)) == []
    assert talk.session.fault.kind is Kind.LOW_BATTERY


def test_without_leave_there_are_no_way_points():
    talk = Talk(arm=False)
    with pytest.raises(ParameterError, match="leave to arm"):
        talk.fly((10.0, 0.0, 8.0))
    assert talk.taken() == []


HOLD, DISARM, START = (M.MAV_CMD_DO_SET_MODE, M.MAV_CMD_COMPONENT_ARM_DISARM, M.MAV_CMD_MISSION_START)


def commands(messages):
    return [(m.command, m.param1) for m in messages if m.get_type() == "COMMAND_LONG"]


@pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
def test_a_cancel_between_the_request_to_arm_and_its_heartbeat_disarms(kind):
    talk = Talk(kind)
    assert commands(talk.arming((10.0, 0.0, 8.0))) == [(DISARM, 1.0)]
    talk.session.hold(talk.now)
    said = talk.after(0.1)
    assert commands(said) == [(HOLD, 1.0), (DISARM, 0.0)]
    assert said[1].param2 == 0.0  # never by force
    assert talk.session.busy
    assert talk.say(heartbeat(kind, kind.hold, armed=False)) == []  # may be older than the request to arm
    assert talk.session.busy
    assert talk.say(heartbeat(kind, kind.hold, armed=True)) == []  # which came through
    assert commands(talk.after(1.6)) == [(HOLD, 1.0), (DISARM, 0.0)]
    talk.say(heartbeat(kind, kind.hold), heartbeat(kind, kind.hold))
    assert not talk.session.busy
    assert talk.session.fault is None


def test_armed_on_the_ground_and_told_to_stay_it_is_disarmed_too_and_may_fly_later():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    talk.say(heartbeat(armed=True))
    talk.session.hold(talk.now)
    assert (DISARM, 0.0) in commands(talk.after(0.1))
    talk.say(heartbeat(), heartbeat())
    assert not talk.session.busy
    talk.flying((10.0, 0.0, 8.0))  # armed anew, and told to take off
    assert talk.session.fault is None


def test_an_order_that_follows_a_cancel_at_once_takes_its_place():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    talk.say(heartbeat(armed=True))
    talk.session.hold(talk.now)
    assert commands(talk.fly((20.0, 0.0, 8.0))) == [(HOLD, 1.0)]  # the start may have been on its way
    (count,) = talk.say(heartbeat(armed=True), heartbeat(armed=True))
    assert count.count == 3  # it stands, though armed: it takes off
    assert commands(talk.after(0.1)) == []


def test_who_refuses_to_be_disarmed_flies_and_hovers():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    talk.say(heartbeat(armed=True))
    talk.session.hold(talk.now)
    talk.after(0.1)
    talk.say(ack(DISARM, M.MAV_RESULT_DENIED))
    talk.say(heartbeat(mode=PX4.hold, armed=True), heartbeat(mode=PX4.hold, armed=True))
    assert not talk.session.busy
    assert talk.session.fault is None
    assert (DISARM, 0.0) not in commands(talk.after(2.0))


def test_in_the_air_nothing_is_disarmed():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    for end in (talk.session.hold, talk.session.go_back, talk.session.land):
        end(talk.now)
        assert {command for command, _ in commands(talk.after(0.1))} <= {HOLD}


def test_a_late_acknowledgement_of_the_start_starts_nothing():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    (current,) = talk.say(heartbeat(armed=True))
    (start,) = talk.say(from_drone(M.MAVLink_mission_current_message(current.seq)))
    assert start.command == START
    assert talk.say(ack(START, M.MAV_RESULT_ACCEPTED)) == []  # of the mission before, it may be
    assert talk.session.busy
    talk.say(heartbeat(armed=True))  # still in its mode: the start was lost
    assert commands(talk.after(1.6)) == [(START, 0.0)]
    talk.say(heartbeat(mode=PX4.mission, armed=True))
    assert not talk.session.busy
    talk.say(ack(START, M.MAV_RESULT_ACCEPTED), ack(START, M.MAV_RESULT_DENIED))  # later still
    assert talk.session.fault is None


def test_a_hold_right_after_the_start_is_said_although_the_last_heartbeat_shows_it():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    talk.say(heartbeat(mode=PX4.hold, armed=True))
    for seq in range(talk.fly((20.0, 0.0, 8.0))[0].count):
        talk.say(request(seq))
    talk.say(mission_ack(), from_drone(M.MAVLink_mission_current_message(0)))
    talk.session.hold(talk.now)  # started, and no heartbeat has shown it
    assert commands(talk.taken()) == [(HOLD, 1.0)]
    talk.say(heartbeat(mode=PX4.hold, armed=True))
    assert talk.session.busy  # that heartbeat may be older than the start
    talk.say(heartbeat(mode=PX4.hold, armed=True))
    assert not talk.session.busy


def test_who_is_flown_by_somebody_is_not_taken_from_them():
    talk = Talk()
    talk.say(heartbeat(mode=3 << 16, armed=True), position(above=12.0))
    assert talk.fly((10.0, 0.0, 8.0)) == []
    assert talk.session.fault.kind is Kind.TAKEN_OVER
    assert talk.after(2.0) == []


def test_a_pilot_who_takes_over_during_an_upload_is_let():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    talk.say(heartbeat(mode=PX4.hold, armed=True))
    talk.fly((20.0, 0.0, 8.0))
    assert talk.session.busy
    assert talk.say(heartbeat(mode=3 << 16, armed=True), heartbeat(mode=3 << 16, armed=True)) == []
    assert talk.session.fault.kind is Kind.TAKEN_OVER
    assert talk.after(2.0) == []


def test_a_fault_of_a_drone_that_stands_armed_ends_on_the_ground():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    talk.say(heartbeat(armed=True))
    talk.say(from_drone(M.MAVLink_sys_status_message(0, 0, 0, 0, 11000, -1, 12, 0, 0, 0, 0, 0, 0)))
    talk.after(0.1)
    assert talk.session.fault.kind is Kind.LOW_BATTERY
    assert commands(talk.after(0.1)) == [(HOLD, 1.0), (DISARM, 0.0)]  # and not: return


@pytest.mark.parametrize(("text", "breach"), [(b"Geofence breached", True), (b"Fence breach cleared", False)])
def test_a_fence_that_is_breached_by_words(text, breach):
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    talk.say(from_drone(M.MAVLink_statustext_message(M.MAV_SEVERITY_WARNING, text)))
    said = talk.after(0.1)
    assert (talk.session.fault is not None) == breach
    if breach:
        assert talk.session.fault.kind is Kind.FENCE_BREACHED
        assert talk.session.fault.detail == "Geofence breached"
        assert commands(said) == [(HOLD, 1.0)]
