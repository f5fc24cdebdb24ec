"""A drone that comes back: that was silent, under a failsafe or a pilot, or did not do what it was told."""

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission
from tests.muster_robots.mavlink.talk import DISARM, HOLD, M, Talk, ack, commands, from_drone, heartbeat, position

from muster.motion.port import Waypoint
from muster_robots.custody import Standing
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.dialect import mavlink
from muster_robots.mavlink.faults import Kind

KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)


def lost(kind=PX4, **settings):
    """A talk with a drone that flew a mission, and is silent; its order was cancelled meanwhile."""
    talk = Talk(kind, **settings)
    talk.flying((10.0, 0.0, 8.0))
    assert talk.after(11.0) == []
    assert talk.session.custody.standing is Standing.SILENT
    talk.session.hold(talk.now)
    assert talk.taken() == []
    return talk


@KINDS
def test_who_is_heard_again_is_told_to_hold_at_its_first_heartbeat_and_takes_part_again(kind):
    talk = lost(kind)
    assert commands(talk.say(heartbeat(kind, kind.mission, armed=True))) == [(HOLD, 1.0)]
    assert talk.session.telemetry().time_s < talk.now - 10.0  # it counts as silent until it holds
    talk.beats(5, mode=kind.hold, armed=True)
    assert talk.session.custody.standing is Standing.OURS
    assert talk.session.telemetry().time_s == talk.now
    assert talk.session.faults == []
    assert talk.fly((1.0, 1.0, 5.0)) != []


def test_what_it_has_flown_unheard_is_told():
    talk = lost()
    talk.say(from_drone(M.MAVLink_mission_current_message(2, 3, M.MISSION_STATE_COMPLETE)))
    talk.beats(5, mode=PX4.hold, armed=True)
    assert talk.session.telemetry().carried_out == (1, 1)


def test_who_is_silent_too_often_is_out_for_good():
    talk = Talk(silences=2)
    talk.flying((10.0, 0.0, 8.0))
    for _ in range(2):
        talk.after(11.0)
        talk.beats(5, mode=PX4.mission, armed=True)
        assert talk.session.fault is None
    talk.after(11.0)
    assert talk.session.fault.reason == "link lost: silent, or without an answer, more than 2 times in 120 s"


def test_positions_alone_keep_it_from_being_silent():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    for _ in range(40):
        talk.say(position(above=8.0))
        talk.after(1.0)
    assert talk.session.custody.standing is Standing.OURS


def test_while_it_is_not_heard_it_is_told_nothing_and_in_the_end_that_is_said():
    talk = lost()
    talk.session.note_missing_hold(talk.now)
    talk.session.note_missing_hold(talk.now)
    (fault,) = talk.session.faults
    assert fault.detail == "nothing heard for 11.0 s; not told to hover"


def test_who_does_not_hold_is_told_again_and_again():
    talk = lost()
    told = [commands(talk.beats(1, mode=PX4.mission, armed=True)) for _ in range(30)]
    assert told.count([(HOLD, 1.0)]) > 8
    assert talk.session.telemetry().suspended.startswith("no answer: MAV_CMD_DO_SET_MODE")
    assert talk.session.fault is None


@pytest.mark.parametrize("mode", [3 << 16, PX4.back], ids=["pilot", "failsafe"])
def test_whom_somebody_flies_when_it_is_heard_again_is_left_to_them(mode):
    talk = lost()
    assert talk.beats(mode=mode, armed=True) == []
    talk.session.hold(talk.now)
    talk.session.note_missing_hold(talk.now)
    assert talk.taken() == []
    assert not any("not told" in fault.detail for fault in talk.session.faults)


