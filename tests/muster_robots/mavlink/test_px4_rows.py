"""Flights that went wrong on a real PX4, flown again: none ends as it did there. The names are those of the flights."""

import pytest
from tests.muster_robots.mavlink.fault_flights import FAR, fly

from muster.mission.model import Task
from muster_robots.mavlink import Kind
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.simulated.faults import Faults

ALL = {task.id for task in FAR}
KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
HOME = "returned, landed, not armed"


@pytest.mark.long
@KINDS
@pytest.mark.parametrize(
    "faults",
    [
        Faults(silent_at_s=8, silent_for_s=5),
        Faults(silent_at_s=8, silent_for_s=7),
        Faults(silent_at_s=8, silent_for_s=8),
        Faults(silent_at_s=8, silent_for_s=20),
        Faults(late_heartbeats_s=8, late_by_s=7),
        Faults(late_heartbeats_s=8, late_by_s=25),
        Faults(mute_at_s=8, mute_for_s=20),
        Faults(frozen_at_s=8, frozen_for_s=8),
    ],
    ids=["5 s", "f03 7 s", "8 s", "f04 20 s", "f05 heartbeats alone", "heartbeats 25 s", "uplink alone", "g04 frozen"],
)
@pytest.mark.parametrize("count", [1, 2], ids=["alone", "of two"])
def test_a_gap_loses_neither_drone_nor_task(faults, kind, count):
    lands = kind is ARDUPILOT and faults.frozen_at_s is not None  # before its failsafe is over
    flight = fly(faults, count=count, kind=kind)
    assert lands or "robot_fails" not in flight.kinds("r_0")
    assert flight.done == ALL or (lands and count == 1)
    assert flight.done_twice == set()
    assert {state.state for state in flight.states.values()} == {HOME}


@pytest.mark.long
def test_f06_who_is_called_home_by_another_station_is_left_to_it_and_its_words_are_told():
    flight = fly(Faults(rtl_at_s=8))
    assert flight.done == ALL
    assert {state.state for state in flight.states.values()} == {HOME}
    assert any("RTL: climb to 502 m" in str(fault) and "mode RTL" in str(fault) for fault in flight.fleet.faults)
    assert all("0x" not in str(fault) for fault in flight.fleet.faults)


@pytest.mark.long
@KINDS
def test_f07_what_a_fence_of_the_autopilot_refuses_others_do_and_the_drone_does_the_rest(kind):
    near = tuple(Task(id=f"n_{k}", position=(20.0, 6.0 * k, 10.0)) for k in range(4))
    flight = fly(Faults(fence_m=40.0, mute_parameters=True), tasks=(*FAR[:2], *near), kind=kind)
    assert flight.done == {"t_0", "t_1", *(task.id for task in near)}
    assert "robot_fails" not in flight.kinds("r_0")
    refused = [event.data for event in flight.events if event.kind == "task_refused"]
    assert {one["robot"] for one in refused} == {"r_0"}
    assert all("Geofence violation for waypoint 1" in one["reason"] for one in refused)
    by = {task.task: task.robot for task in flight.report.tasks}
    assert by["t_0"] == by["t_1"] == "r_1"
    assert "r_0" in by.values()
    assert {state.state for state in flight.states.values()} == {HOME}


def test_f08_a_stick_mode_without_sticks_that_fell_to_hold_is_taken_back():
    flight = fly(Faults(pilot_at_s=8, no_sticks=True), count=1)
    assert flight.done == ALL
    assert flight.states["r_0"].state == HOME


@pytest.mark.long
@KINDS
def test_a_pilot_who_gives_the_drone_back_finds_it_brought_home_with_the_others(kind):
    flight = fly(Faults(pilot_at_s=8, pilot_for_s=6), kind=kind)
    assert flight.done == ALL
    assert {state.state for state in flight.states.values()} == {HOME}
    assert any("pilot" in str(fault) for fault in flight.fleet.faults)


