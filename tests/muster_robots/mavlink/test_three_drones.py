"""Three drones: listened to, uploaded to, flown, and planned for again when the battery of one is low."""

from collections import Counter

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission

import muster
from muster.mission.model import Task
from muster.running.live import carry_out_live
from muster_robots.mavlink import Kind
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.dialect import mavlink
from muster_robots.mavlink.simulated.faults import Faults

HARMLESS = {"HEARTBEAT", "SET_MESSAGE_INTERVAL", "PARAM_REQUEST_READ", "MISSION_REQUEST_LIST", "MISSION_ACK"}
TASKS = tuple(Task(id=f"t_{k}", position=(25.0 + 25.0 * (k // 3), 6.0 * (k % 3), 10.0)) for k in range(9))


def said_to(drone, since=0):
    """Every message that a drone heard, by its name or its command's, and how often."""
    names = mavlink.enums["MAV_CMD"]
    return Counter(
        names[m.command].name.removeprefix("MAV_CMD_") if m.get_type() == "COMMAND_LONG" else m.get_type()
        for m in drone.heard[since:]
    )


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
@pytest.mark.parametrize("offboard", [False, True], ids=["mission", "offboard"])
def test_three_drones_one_of_which_runs_low(kind, offboard):
    there, heard = mission(3, TASKS), []
    plan = muster.solve(there, iterations=200)
    planned = {route.robot: route.tasks for route in plan.routes}
    assert all(len(tasks) >= 2 for tasks in planned.values())
    sky = Sky(there, kind, {"r_1": Faults(low_battery_at_s=10)})

    listening = sky.fleet(there, arm=False, offboard=offboard)
    listening.advance(listening.time_s + 10)
    listening.close()
    fleet = sky.fleet(there, offboard=offboard)  # with leave, but nothing to do yet
    fleet.advance(fleet.time_s + 5)
    for drone in sky.drones.values():
        assert set(said_to(drone)) == HARMLESS
        assert said_to(drone)["HEARTBEAT"] >= 15
        assert not drone.armed
    before = {robot: len(drone.heard) for robot, drone in sky.drones.items()}

    report = carry_out_live(there, plan, fleet, on_event=heard.append)
    ended = {robot: len(drone.heard) for robot, drone in sky.drones.items()}
    fleet.advance(fleet.time_s + 30)
    fleet.close()
    sky.close()

    # all is done, and what the low one had left was done by others
    assert set(report.tasks_done) == {task.id for task in TASKS}
    by = {task.task: task.robot for task in report.tasks}
    first_done = [name for name in planned["r_1"] if by[name] == "r_1"]
    assert first_done
    assert tuple(first_done) == planned["r_1"][: len(first_done)]
    left = planned["r_1"][len(first_done) :]
    assert left
    assert {by[name] for name in left} <= {"r_0", "r_2"}
    (low,) = [event for event in heard if event.kind == "robot_fails"]
    assert low.data == {"robot": "r_1", "reason": "low battery: 10% left; expected 25%"}
    (again,) = [event for event in heard if event.kind == "replanned"]
    assert again.time_s >= low.time_s
    assert set(again.data["moved"]) >= set(left)
    assert report.reallocations == 1
    assert [fault.kind for fault in fleet.faults] == [Kind.LOW_BATTERY]

    # the low one went home and landed; the others hover where they did their last task
    r_1 = sky.drones["r_1"]
    assert r_1.flight.place == pytest.approx((0.0, 0.0, 0.0), abs=0.01)
    assert (r_1.armed, r_1.mode) == (False, kind.back)
    for robot in ("r_0", "r_2"):
        drone = sky.drones[robot]
        assert drone.armed
        assert drone.flight.place[2] == pytest.approx(-10.0, abs=1.0)  # as near as counts as there

    for robot, drone in sky.drones.items():
        said = said_to(drone, before[robot])
        assert said["COMPONENT_ARM_DISARM"] == 1
        ways = {"MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_SET_CURRENT", "MISSION_START"}
        assert set(said) & ways == (set() if offboard else ways)
        assert (said["SET_POSITION_TARGET_LOCAL_NED"] > 0) == offboard
        if not offboard:
            sets_out = [h for h in heard if h.kind == "sets_out" and h.data["robot"] == robot]
            assert said["MISSION_COUNT"] >= len(sets_out) > 0
            assert said["MISSION_ITEM_INT"] >= 2 * said["MISSION_COUNT"]
    modes = [m for m in r_1.heard if m.get_type() == "COMMAND_LONG" and m.command == mavlink.MAV_CMD_DO_SET_MODE]
    assert (modes[-1].param2, modes[-1].param3) == kind.mode_parameters(kind.back)
    after_low = r_1.heard[next(k for k, m in enumerate(r_1.heard) if m is modes[-1]) + 1 :]
    assert {m.get_type() for m in after_low} == {"HEARTBEAT"}
    assert set(said_to(r_1, ended["r_1"])) == {"HEARTBEAT"}
