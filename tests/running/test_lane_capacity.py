"""No more robots are on a lane at once than its capacity says, also where ways are planned all at once."""

import numpy as np
import pytest
from tests.running.lane_runs import carried_out

from muster.traffic.journeys import roadmap_plan

LOOP = """
schema: muster/1
name: a lane for few
rules: {return_to_start: false}
lanes:
  nodes: {w: [0, 0], e: [12, 0], f: [12, 8], g: [0, 8]}
  edges:
    - {from: w, to: e, capacity: CAPACITY, speed_mps: 0.5}
    - {from: e, to: f}
    - {from: f, to: g}
    - {from: g, to: w}
robots:
  - {id: a, position: [2, 8], radius_m: 0.3}
  - {id: b, position: [4, 8], radius_m: 0.3}
  - {id: c, position: [6, 8], radius_m: 0.3}
  - {id: d, position: [8, 8], radius_m: 0.3}
tasks:
  - {id: past, position: [12, 6], only_robots: [a], duration_s: 1}
  - {id: first, position: [10, 0], only_robots: [b], duration_s: 5}
  - {id: second, position: [6, 0], only_robots: [c], duration_s: 5}
  - {id: third, position: [2, 0], only_robots: [d], duration_s: 5}
  - {id: out_b, position: [12, 5], only_robots: [b], prerequisites: [first]}
  - {id: out_c, position: [12, 4], only_robots: [c], prerequisites: [second]}
  - {id: out_d, position: [12, 3], only_robots: [d], prerequisites: [third]}
"""
FROM_M, TO_M, ASIDE_M = 0.1, 11.9, 0.05


def most_between(poses):
    places = np.array([places for _, places in poses.steps])
    inside = (places[..., 0] > FROM_M) & (places[..., 0] < TO_M) & (np.abs(places[..., 1]) < ASIDE_M)
    return inside.sum(axis=1).max()


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("at_once", [True, False])
@pytest.mark.parametrize("capacity", [1, 2])
def test_a_lane_is_left_before_one_too_many_enters_it(capacity, at_once, tmp_path, monkeypatch):
    """As many stop to work on the lane as are in the mission: the planner lets them come one after the other."""
    if at_once:
        monkeypatch.setattr(roadmap_plan, "_MOST_BY_INTERVALS", 0)
    report, poses = carried_out(LOOP.replace("CAPACITY", str(capacity)), tmp_path, 300.0)
    assert len(report.tasks_done) == 7
    assert most_between(poses) == capacity
