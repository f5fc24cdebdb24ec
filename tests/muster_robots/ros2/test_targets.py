"""uav_camera and target_localization on ROS 2, over DDS: each program a process, on this computer alone."""

import json
import math
from importlib.util import find_spec

import numpy as np
import pytest

pytest.importorskip("cyclonedds")
if find_spec("mujoco") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)

from muster.mission.errors import ParameterError
from muster.perception.camera import Intrinsics
from muster_physics.optional_parts import BACKENDS, _is_there
from muster_robots.ros2.message_types import Header, Pose, Time
from muster_robots.ros2.sensor_conversion import (
    camera_info_of,
    image_from,
    image_message,
    intrinsics_from,
    pose_matrix,
    scan_from,
    stamp_of,
)
from muster_robots.ros2.sensor_message_types import CameraInfo, Image, LaserScan, RegionOfInterest
from muster_robots.ros2.serialization import from_cdr, to_cdr

VGA = Intrinsics.of_view(320, 240, math.radians(60))
YARD = """
schema: muster/1
name: yard
robots:
  - {id: d_0, position: [0, 0, 3], kind: air, skills: [look], speed_mps: 2, yaw_rate_radps: 3,
     camera: {fov_deg: 60, tilt_deg: 60, mount: [0.1, 0, 0], width_px: 320, height_px: 240, rate_hz: 3}}
  - {id: r_0, position: [0, 4, 0], skills: [carry], speed_mps: 3, radius_m: 0.2}
tasks:
  - {id: look, position: [3, 0, 3], requires: [look], duration_s: 3}
tags:
  - {id: 7, position: [4.8, 0.3, 0], heading_deg: 40, size_m: 0.5}
found:
  - {becomes: {requires: [carry]}}
"""


@pytest.mark.long
@pytest.mark.skipif(not any(map(_is_there, BACKENDS.values())), reason="neither EGL nor OSMesa is installed")
def test_what_a_drone_sees_becomes_a_task_of_another_robot(simulated, start, tmp_path):
    (tmp_path / "yard.yaml").write_text(YARD, encoding="utf-8")
    simulated("d_0", 0, 0, "--kind", "air", "--height", 3)
    simulated("r_0", 0, 4)
    yard = str(tmp_path / "yard.yaml")
    start("-m", "muster_robots.cli.uav_camera", "d_0", "--mission", yard, "--ros", 2, "--by", "dds")
    quick = ("--by", "dds", "--time-limit", "0.3", "--format", "json")
    carried = start("-m", "muster.cli", "ros2", yard, *quick, "--find-targets")
    out, err = carried.communicate(timeout=60)
    assert carried.returncode == 0, err
    report = json.loads(out)
    assert set(report["tasks_done"]) == {"look", "found-7"}
    assert next(row["robot"] for row in report["tasks"] if row["task"] == "found-7") == "r_0"


@pytest.mark.parametrize(
    "message",
    [
        image_message(np.arange(24, dtype=np.uint8).reshape(2, 4, 3), "d_0/camera", 12.5),
        camera_info_of(VGA, "d_0/camera", 3.25),
        LaserScan(angle_min=-0.5, angle_increment=0.25, range_max=4.0, ranges=(1.0, 2.5, 0.5)),
        RegionOfInterest(1, 2, 3, 4, do_rectify=True),
    ],
    ids=lambda message: message.NAME,
)
def test_messages_are_what_ros_2_writes(message):
    """By the definitions of rosbags, which are those of ROS 2 Humble."""
    assert from_cdr(type(message), to_cdr(message)) == message


def test_messages_are_converted_there_and_back():
    image = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
    assert (image_from(image_message(image, "c", 0.0)) == image).all()
    assert (image_from(image_message(image[:, :, 0], "c", 0.0)) == image[:, :, 0]).all()
    assert intrinsics_from(camera_info_of(VGA, "c", 0.0)) == VGA
    ranges, bearings = scan_from(LaserScan(angle_min=0.1, angle_increment=0.2, range_max=4.0, ranges=(1.0, 9.0)))
    assert ranges.tolist() == [1.0, math.inf]
    assert bearings.tolist() == pytest.approx([0.1, 0.3])
    assert stamp_of(Header(stamp=Time.of(7.5))) == 7.5
    assert stamp_of(Header()) > 1e9  # no stamp: now
    assert pose_matrix(Pose()).tolist() == np.eye(4).tolist()
    with pytest.raises(ParameterError, match="K: all 0"):
        intrinsics_from(CameraInfo(width=2, height=2))
    with pytest.raises(ParameterError, match="encoding: yuv"):
        image_from(Image(encoding="yuv"))