def test_a_failsafe_that_comes_and_goes_ends_no_custody():
    """The autopilot resumes Muster's mission when it is over; Muster wants it to hold by then."""
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    text = from_drone(M.MAVLink_statustext_message(2, b"Failsafe enabled: no datalink"))
    talk.say(text, from_drone(M.MAVLink_statustext_message(6, b"RTL: climb to 30 m")))
    assert talk.beats(mode=PX4.back, armed=True, state=M.MAV_STATE_CRITICAL) == []
    assert talk.session.telemetry().suspended == (
        "failsafe: mode RTL (Failsafe enabled: no datalink; RTL: climb to 30 m)"
    )
    talk.session.hold(talk.now)
    assert talk.taken() == []
    assert commands(talk.beats(mode=PX4.mission, armed=True)) == [(HOLD, 1.0)]
    talk.beats(5, mode=PX4.hold, armed=True)
    assert talk.session.telemetry().suspended == ""


def test_a_pilot_without_sticks_gives_it_back_and_one_with_sticks_does_so_for_the_end_alone():
    for sticks in (False, True):
        talk = Talk()
        talk.flying((10.0, 0.0, 8.0))
        health = M.MAV_SYS_STATUS_SENSOR_RC_RECEIVER if sticks else 0
        talk.say(from_drone(M.MAVLink_sys_status_message(0, 0, health, 0, 11000, -1, 90, 0, 0, 0, 0, 0, 0)))
        talk.beats(mode=3 << 16, armed=True)
        talk.session.hold(talk.now)
        talk.beats(8, mode=PX4.hold, armed=True)
        assert bool(talk.session.telemetry().suspended) == sticks
        talk.session.end("return", talk.now)
        assert commands(talk.taken()) == [(HOLD, 1.0)]  # a command for a mode: to return


def test_another_station_that_lets_it_hold_keeps_it_until_it_flies_on():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    assert talk.beats(mode=PX4.hold, armed=True) == []
    talk.session.hold(talk.now)
    assert talk.beats(20, mode=PX4.hold, armed=True) == []
    assert talk.session.telemetry().suspended == "another station: mode HOLD"
    assert commands(talk.beats(mode=PX4.mission, armed=True)) == [(HOLD, 1.0)]
    talk.beats(5, mode=PX4.hold, armed=True)
    assert talk.session.telemetry().suspended == ""


def test_who_stood_armed_when_it_fell_silent_is_disarmed():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    talk.say(heartbeat(armed=True))
    talk.after(11.0)
    talk.session.hold(talk.now)
    talk.taken()
    talk.now += 1.0
    talk.say(heartbeat(armed=True))
    assert commands(talk.after(0.1)) == [(HOLD, 1.0), (DISARM, 0.0)]


def test_who_refused_to_hold_is_told_again():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    talk.session.fail(Kind.FENCE_BREACHED, "", talk.now)
    talk.say(ack(HOLD, mavlink.MAV_RESULT_DENIED), heartbeat(mode=PX4.mission, armed=True), position(above=8.0))
    talk.taken()
    assert (HOLD, 1.0) in commands(talk.beats(4, mode=PX4.mission, armed=True))


@pytest.mark.long(keep=2)
@KINDS
@pytest.mark.parametrize("heard_again", [True, False])
def test_a_fleet_whose_drone_was_silent_for_a_while(kind, heard_again):
    there = mission(1)
    sky = Sky(there, kind)
    fleet = sky.fleet(there)
    drone = sky.drones["r_0"]
    fleet.ports["r_0"].send([Waypoint((400.0, 0.0, 10.0))])
    fleet.advance(fleet.time_s + 15.0)
    say, drone.advance = drone.advance, lambda now: say(now) and []
    fleet.advance(fleet.time_s + 15.0)
    fleet.ports["r_0"].cancel()
    assert drone.mode == kind.mission
    if heard_again:
        drone.advance = say
        fleet.advance(fleet.time_s + 3.0)
        assert drone.mode == kind.hold
    fleet.stop()
    fleet.close()
    sky.close()
    assert (drone.mode == kind.hold) == heard_again
    assert [str(fault).endswith("not told to hover") for fault in fleet.faults] == [True] * (not heard_again)
