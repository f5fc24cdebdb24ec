"""Lanes that close: who is on one goes on to its end, and nobody else drives onto it."""

import numpy as np
import pytest
from tests.running.lane_runs import carried_out

SQUARE = """
schema: muster/1
name: a lane closes
rules: {return_to_start: false}
lanes:
  nodes: {a: [0, 0], b: [8, 0], c: [8, 6], d: [0, 6], aside: [-4, 6]}
  edges:
    - {from: a, to: b, id: ab, LANE}
    - {from: b, to: c, both_ways: true}
    - {from: c, to: d, both_ways: true}
    - {from: d, to: a, both_ways: true}
    - {from: d, to: aside, both_ways: true}
robots:
  - {id: r, position: [0, 0], radius_m: 0.3, kinematics: KINEMATICS}
  - {id: q, position: [0, 6], radius_m: 0.3, kinematics: KINEMATICS}
tasks:
  - {id: t, position: [8, 0], only_robots: [r]}
  - {id: u, position: [8, 3], only_robots: [q]}
  - {id: v, position: [0, 3], only_robots: [q], prerequisites: [u]}
events: [{at_s: CLOSES, door_closes: ab}]
"""


def places(site, lane, closes_s, kinematics, tmp_path):
    """When all robots are where, (n, robots, 2), until all is done."""
    text = site.replace("LANE", lane).replace("CLOSES", str(closes_s)).replace("KINEMATICS", kinematics)
    _, poses = carried_out(text, tmp_path, 120.0)
    times = np.array([now for now, _ in poses.steps])
    return times, np.array([places[:, :2] for _, places in poses.steps])


@pytest.mark.long(keep=5)
@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive"])
@pytest.mark.parametrize("closes_s", [1, 3, 6])
@pytest.mark.parametrize("lane", ["both_ways: true", "both_ways: false", "capacity: 1"])
def test_who_is_on_a_lane_that_closes_goes_on_to_its_end(lane, closes_s, kinematics, tmp_path):
    times, at = places(SQUARE, lane, closes_s, kinematics, tmp_path)
    assert times[np.argmax(at[:, 0, 0] > 7.95)] < 12.0
    assert np.abs(at[:, 0, 1]).max() < 0.01
    between = (at[:, 1, 0] > 0.1) & (at[:, 1, 0] < 7.9) & (np.abs(at[:, 1, 1]) < 0.3)
    assert not between.any()


@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive"])
def test_who_was_let_go_onto_a_lane_that_closes_stops_and_goes_round(kinematics, tmp_path):
    """It keeps to the lanes when it turns back."""
    site = SQUARE.replace("[0, 0], radius", "[0, 2.5], radius").replace("[0, 6], radius", "[-4, 6], radius")
    site = site.replace("[8, 3]", "[-2, 6]").replace("[0, 3]", "[-4, 6]")
    _, at = places(site, "both_ways: true", 1.5, kinematics, tmp_path)
    x, y = at[:, 0].T
    assert not ((x > 0.1) & (x < 7.9) & (y < 5.9)).any()
    assert np.minimum.reduce([np.abs(x), np.abs(8 - x), np.abs(y), np.abs(6 - y)]).max() < 0.01