@pytest.mark.long
def test_h01_the_position_lost_within_a_gap_ends_in_one_state():
    flight = fly(Faults(silent_at_s=8, silent_for_s=8, gps_lost_at_s=10, gps_lost_for_s=7))
    assert flight.done == ALL
    assert "robot_fails" not in flight.kinds("r_0")
    assert {state.state for state in flight.states.values()} == {HOME}


@KINDS
def test_g06_a_position_lost_for_good_is_told_in_the_autopilots_words(kind):
    flight = fly(Faults(gps_lost_at_s=8), count=1, kind=kind)
    assert set(flight.lost) | flight.done == ALL
    assert flight.lost
    said = " ".join(map(str, flight.fleet.faults))
    assert "no global position" in said
    assert "0x" not in said
    (state,) = flight.states.values()
    assert not state.moving
    assert state.position is None  # it was at 6 m when it was last known
    assert "landed, not armed" in state.state


def test_h02_a_low_battery_loses_the_tasks_and_says_so():
    flight = fly(Faults(low_battery_at_s=8, low_battery=0.24), count=1)
    assert flight.lost
    assert flight.states["r_0"].state == HOME
    assert [fault.kind for fault in flight.fleet.faults] == [Kind.LOW_BATTERY]
    assert all("r_0 (failed at" in why for why in flight.lost.values())


@KINDS
def test_g08_motors_that_stop_in_the_air_are_a_crash(kind):
    flight = fly(Faults(disarm_at_s=8), count=1, kind=kind)
    assert set(flight.lost) == ALL
    (state,) = flight.states.values()
    assert state.state.startswith("crashed")
    assert not state.moving
    assert "Disarmed by external command" in str(flight.fleet.faults[0])


def test_h04_a_way_point_too_far_costs_its_task_and_not_the_drone():
    tasks = (*FAR, Task(id="far", position=(1200.0, 0.0, 10.0)))
    flight = fly(Faults(first_item_m=900.0, mute_parameters=True), count=1, tasks=tasks)
    assert flight.done == ALL
    assert set(flight.lost) == {"far"}
    assert "First waypoint too far away: 1200m, 900 max" in flight.lost["far"]
    assert flight.states["r_0"].state == HOME


@pytest.mark.long
@KINDS
def test_f07_and_h04_with_parameters_that_are_read_nothing_is_flown_that_is_refused(kind):
    near = tuple(Task(id=f"n_{k}", position=(20.0, 6.0 * k, 10.0)) for k in range(4))
    tasks = (*FAR[:2], *near, Task(id="far", position=(1200.0, 0.0, 10.0)))
    faults = {"r_0": Faults(fence_m=40.0), "r_1": Faults(fence_m=900.0)}
    flight = fly(faults, tasks=tasks, kind=kind)
    name = "GF_MAX_HOR_DIST" if kind is PX4 else "FENCE_RADIUS"
    assert flight.done == {"t_0", "t_1", *(task.id for task in near)}
    assert flight.fleet.faults == []
    first = next(event.time_s for event in flight.events if event.kind == "sets_out")
    refused = [event for event in flight.events if event.kind == "task_refused"]
    assert all(event.time_s <= first for event in refused)  # before anything arms
    assert flight.refused_by("r_0") == {"t_0", "t_1", "far"}
    assert flight.refused_by("r_1") == {"far"}
    assert f"1200 m from home; expected at most 900 m by the autopilot's {name}" in flight.lost["far"]


def test_a_first_way_point_that_is_too_far_by_a_parameter_is_refused_before_take_off():
    tasks = (*FAR, Task(id="far", position=(1200.0, 0.0, 10.0)))
    flight = fly(Faults(first_item_m=900.0), count=1, tasks=tasks)
    assert flight.done == ALL
    assert "expected at most 900 m by the autopilot's MIS_DIST_1WP" in flight.lost["far"]
    assert flight.fleet.faults == []
