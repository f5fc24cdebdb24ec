"""Doors close and open while a mission is carried out: robots go round or wait, and enter none that is closed."""

from importlib.util import find_spec

import numpy as np
import pytest
from tests.disturbances.traffic.verdicts import Poses
from tests.running.test_live import WorldAsFleet

from muster import MissionError, ParameterError, Simulation, load, solve
from muster.cli.main import run
from muster.mission.model import Event
from muster.running.live import Live, carry_out_live
from muster.state.recovery import recovered_from

SITE = """
schema: muster/1
name: two rooms
rules: {{travel: map, objective: makespan, usage: time, return_to_start: {returns}}}
map:
  boundary: [[0, 0], [12, 0], [12, 8], [0, 8]]
  zones:
    - {{polygon: [[5.8, 1.2], [6.2, 1.2], [6.2, 6.8], [5.8, 6.8]]}}
    - {{id: south, polygon: [[5.8, 0], [6.2, 0], [6.2, 1.2], [5.8, 1.2]], open: true}}
    - {{id: north, polygon: [[5.8, 6.8], [6.2, 6.8], [6.2, 8], [5.8, 8]], open: {north}}}
robots:
  - {{id: a, position: [2, 2], radius_m: 0.3, kinematics: {kinematics}}}
  - {{id: b, position: [2, 4], radius_m: 0.3, kinematics: {kinematics}}}
tasks:
  - {{id: far, position: [10, 2], duration_s: 2}}
  - {{id: near, position: [3, 6], duration_s: 2}}
events: {events}
"""
SOUTH, NORTH = (5.8, 6.2, 0.0, 1.2), (5.8, 6.2, 6.8, 8.0)


def site(tmp_path, events="[]", *, north="true", returns="false", kinematics="holonomic"):
    path = tmp_path / "site.yaml"
    path.write_text(SITE.format(events=events, north=north, returns=returns, kinematics=kinematics))
    return load(path)


def carried_out(mission, *, traffic="reserve", world="kinematic", until_s=300.0):
    poses = Poses()
    simulation = Simulation(mission, solve(mission, "greedy"), traffic=traffic, world=world, recorder=poses)
    while not simulation.done:
        simulation.advance(simulation.time_s + 5.0)
        assert simulation.time_s < until_s
    return simulation.result(), poses


def entered(poses, door, after_s=0.0):
    """When a robot's body was first in a door."""
    left, right, low, high = door
    for now, places in poses.steps:
        x, y = places.T
        if now >= after_s and ((x > left) & (x < right) & (y > low) & (y < high)).any():
            return now
    return np.inf


@pytest.mark.parametrize("traffic", ["reserve", "free"])
def test_robots_go_round_a_door_that_closes(traffic, tmp_path):
    report, poses = carried_out(site(tmp_path, "[{at_s: 2, door_closes: south}]"), traffic=traffic)
    assert (len(report.tasks_done), report.contacts) == (2, 0)
    assert entered(poses, SOUTH) == np.inf
    assert entered(poses, NORTH) < np.inf


@pytest.mark.parametrize("traffic", ["reserve", "free"])
def test_tasks_behind_a_closed_door_wait_until_it_opens(traffic, tmp_path):
    events = "[{at_s: 1, door_closes: south}, {at_s: 40, door_opens: south}]"
    report, poses = carried_out(site(tmp_path, events, north="false"), traffic=traffic)
    assert (len(report.tasks_done), report.contacts) == (2, 0)
    assert 40 < entered(poses, SOUTH) < 60


@pytest.mark.parametrize("traffic", ["reserve", "free"])
def test_what_lies_behind_a_door_that_stays_closed_is_lost_with_its_reason(traffic, tmp_path):
    report, poses = carried_out(site(tmp_path, "[{at_s: 1, door_closes: south}]", north="false"), traffic=traffic)
    assert report.tasks_done == ("near",)
    ((task, reason),) = report.tasks_lost
    assert (task, reason.startswith("unreachable")) == ("far", True)
    assert entered(poses, SOUTH) == np.inf


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("traffic", ["reserve", "free"])
@pytest.mark.parametrize("closes_s", [9.5, 10.5, 11.5])
def test_who_works_when_a_door_closes_goes_another_way_afterwards(closes_s, traffic, tmp_path):
    events = f"[{{at_s: {closes_s}, door_closes: south}}]"
    report, poses = carried_out(site(tmp_path, events, returns="true"), traffic=traffic)
    assert (len(report.tasks_done), report.contacts) == (2, 0)
    assert entered(poses, SOUTH, after_s=closes_s + 1.5) == np.inf
    assert np.hypot(*(poses.steps[-1][1] - [(2, 2), (2, 4)]).T).max() < 0.1


@pytest.mark.parametrize("traffic", ["reserve", "free"])
def test_who_is_shut_out_of_its_end_goes_there_when_the_door_opens(traffic, tmp_path):
    events = "[{at_s: 13, door_closes: south}, {at_s: 60, door_opens: south}]"
    report, poses = carried_out(site(tmp_path, events, north="false", returns="true"), traffic=traffic)
    assert (len(report.tasks_done), report.contacts) == (2, 0)
    assert entered(poses, SOUTH, after_s=14.0) > 60
    assert np.hypot(*(poses.steps[-1][1] - [(2, 2), (2, 4)]).T).max() < 0.1


