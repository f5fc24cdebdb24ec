"""The simulated robot of ROS 1 as a process of its own."""

import time

import pytest


@pytest.mark.long
def test_in_a_namespace_its_topics_frames_and_words_are_there(ros):
    heard = ros.listener("/team/r_0/odom=nav_msgs/Odometry", "/tf=tf2_msgs/TFMessage")
    robot = ros.robot("r_0", 2, 3, "--namespace", "team")
    until = time.monotonic() + 20
    while not all(topic in heard._file.read_text(encoding="utf-8") for topic in ('"/team/r_0/odom"', '"/tf"')):
        assert robot.poll() is None, robot.stderr.read()
        assert time.monotonic() < until
        time.sleep(0.05)
    said = heard.heard()
    places = [data["pose"]["pose"]["position"] for topic, data in said if topic == "/team/r_0/odom"]
    assert (places[-1]["x"], places[-1]["y"]) == (2.0, 3.0)
    assert "team/r_0/base_link" in {
        one["child_frame_id"] for topic, data in said if topic == "/tf" for one in data["transforms"]
    }


def test_a_bad_option_is_a_usage_line_and_exit_code_2(ros):
    robot = ros.robot("r_0", 2, 3, "--rate", "0")
    out, err = robot.communicate(timeout=20)
    assert (robot.returncode, out) == (2, "")
    assert "0.0 is not in the range 1<=x<=200" in err
