"""A window, a team and tasks that begin together in both worlds, and a member that fails; and their records."""

from dataclasses import replace
from importlib.util import find_spec

import pytest
from tests.times_and_teams import judge, tasks_of

import muster
from muster.mission.model import Event, Mission, Robot

OPENS_S = 8.0
WORLDS = ["kinematic", "physics"]


@pytest.fixture(params=WORLDS)
def world(request):
    if request.param == "physics" and find_spec("mujoco") is None:
        pytest.skip("the extra `physics` is not installed")
    return request.param


@pytest.fixture
def mission():
    drive = {"radius_m": 0.2, "kinematics": "differential-drive"}
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 1.5 * k), **drive) for k in range(4))
    return Mission(robots=robots, tasks=tasks_of(OPENS_S))


def test_robots_wait_for_a_window_and_begin_together(world, mission):
    plan = muster.solve(mission, iterations=300)
    report = muster.simulate(mission, plan, world=world)
    judge(report.as_dict(), OPENS_S)
    assert report.contacts == 0


@pytest.mark.long(keep=1)
def test_a_team_reforms_when_a_member_fails_and_the_record_has_it_all(world, mission, tmp_path):
    pytest.importorskip("mcap")
    from muster.report.record import read_record

    plan = muster.solve(mission, iterations=300)
    failing = next(route.robot for route in plan.routes if route.tasks == ("lift",))
    disturbed = replace(mission, events=(Event(at_s=1.0, robot_fails=failing),))
    report = muster.simulate(disturbed, plan, world=world, record=tmp_path / "r.mcap")
    judge(report.as_dict(), OPENS_S)
    read = read_record(tmp_path / "r.mcap")
    assert read.complete
    assert read.mission == disturbed
    assert read.report == report.as_dict()
    begun = {event.data["task"]: event.data for event in read.events if event.kind == "starts"}
    assert len(set(begun["lift"]["team"]) - {failing}) == 2
    assert len(read.plans) == 2