def test_a_door_closes_when_nobody_is_in_it(tmp_path):
    mission = site(tmp_path, north="false")
    simulation = Simulation(mission, solve(mission, "greedy"), traffic="free")
    while not (simulation.world.positions[:, 0] > 5.7).any():
        simulation.advance(simulation.time_s + 0.1)
    simulation.report(Event(at_s=0, door_closes="south"))
    while not simulation.done:
        simulation.advance(simulation.time_s + 5.0)
        assert simulation.time_s < 120
    assert set(simulation.result().tasks_done) == {"near", "far"}  # it went on and out


@pytest.mark.long
def test_in_the_physics_world_a_door_is_a_wall_while_it_is_closed(tmp_path):
    if find_spec("mujoco") is None:  # not imported here: first it must be said how it draws
        pytest.skip("the extra `physics` is not installed")
    events = "[{at_s: 1, door_closes: south}, {at_s: 15, door_opens: south}]"
    report, poses = carried_out(site(tmp_path, events, north="false"), world="physics")
    assert (len(report.tasks_done), report.contacts) == (2, 0)
    assert 15 < entered(poses, SOUTH) < 40


def test_a_lane_is_a_door_too(tmp_path):
    path = tmp_path / "lanes.yaml"
    path.write_text("""
schema: muster/1
name: lanes
robots: [{id: a, position: [0, 0], radius_m: 0.3}, {id: b, position: [0, -3], radius_m: 0.3}]
tasks: [{id: t, position: [10, 0], duration_s: 1, only_robots: [a]}]
lanes:
  nodes: {w: [0, 0], e: [10, 0], n: [5, 4], s: [0, -3]}
  edges:
    - {id: straight, from: w, to: e, both_ways: true}
    - {from: w, to: n, both_ways: true}
    - {from: n, to: e, both_ways: true}
    - {from: s, to: w, both_ways: true}
events: [{at_s: 0, door_closes: straight}]
""")
    report, poses = carried_out(load(path))
    assert report.tasks_done == ("t",)
    assert max(places[0, 1] for _, places in poses.steps) > 3


def test_events_of_doors_name_a_door(tmp_path):
    with pytest.raises(MissionError, match='door_closes: "sout"; expected the id of a door; did you mean'):
        site(tmp_path, "[{at_s: 1, door_closes: sout}]")
    mission = site(tmp_path)
    simulation = Simulation(mission, solve(mission, "greedy"))
    with pytest.raises(ParameterError, match='door_opens: "west"; expected north or south'):
        simulation.report(Event(at_s=0, door_opens="west"))
    path = tmp_path / "no_id.yaml"
    path.write_text((tmp_path / "site.yaml").read_text().replace("id: south, ", ""))
    with pytest.raises(MissionError, match="an id beside open: true"):
        load(path)


def test_check_says_that_events_open_doors(tmp_path, capsys):
    site(tmp_path, "[{at_s: 1, door_opens: north}]", north="false")
    path = tmp_path / "site.yaml"
    path.write_text(path.read_text().replace(", open: true", ""))
    assert run(["check", str(path)]) == 0
    said = capsys.readouterr().out
    assert "1 task that can never be done" in said
    assert "with doors as they are at first; events open north" in said


def test_without_a_centre_doors_are_refused(tmp_path, capsys):
    site(tmp_path, "[{at_s: 1, door_closes: south}]")
    assert run(["simulate", str(tmp_path / "site.yaml"), "--negotiate"]) == 2
    assert "door south; expected none without a centre" in capsys.readouterr().err


@pytest.mark.parametrize("traffic", ["reserve", "free"])
def test_real_robots_get_other_ways(traffic, tmp_path):
    mission = site(tmp_path, "[{at_s: 2, door_closes: south}]")
    fleet = WorldAsFleet(mission)  # whose walls do not change
    poses = Poses()
    report = carry_out_live(mission, solve(mission, "greedy"), fleet, traffic=traffic, recorder=poses)
    assert len(report.tasks_done) == 2
    assert entered(poses, SOUTH) == np.inf


def test_a_run_that_goes_on_after_a_crash_knows_which_doors_are_closed(tmp_path):
    mission = site(tmp_path)
    log = [
        {"time_s": 1.0, "kind": "door_closes", "data": {"door": "south"}},
        {"time_s": 2.0, "kind": "door_closes", "data": {"door": "north"}},
        {"time_s": 3.0, "kind": "door_opens", "data": {"door": "north"}},
    ]
    state = recovered_from(mission, solve(mission, "greedy"), log)
    assert state.doors.closed == {"south"}
    fleet, poses = WorldAsFleet(mission), Poses()
    live = Live(mission, solve(mission, "greedy"), fleet, state=state, recorder=poses)
    while not live.done:
        live.look()
        live.hear(live.time_s + 0.2)
        assert live.time_s < 120
    assert len(live.result().tasks_done) == 2
    assert entered(poses, SOUTH) == np.inf
