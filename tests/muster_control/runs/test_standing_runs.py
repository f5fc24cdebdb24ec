"""Runs of fleets that stay on duty: orders many at once, the end of the duty, and going on after a crash."""

import pytest
from tests.muster_control.runs.stage import performed, performed_with_crashes, require_whole

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Rules
from muster_control.runs.run_settings import new_request, require_action

MISSION = Mission(
    robots=tuple(Robot(id=f"r_{k}", position=(10 * k, 0)) for k in range(3)),
    tasks=(),
    rules=Rules(objective="lateness"),
)
PLAN = muster.solve(MISSION, "greedy")
COUNTED = {"taken": 9, "done": 8, "cancelled": 1, "open": 0}
ON_DUTY = {"stay": True, "until_s": 40.0}


def order(k):
    return {"new_task": {"id": f"o_{k}", "position": [3 * k % 20, 5 + k % 7], "duration_s": 2}}


def asked():
    first = [order(k) for k in range(8)]
    wrong = [order(3), {"cancel_task": "o_7"}, {"new_task": {"id": "x", "position": [1, 2, 3]}}]
    return [(5.0, "orders", {"orders": first}), (8.0, "orders", {"orders": wrong}), (31.0, "event", order(9))]


def test_a_fleet_on_duty_takes_orders_and_ends_when_all_are_done():
    log = performed(MISSION, PLAN, asked(), settings=ON_DUTY).log
    outcomes = [entry["data"]["outcome"] for entry in log if entry["kind"] == "command"]
    assert (outcomes[0], outcomes[2]) == ("done", "done")
    assert outcomes[1].startswith('2 refused, the first: new_task: "o_3"')
    report = log[-1]["data"]
    assert set(report["tasks_done"]) == {*(f"o_{k}" for k in range(7)), "o_9"}
    assert {key: report["orders"][key] for key in ("taken", "done", "cancelled", "open")} == COUNTED
    assert log[-2]["time_s"] >= 40.0


@pytest.mark.parametrize("crash", [7, *(pytest.param(k, marks=pytest.mark.long) for k in range(14, 80, 7))])
def test_a_run_on_duty_that_is_killed_goes_on_with_its_orders(crash):
    kept = performed_with_crashes(MISSION, PLAN, asked(), [crash], settings=ON_DUTY)
    require_whole(kept, MISSION)
    orders = kept.log[-1]["data"]["orders"]
    assert {key: orders[key] for key in ("taken", "done", "cancelled", "open")} == COUNTED


def test_settings_of_duty_are_checked():
    new_request("kinematic", (), ON_DUTY)
    with pytest.raises(ParameterError, match=r"until_s: 40.0; expected it together with stay"):
        new_request("kinematic", (), {"until_s": 40.0})
    with pytest.raises(ParameterError, match="stay: 1; expected true or false"):
        new_request("kinematic", (), {"stay": 1})
    assert new_request("kinematic", (), {}).duty is None
    assert new_request("kinematic", (), ON_DUTY).duty.until_s == 40.0


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({}, "data: nothing; expected orders, a list of 1 to 1000"),
        ({"orders": []}, "data: orders; expected orders, a list of 1 to 1000"),
        ({"orders": [{"robot_fails": "r_0"}]}, r"orders\[0\]: .*; expected one of new_task, cancel_task"),
        ({"orders": [order(1), {"at_s": 3, **order(2)}]}, r"orders\[1\]: .*, without at_s"),
    ],
)
def test_what_is_no_list_of_orders_is_refused(data, message):
    with pytest.raises(ParameterError, match=message):
        require_action("orders", data)
