"""Whether a team gets on as a whole."""

from types import SimpleNamespace

from muster.execution.deadlocks.standstill import Standstill
from muster.execution.robots.robot_state import Activity


def robot(name, activity, left_m=0.0):
    return SimpleNamespace(
        robot=SimpleNamespace(id=name), activity=activity, way_left_m=left_m, at_home=False, route=["t"], out=""
    )


def test_to_and_fro_is_no_getting_on():
    team, standstill = [robot("r_0", Activity.DRIVING, 5.0)], Standstill()
    for now in range(60):
        team[0].way_left_m = 5.0 + now % 3
        standstill.look(team, float(now))
    assert standstill.since_s == 0.0
    team[0].way_left_m = 3.5
    standstill.look(team, 60.0)
    assert standstill.since_s == 60.0


def test_who_works_and_who_has_nothing_to_do_holds_nobody_up():
    for activity in (Activity.WORKING, Activity.WAITING):
        standstill = Standstill()
        for now in (0.0, 50.0):
            standstill.look([robot("r_0", Activity.DRIVING, 5.0), robot("r_1", activity)], now)
        assert standstill.since_s == 50.0
    for now in (0.0, 50.0):
        standstill.look([robot("r_0", Activity.IDLE)], now)
    assert standstill.since_s == 50.0
