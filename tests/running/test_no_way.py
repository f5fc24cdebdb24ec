"""What stands in the way for good, and places to which no way leads: robots find out, and say so."""

from dataclasses import replace

import pytest
from tests.disturbances.traffic.verdicts import Poses

from muster import Simulation, load, solve

HALL = """
schema: muster/1
name: hall
rules: {objective: makespan, usage: time, return_to_start: false}
robots:
  - {id: a, position: [0, 0], radius_m: 0.3, kinematics: KINEMATICS}
  - {id: b, position: [4, 0.1], radius_m: 0.3, kinematics: KINEMATICS}
tasks: [{id: there, position: [4, 0], only_robots: [a]}]
"""
LANES = """
schema: muster/1
name: no way back
rules: {objective: makespan, usage: time, return_to_start: true}
robots:
  - {id: a, position: [0, 0], radius_m: 0.3}
  - {id: b, position: [4, 0], radius_m: 0.3}
tasks: [{id: sink, position: [8, 0], only_robots: [b]}, {id: source, position: [0, 4], only_robots: [a]}]
lanes:
  nodes: {m: [0, 0], n: [4, 0], sink: [8, 0], source: [0, 4]}
  edges: [{from: m, to: n, both_ways: true}, {from: n, to: sink}, {from: source, to: m}]
"""


def loaded(text, tmp_path, kinematics="holonomic"):
    path = tmp_path / "mission.yaml"
    path.write_text(text.replace("KINEMATICS", kinematics))
    return load(path)


@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive"])
def test_one_that_stands_at_a_task_and_cannot_be_moved_is_found_out(kinematics, tmp_path):
    mission, poses = loaded(HALL, tmp_path, kinematics), Poses()
    simulation = Simulation(mission, solve(mission, "greedy"), recorder=poses)
    simulation.world.slow("b", 1e-6)
    while not simulation.done:
        simulation.advance(simulation.time_s + 5.0)
        assert simulation.time_s < 250.0
    ((task, reason),) = simulation.result().tasks_lost
    assert (task, reason.split(" (")[0]) == ("there", "unreachable: b stands there, out")
    kinds = [kind for _, kind, data in poses.events if data.get("robot") == "b"]
    assert kinds.index("robot_makes_room") < kinds.index("robot_sent_again") < kinds.index("robot_stuck")


def test_where_lanes_lead_to_nowhere_or_not_back_no_plan_goes_and_no_robot(tmp_path):
    mission = loaded(LANES, tmp_path)
    plan = solve(mission, "greedy")
    assert {left.task for left in plan.unassigned} == {"sink", "source"}
    assert {reason.reason for left in plan.unassigned for reason in left.reasons} == {"unreachable", "lock"}
    straight = replace(mission, rules=replace(mission.rules, travel="euclidean"))
    simulation = Simulation(mission, solve(straight, "greedy"))
    while not simulation.done:
        simulation.advance(simulation.time_s + 5.0)
        assert simulation.time_s < 60.0
    lost = {task: reason.split(": ")[0] for task, reason in simulation.result().tasks_lost}
    assert lost == {"sink": "unreachable", "source": "unreachable"}
