"""Drones over MAVLink that wait for a time window, for their team and for each other, and planned and flown times."""

from dataclasses import replace

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission
from tests.times_and_teams import judge, tasks_of

import muster
from muster.mission.model import Rules
from muster.running.live import carry_out_live
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.simulated.faults import Faults

OPENS_S = 40.0
TASKS = tasks_of(OPENS_S, side=10.0, height=(10.0,))


def flown(there, plan, sky, offboard):
    heard = []
    fleet = sky.fleet(there, offboard=offboard)
    report = carry_out_live(there, plan, fleet, on_event=heard.append)
    fleet.close()
    sky.close()
    return report, heard


@pytest.mark.long
@pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
@pytest.mark.parametrize("offboard", [False, True], ids=["mission", "offboard"])
def test_drones_wait_for_a_window_and_begin_together(kind, offboard):
    there = mission(3, TASKS, rules=Rules(objective="makespan"))
    plan = muster.solve(there, iterations=300)
    assert plan.complete
    report, heard = flown(there, plan, Sky(there, kind), offboard)
    judge(report.as_dict(), OPENS_S)
    assert any("window" in str(event.data) for event in heard if event.kind == "waits")


def test_a_team_reforms_when_a_drone_has_to_land():
    there = mission(3, (replace(TASKS[1], prerequisites=()),), rules=Rules(objective="makespan"))
    plan = muster.solve(there, iterations=300)
    first = [route.robot for route in plan.routes if route.tasks]
    report, _ = flown(there, plan, Sky(there, PX4, {first[0]: Faults(low_battery_at_s=8)}), offboard=True)
    assert report.tasks_done == ("lift",)
    assert report.reallocations == 1
    assert first[0] not in report.tasks[0].team
