"""What becomes of drones at the end: every one that answers is brought down or home, and how each ends is told."""

import re

import pytest
from tests.muster_robots.mavlink.drones import Sky, flown, mission
from tests.muster_robots.mavlink.talk import HOLD, M, Talk, ack, from_drone, heartbeat, position

import muster
from muster.mission.model import Task
from muster.running.live import carry_out_live
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.faults import Kind
from muster_robots.mavlink.simulated.faults import Faults

KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
FAR = (Task(id="t_0", position=(100.0, 0.0, 10.0)), Task(id="t_1", position=(100.0, 8.0, 10.0)))


def ended(kind, faults, at_end):
    """Two drones of which r_0 has a fault, carried out and ended: the fleet's final states, and the drones."""
    there = mission(2, FAR)
    sky = Sky(there, kind, {"r_0": faults})
    fleet = sky.fleet(there)
    report = carry_out_live(there, muster.solve(there, iterations=50), fleet)
    fleet.finish(at_end, lambda: False)
    states = {state.robot: state for state in fleet.final_states()}
    fleet.close()
    sky.close()
    return report, fleet, states, sky.drones


@pytest.mark.long
@KINDS
@pytest.mark.parametrize("at_end", ["hold", "return", "land"])
def test_a_drone_whose_heartbeats_were_late_by_7_s_ends_as_the_others(kind, at_end):
    report, fleet, states, drones = ended(kind, Faults(late_heartbeats_s=10), at_end)
    assert fleet.faults == []
    assert set(report.tasks_done) == {"t_0", "t_1"}
    for name, drone in drones.items():
        state = states[name]
        assert state.moving == drone.armed == (at_end == "hold")
        words = {"hold": "hovers, armed", "return": "returned, landed, not armed", "land": "landed, not armed"}
        assert state.state == words[at_end]
        assert drone.flight.flies == (at_end == "hold")
        north, east, _ = drone.flight.place
        assert (abs(north) + abs(east) < 0.1) == (at_end == "return")


@pytest.mark.long
@KINDS
def test_a_drone_that_is_heard_only_after_the_end_is_told_then(kind):
    _, _, states, drones = ended(kind, Faults(late_heartbeats_s=25, late_by_s=10), "return")
    assert not drones["r_0"].armed
    assert states["r_0"].state == "returned, landed, not armed"


@pytest.mark.long
def test_a_drone_that_does_not_answer_counts_as_flying():
    _, fleet, states, _ = ended(PX4, Faults(silent_at_s=10), "return")
    assert states["r_0"].moving
    assert states["r_0"].state.startswith("not answering for ")
    assert states["r_0"].state.endswith("s; last seen: flies, armed")
    assert str(fleet.faults[0]).endswith("not told to hover")
    assert not states["r_1"].moving


@pytest.mark.long
@KINDS
def test_a_drone_that_falls_silent_as_it_arms_counts_as_flying(kind):
    """Muster never hears that it is armed."""
    _, _, states, drones = ended(kind, Faults(silent_at_s=0), "return")
    assert drones["r_0"].armed
    assert states["r_0"].moving
    assert re.fullmatch(r"not answering for \d+ s; last seen: asked to arm", states["r_0"].state)


@pytest.mark.long
def test_a_drone_that_returns_for_its_battery_is_not_told_to_land_on_its_way():
    _, _, states, drones = ended(PX4, Faults(low_battery_at_s=15), "land")
    assert states["r_0"].state == "returned, landed, not armed"
    assert drones["r_0"].flight.place[:2] == pytest.approx((0.0, 0.0), abs=0.1)


@pytest.mark.long
def test_a_drone_under_a_pilot_is_left_to_the_pilot_and_named():
    _, _, states, drones = ended(PX4, Faults(pilot_at_s=10), "return")
    assert drones["r_0"].mode == 3 << 16
    assert states["r_0"].moving
    assert states["r_0"].state == "flies under a pilot, armed"


@pytest.mark.long
def test_a_drone_that_never_flew():
    _, _, states, _ = ended(PX4, Faults(refuse_arm=True), "return")
    assert (states["r_0"].state, states["r_0"].moving) == ("did not fly, not armed", False)
    assert re.fullmatch(r"r_0: did not fly, not armed; at \(-?0.00, -?0.00, -?0.00\)", str(states["r_0"]))


@KINDS
def test_the_words_of_an_autopilot_that_refuses_an_order_are_in_the_event_and_in_the_fault(kind):
    _, fleet, _, events = flown(mission(1), kind, {"r_0": Faults(refuse_start=True)})
    (reason,) = [event.data["reason"] for event in events if event.kind == "task_refused"][:1]
    assert reason.endswith(": MAV_RESULT_DENIED (Mission start denied: no valid mission)")
    assert str(fleet.faults[0]) == f"r_0: {reason}"


def text(words, chunk=0):
    padded = words.encode()
    return from_drone(M.MAVLink_statustext_message(4, padded, id=int(chunk > 0), chunk_seq=chunk))


def test_words_that_come_after_a_refusal_belong_to_it_for_half_a_second():
    talk = Talk()
    talk.say(text("of another order"))
    talk.arming((10.0, 0.0, 8.0))
    talk.say(ack(400, M.MAV_RESULT_DENIED))
    talk.now += 0.3
    talk.say(text("Arming denied: "), text("switch kill switch off", chunk=1))
    talk.now += 1.0
    talk.say(text("too late"))
    expected = "arm refused: MAV_CMD_COMPONENT_ARM_DISARM: MAV_RESULT_DENIED (Arming denied: switch kill switch off)"
    assert talk.session.fault.reason == expected


def test_what_an_autopilot_says_that_refuses_to_end_its_flight_is_kept_beside_its_fault():
    talk = Talk()
    talk.flying((10.0, 0.0, 8.0))
    talk.session.fail(Kind.FENCE_BREACHED, "", talk.now)
    talk.say(heartbeat(mode=PX4.hold, armed=True), position(above=8.0))
    talk.after(1.0)
    talk.session.end("return", talk.now)
    refusal = M.MAVLink_command_ack_message(HOLD, M.MAV_RESULT_DENIED, 0, 7)
    talk.say(text("RTL denied: no home position"), from_drone(refusal))
    first, second = talk.session.faults
    assert first.kind is Kind.FENCE_BREACHED
    assert second.reason == (
        "command refused: MAV_CMD_DO_SET_MODE: MAV_RESULT_DENIED, 7 (RTL denied: no home position)"
    )
