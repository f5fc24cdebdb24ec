"""A session when orders and answers cross: cancelled while it arms, late answers, a pilot; none is left armed."""

import pytest
from tests.muster_robots.mavlink.talk import (
    DISARM,
    HOLD,
    START,
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

from muster_robots.custody import Standing
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.faults import Kind


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
    for at_end in ("hold", "return", "land"):
        talk.session.end(at_end, talk.now)
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
    assert talk.session.custody.standing is Standing.PILOT
    assert talk.after(2.0) == []


def test_a_pilot_who_takes_over_during_an_upload_is_let():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    talk.say(heartbeat(mode=PX4.hold, armed=True))
    talk.fly((20.0, 0.0, 8.0))
    assert talk.session.busy
    assert talk.beats(mode=3 << 16, armed=True) == []
    assert talk.session.custody.standing is Standing.PILOT
    assert talk.after(2.0) == []


def test_a_fault_of_a_drone_that_stands_armed_ends_on_the_ground():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    talk.say(heartbeat(armed=True))
    talk.say(from_drone(M.MAVLink_sys_status_message(0, 0, 0, 0, 11000, -1, 12, 0, 0, 0, 0, 0, 0)))
    talk.after(0.1)
    assert talk.session.fault.kind is Kind.LOW_BATTERY
    assert commands(talk.after(0.1)) == [(HOLD, 1.0), (DISARM, 0.0)]  # and not: return


def test_a_late_refusal_to_arm_is_a_fault_and_whom_a_second_request_arms_is_disarmed():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    assert commands(talk.after(1.6)) == [(DISARM, 1.0)]  # both are under way
    talk.say(ack(DISARM, M.MAV_RESULT_DENIED))
    assert talk.session.fault.kind is Kind.ARM_REFUSED
    assert commands(talk.after(0.1)) == [(HOLD, 1.0), (DISARM, 0.0)]
    talk.say(heartbeat(armed=True))
    assert talk.session.busy
    assert commands(talk.after(1.6)) == [(HOLD, 1.0), (DISARM, 0.0)]
    talk.say(heartbeat(), heartbeat())
    assert not talk.session.busy


@pytest.mark.parametrize(("text", "breach"), [(b"Geofence breached", True), (b"Fence breach cleared", False)])
def test_a_fence_that_is_breached_by_words(text, breach):
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    said = talk.say(from_drone(M.MAVLink_statustext_message(M.MAV_SEVERITY_WARNING, text)))
    assert bool(talk.session.faults) == breach
    assert talk.session.fault is None
    if breach:
        assert talk.session.faults[0].kind is Kind.FENCE_BREACHED
        assert talk.session.faults[0].reason == "fence breached: Geofence breached"
        assert talk.session.telemetry().refused == talk.session.telemetry().suspended
        assert commands(said) == [(HOLD, 1.0)]
