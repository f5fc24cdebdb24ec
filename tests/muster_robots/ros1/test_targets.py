"""The nodes uav_camera and target_localization (TCF, section 5.3.2), each a process, on a real ROS master."""

import json
import math
import time
from importlib.util import find_spec

import numpy as np
import pytest

if find_spec("mujoco") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)

from muster.perception.laser import Scanner
from muster_physics.optional_parts import BACKENDS, _is_there

if not any(map(_is_there, BACKENDS.values())):
    pytest.skip("neither EGL nor OSMesa is installed", allow_module_level=True)

QUICK = ("--time-limit", "0.2", "--format", "json", "-q")
YARD = """
schema: muster/1
name: yard
robots:
  - {id: d_0, position: [0, 0, 3], kind: air, kinematics: quadcopter, skills: [look], speed_mps: 2, yaw_rate_radps: 3,
     camera: {fov_deg: 60, tilt_deg: 60, mount: [0.1, 0, 0], width_px: 320, height_px: 240, rate_hz: 3}}
  - {id: r_0, position: [0, 4, 0], skills: [carry], speed_mps: 3, yaw_rate_radps: 6, kinematics: differential-drive,
     radius_m: 0.2}
tasks:
  - {id: look, position: [3, 0, 3], requires: [look], duration_s: 3}
tags:
  - {id: 7, position: [4.8, 0.3, 0], heading_deg: 40, size_m: 0.5}
found:
  - {becomes: {requires: [carry]}}
"""
CALIBRATION = """
image_width: 320
image_height: 240
camera_matrix: {rows: 3, cols: 3, data: [277.128, 0, 159.5, 0, 277.128, 119.5, 0, 0, 1]}
"""


@pytest.fixture(scope="module", autouse=True)
def _messages(rospy_there):
    pytest.importorskip("sensor_msgs", reason="python3-sensor-msgs is not installed")


def drone(ros):
    more = ("--kind", "air", "--kinematics", "quadcopter", "--speed", 2, "--yaw-rate", 3, "--height", 3)
    return ros.start("-m", "muster_robots.ros1.simulated_robot", "d_0", "--at", 0, 0, *more)


def camera(ros, *arguments):
    return ros.start("-m", "muster_robots.cli.uav_camera", "d_0", *arguments)


@pytest.mark.long
def test_what_a_drone_sees_becomes_a_task_of_another_robot_whose_laser_shows_obstacles(ros):
    """The rover's task is known to nobody until the drone's camera has seen the tag.

    Before that the rover, at (1, 2), heading north, sees a wall of 1 m two metres ahead of it.
    """
    (ros.folder / "yard.yaml").write_text(YARD, encoding="utf-8")
    drone(ros)
    ros.robot("r_0", 1, 2, "--heading", 90)
    seen = camera(ros, "--mission", "yard.yaml")
    topics = ("/target_localization/points", "/r_0/obstacles", "/muster/events")
    heard = ros.listener(
        *(f"{topic}=std_msgs/String" for topic in topics),
        "/d_0/camera/camera_info=sensor_msgs/CameraInfo",
        "/tf_static=tf2_msgs/TFMessage",
    )
    carried = ros.muster("yard.yaml", *QUICK, "--find-targets", "--locate", "size", "--on-start")
    user = ros.user()
    user.until(bool, publishers="/target_localization/points")
    scanner = Scanner(field_rad=math.pi, step_rad=math.radians(0.5))
    ranges = scanner.ranges((1.0, 2.0, math.pi / 2), np.array([[0.5, 4.0, 1.5, 4.0]]))
    until = time.monotonic() + 30
    while topics[1] not in {topic for topic, _ in heard.so_far()}:
        assert time.monotonic() < until
        user.do(scan="/r_0/scan", ranges=ranges.tolist(), first=scanner.bearings[0], step=math.radians(0.5))
    assert user.call("/command_interface/start")[0]
    out, err = carried.communicate(timeout=60)
    assert carried.returncode == 0, err
    assert set(json.loads(out)["tasks_done"]) == {"look", "found-7"}
    assert seen.poll() is None
    messages = heard.heard()
    seen_there = [json.loads(data["data"]) for topic, data in messages if topic == topics[1]]
    (wall,) = seen_there[-1]["obstacles"]
    assert wall["shape"] == "line"
    assert wall["position"] == pytest.approx([1.0, 4.0], abs=0.05)
    assert sorted(x for x, _ in wall["edges"]) == [pytest.approx(0.3, abs=0.06), pytest.approx(1.7, abs=0.06)]
    points = [json.loads(data["data"]) for topic, data in messages if topic == topics[0]][-1]
    assert [(row["tag"], row["task"], row["robots"]) for row in points] == [(7, "found-7", ["d_0"])]
    assert math.dist(points[0]["position"], (4.8, 0.3)) < 0.15
    assert np.linalg.eigvalsh(points[0]["covariance"]).min() > 0
    events = [json.loads(data["data"]) for topic, data in messages if topic == topics[2]]
    assert next(event["robot"] for event in events if event["kind"] == "ends" and event["task"] == "found-7") == "r_0"
    info = next(data for topic, data in messages if topic.endswith("camera_info"))
    assert info["K"][0] == pytest.approx(160 / math.tan(math.radians(30)))
    assert (info["K"][2], info["K"][5]) == (159.5, 119.5)
    frames = {
        one["child_frame_id"]: one for topic, data in messages if topic == "/tf_static" for one in data["transforms"]
    }
    mount = frames["d_0/camera"]["transform"]
    assert (frames["d_0/camera"]["header"]["frame_id"], mount["translation"]["x"]) == ("d_0/base_link", 0.1)


@pytest.mark.long
def test_images_from_files_are_published_with_their_calibration(ros):
    import cv2

    (ros.folder / "camera.yaml").write_text(CALIBRATION, encoding="utf-8")
    (ros.folder / "images").mkdir()
    for k in range(3):
        cv2.imwrite(str(ros.folder / "images" / f"{k}.png"), np.full((240, 320, 3), (0, 0, 50 * k), dtype=np.uint8))
    given = ("--images", "images", "--calibration", "camera.yaml", "--rate", 10, "--repeat")
    camera(ros, *given)
    user = ros.user()
    found = user.do(image="/d_0/camera/image_raw")
    assert (found["width"], found["height"], found["encoding"], found["frame"]) == (320, 240, "rgb8", "d_0/camera")
    assert found["first"] in ([0, 0, 0], [50, 0, 0], [100, 0, 0])


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    ("given", "said"),
    [
        ((), "expected either --mission"),
        (("--images", "images"), "--calibration: missing"),
        (("--mission", "yard.yaml", "--calibration", "camera.yaml"), "together with --images"),
        (("--mission", "6T-2R"), "d_0: no camera in 6T-2R"),
    ],
)
def test_wrong_options_of_a_camera_are_one_line(ros, given, said):
    started = camera(ros, *given)
    _, err = started.communicate(timeout=20)
    assert started.returncode == 2
    assert said in err
    assert err.count("\n") == 1
