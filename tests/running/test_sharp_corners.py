"""Robots get round sharp corners of one-way lanes one behind the other."""

import pytest

from muster import load, simulate, solve

SITE = """
schema: muster/1
name: sharp corners
lanes:
  nodes: {dock: [0, 0], gate: [5, 0], rack_1: [9, 3], rack_2: [9, -3]}
  edges:
    - {from: dock, to: gate, both_ways: true}
    - {from: gate, to: rack_1}
    - {from: rack_1, to: rack_2, capacity: 1, speed_mps: 0.5}
    - {from: rack_2, to: gate}
robots:
  - {id: r_0, position: [0, 0], radius_m: 0.3, kinematics: KINEMATICS}
  - {id: r_1, position: [2, 0], radius_m: 0.3, kinematics: KINEMATICS}
tasks: [{id: 1, position: [9, 3], only_robots: [r_1]}, {id: 2, position: [9, -3], only_robots: [r_0]}]
"""


@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive"])
def test_who_waits_before_a_sharp_corner_lets_out_who_is_in_it(kinematics, tmp_path):
    path = tmp_path / "corners.yaml"
    path.write_text(SITE.replace("KINEMATICS", kinematics))
    mission = load(path)
    report = simulate(mission, solve(mission, "greedy"))
    assert (len(report.tasks_done), report.contacts) == (2, 0)
    assert report.mission_time_s < 60.0
