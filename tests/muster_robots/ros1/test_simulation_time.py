"""Where `/use_sim_time` is set the mission goes by /clock, be it slow, standing, set back, or fast."""

import json
from itertools import pairwise

import pytest
from tests.muster_robots.ros1.conftest import own_words

MISSION = """
schema: muster/1
robots: [{id: r_0, position: [0, 0], speed_mps: 3, yaw_rate_radps: 6, kinematics: differential-drive}]
tasks:
  - {id: t_1, position: [2, 0]}
  - {id: t_2, position: [6, 0], duration_s: 1}
  - {id: t_3, position: [7, 0]}
"""


@pytest.fixture
def simulated(own_ros, tmp_path):
    (tmp_path / "m.yaml").write_text(MISSION, encoding="utf-8")
    own_ros.set("/use_sim_time", True)
    return own_ros


def carried_out(ros):
    """The report, and the events, each with what /clock said when it was heard, and robots' odometry."""
    ros.robot("r_0", 0, 0, "--speed", 3)
    topics = ("/clock=rosgraph_msgs/Clock", "/muster/events=std_msgs/String", "/r_0/odom=nav_msgs/Odometry")
    listener = ros.listener(*topics)
    carried = ros.muster("m.yaml", "--time-limit", "0.2", "--format", "json")
    out, err = carried.communicate(timeout=60)
    assert carried.returncode == 0, err
    clock, events, odometry = 0.0, [], []
    for topic, data in listener.heard():
        if topic == "/clock":
            clock = data["clock"]
        elif topic == "/muster/events":
            events.append((clock, json.loads(data["data"])))
        else:
            odometry.append((data["header"]["stamp"], data["pose"]["pose"]["position"]["x"]))
    return json.loads(out), events, odometry


@pytest.mark.long
def test_a_slow_clock_that_stands_and_is_set_back_takes_no_time_back_and_then_a_fast_one_is_gone_by(simulated):
    times = 4.0
    simulated.start(simulated.file("clock.py"), 0.8, 1.0, times)
    report, events, odometry = carried_out(simulated)
    assert report["tasks_done"] == ["t_1", "t_2", "t_3"]
    assert not [event for _, event in events if event["kind"] in ("robot_silent", "robot_stuck")]
    assert all(one["time_s"] <= next_one["time_s"] for (_, one), (_, next_one) in pairwise(events))
    (set_back,) = [k for k, ((before, _), (after, _)) in enumerate(pairwise(events), 1) if after < before]  # under way

    (first, begin), (last, end) = events[set_back], events[-1]
    assert end["time_s"] - begin["time_s"] == pytest.approx(last - first, abs=0.3 * times)
    assert report["ends_s"]["t_2"] - report["starts_s"]["t_2"] >= 1.0
    fast = [(stamp, x) for stamp, x in odometry if stamp < 1000.0 and 2.5 < x < 5.0]
    (early, west), (late, east) = fast[0], fast[-1]
    assert 0.5 < (east - west) / (late - early) <= 3.0 * 1.1  # it is as fast as it can be, by that clock


@pytest.mark.long
def test_no_clock_is_one_line(simulated):
    carried = simulated.muster("m.yaml", "--wait", "0.5")
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (2, "")
    said = "robot r_0: /use_sim_time is set, and nothing is on /clock within 0.5 s; expected its pose\n"
    assert own_words(err) == said
