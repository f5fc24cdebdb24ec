"""A drone that has failed and may fly on: whose link is there again, or who did not do what it was told."""

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission
from tests.muster_robots.mavlink.talk import DISARM, HOLD, Talk, ack, commands, heartbeat, position

from muster.motion.port import Waypoint
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.dialect import mavlink
from muster_robots.mavlink.faults import Kind

KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)


def lost(kind=PX4):
    """A talk with a drone that flew a mission, and whose link is lost."""
    talk = Talk(kind)
    talk.flying((10.0, 0.0, 8.0))
    assert talk.after(6.0) == []
    assert talk.session.fault.kind is Kind.LINK_LOST
    return talk


@KINDS
def test_whose_link_is_back_is_told_to_hold_at_its_first_heartbeat_and_stays_out(kind):
    talk = lost(kind)
    assert commands(talk.say(heartbeat(kind, kind.mission, armed=True))) == [(HOLD, 1.0)]
    talk.say(heartbeat(kind, kind.hold, armed=True))
    assert not talk.session.busy
    talk.session.hold(talk.now)
    assert talk.fly((1.0, 1.0, 5.0)) == []
    assert talk.session.fault.kind is Kind.LINK_LOST


def test_while_it_is_not_heard_it_is_told_nothing_and_in_the_end_that_is_said():
    talk = lost()
    talk.session.hold(talk.now)
    assert talk.taken() == []
    talk.session.note_missing_hold()
    talk.session.note_missing_hold()
    assert talk.session.fault.detail == "no heartbeat for 6.0 s; not told to hover"


def test_whose_link_is_lost_again_before_it_holds_is_told_again():
    talk = lost()
    beat = heartbeat(mode=PX4.mission, armed=True)
    talk.say(beat)
    for _ in range(20):
        talk.after(1.0)
    assert not talk.session.busy
    assert commands(talk.say(beat)) == [(HOLD, 1.0)]


@pytest.mark.parametrize("mode", [3 << 16, PX4.back], ids=["pilot", "failsafe"])
def test_whom_somebody_flies_when_the_link_is_back_is_left_to_them(mode):
    talk = lost()
    assert talk.say(heartbeat(mode=mode, armed=True)) == []
    talk.session.hold(talk.now)
    talk.session.note_missing_hold()
    assert talk.taken() == []
    assert "not told" not in talk.session.fault.detail


def test_who_stood_armed_when_its_link_was_lost_is_disarmed():
    talk = Talk()
    talk.arming((10.0, 0.0, 8.0))
    talk.say(heartbeat(armed=True))
    talk.after(6.0)
    assert talk.session.fault.kind is Kind.LINK_LOST
    talk.say(heartbeat(armed=True))
    assert commands(talk.after(0.1)) == [(HOLD, 1.0), (DISARM, 0.0)]


def test_who_refused_to_hold_is_told_again_when_all_are():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    talk.session.fail(Kind.FENCE_BREACHED, "", talk.now)
    talk.say(ack(HOLD, mavlink.MAV_RESULT_DENIED), heartbeat(mode=PX4.mission, armed=True), position(above=8.0))
    assert not talk.session.busy
    talk.taken()
    talk.session.hold(talk.now)
    assert commands(talk.taken()) == [(HOLD, 1.0)]


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
    assert [event.robot_fails for event in fleet.advance(fleet.time_s + 10.0)] == ["r_0"]
    assert drone.mode == kind.mission
    if heard_again:
        drone.advance = say
        fleet.advance(fleet.time_s + 3.0)
        assert drone.mode == kind.hold
    fleet.stop()
    fleet.close()
    sky.close()
    assert (drone.mode == kind.hold) == heard_again
    assert str(fleet.faults[0]).endswith("not told to hover") != heard_again
