"""Robots keep the greatest speed of a lane, and slow down before it begins."""

from importlib.util import find_spec

import numpy as np
import pytest
from tests.running.lane_runs import carried_out

from muster import load, simulate, solve

SLOW_MPS, FROM_M, TO_M = 0.25, 3.0, 8.0
SITE = """
schema: muster/1
name: a slow lane
rules: {objective: makespan, usage: time, return_to_start: false}
robots:
  - {id: a, position: [0, 0], radius_m: 0.3, kinematics: KINEMATICS}
  - {id: b, position: [-1, 0], radius_m: 0.3, kinematics: KINEMATICS}
tasks:
  - {id: far, position: [12, 0], duration_s: 1}
  - {id: amid, position: [6.3, 0], duration_s: 1}
lanes:
  nodes: {w: [-1, 0], m: [3, 0], n: [8, 0], e: [12, 0]}
  edges: [{from: w, to: m, both_ways: true}, {from: m, to: n, both_ways: true, speed_mps: 0.25},
    {from: n, to: e, both_ways: true}]
"""


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive"])
@pytest.mark.parametrize("world", ["kinematic", "physics"])
def test_nobody_is_faster_on_a_lane_than_it_allows(world, kinematics, tmp_path):
    if world == "physics" and find_spec("mujoco") is None:  # not imported here: first it must be said how it draws
        pytest.skip("the extra `physics` is not installed")
    report, poses = carried_out(SITE.replace("KINEMATICS", kinematics), tmp_path, 100.0, world)
    assert len(report.tasks_done) == 2
    times, x = np.array([now for now, _ in poses.steps]), np.array([places[:, 0] for _, places in poses.steps])
    speeds_mps = np.abs(np.diff(x, axis=0)) / np.diff(times)[:, None]
    margin_m = 0.05
    inside = (x[:-1] > FROM_M + margin_m) & (x[:-1] < TO_M - margin_m)
    assert speeds_mps[inside].max() == pytest.approx(SLOW_MPS, rel=0.05)
    assert speeds_mps[~inside].max() > 0.9


def test_the_time_with_traffic_counts_slow_lanes(tmp_path):
    path = tmp_path / "lane.yaml"
    path.write_text(SITE.replace("KINEMATICS", "holonomic"))
    mission = load(path)
    plan = solve(mission, "search", time_limit=0.2)
    report = simulate(mission, plan, traffic="reserve")
    assert plan.time_with_traffic_s == pytest.approx(report.mission_time_s, rel=0.1)
