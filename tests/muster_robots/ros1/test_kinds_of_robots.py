"""How robots say where they are: frames of tf, PoseStamped, in space, in a namespace; what they say of themselves."""

import json
import math

import pytest
from tests.muster_robots.ros1.conftest import own_words

from muster import load, solve
from muster.cli.exits import STILL_MOVING
from muster.cli.main import run
from muster.motion.frames import quaternion_rotation

ONE = """
schema: muster/1
robots: [{id: r_0, position: [0, 0], speed_mps: 3, yaw_rate_radps: 6, radius_m: 0.2, kinematics: differential-drive}]
tasks:
  - {id: t_1, position: [2, 0]}
  - {id: t_2, position: [2, 2]}
"""
IN_SPACE = """
schema: muster/1
robots:
  - {id: r_0, position: [0, 0, 0], speed_mps: 3, yaw_rate_radps: 6, radius_m: 0.2, kinematics: differential-drive}
  - {id: d_0, position: [0, 5, 1], kind: air, kinematics: quadcopter, speed_mps: 3, radius_m: 0.3, skills: [fly]}
tasks:
  - {id: t_1, position: [2, 0, 0], duration_s: 2}
  - {id: t_2, position: [2, 2, 0]}
  - {id: high, position: [2, 5, 3], requires: [fly]}
  - {id: low, position: [2, 7, 1.5], requires: [fly], duration_s: 4}
"""
QUICK = ("--time-limit", "0.2", "--format", "json")


@pytest.fixture
def one(tmp_path):
    (tmp_path / "m.yaml").write_text(ONE, encoding="utf-8")
    return "m.yaml"


def done(carried, code=0):
    """The tasks done, in order, and what was told."""
    out, err = carried.communicate(timeout=40)
    assert carried.returncode == code, err
    return json.loads(out)["tasks_done"], err


def places(heard, topic):
    """Where a robot said that it was."""
    poses = [data["pose"] for name, data in heard if name == topic]
    points = [(pose.get("pose") or pose)["position"] for pose in poses]
    return [(point["x"], point["y"], point["z"]) for point in points]


def nearest(points, place):
    return min(math.dist(point, place) for point in points)


@pytest.mark.long
def test_a_plan_is_carried_out_from_where_motion_capture_sees_robots_and_drawn_for_rviz(ros, tmp_path):
    """On the ground and in the air, as vrpn_client_ros does: poses on topics of its own, in any frame.

    The monitor hears them too.
    """
    pytest.importorskip("visualization_msgs", reason="python3-visualization-msgs is not installed")
    (tmp_path / "m.yaml").write_text(IN_SPACE, encoding="utf-8")
    plan = solve(load(tmp_path / "m.yaml"), "greedy").as_dict()
    route = next(route for route in plan["routes"] if route["robot"] == "r_0")
    route["tasks"] = ["t_1", "t_2"]  # from where it stands the other way round would be shorter
    (tmp_path / "plan.json").write_text(json.dumps(plan), encoding="utf-8")
    seen = "/vrpn_client_node/{}/pose".format
    ros.start(ros.file("robot.py"), "r_0", 1, 3, "pose", f"topic={seen('r_0')}", "frame=r_0/odom", "tied")
    ros.start(ros.file("robot.py"), "d_0", 0, 5, "pose", f"topic={seen('d_0')}", "up=1")
    listener = ros.listener(
        *(f"{seen(name)}=geometry_msgs/PoseStamped" for name in ("r_0", "d_0")),
        "/r_0/status=std_msgs/String",
        "/muster/markers=visualization_msgs/MarkerArray",
    )
    asked = ("--plan", "plan.json", "--poses", seen("{robot}"), "--markers")
    tasks, err = done(ros.muster("m.yaml", *QUICK, *asked), STILL_MOVING)
    assert set(tasks) == {"t_1", "t_2", "high", "low"}
    assert tasks.index("t_1") < tasks.index("t_2")
    (begins,) = [line for line in err.splitlines() if "begins at" in line]  # the drone stands where the mission says
    assert begins == "robot r_0 begins at (1.00, 3.00, 0.00), where it stands, not at (0.00, 0.00, 0.00): 3.16 m away"
    assert "d_0: hovers; at (" in err
    heard = listener.heard()
    flown = places(heard, seen("d_0"))
    assert max(nearest(flown, (2, 5, 3)), nearest(flown, (2, 7, 1.5))) < 0.15
    said = places(heard, seen("r_0"))
    assert nearest(said, (2 * 0 + 5, 10 - 2, 0)) < 0.15  # t_1, seen from its own frame
    assert nearest(said, (2 + 5, 10 - 2, 0)) < 0.15
    rows = [json.loads(data["data"]) for topic, data in heard if topic == "/r_0/status"]
    watched = [row["position"] for row in rows if row["position"] is not None]
    assert nearest(watched, (2, 2, 0)) < 0.15  # in the map
    assert max(row["usage_m"] for row in rows) > 1.0  # tasks last so long that a monitor that comes late hears it too

    drawn = [data["markers"] for topic, data in heard if topic == "/muster/markers"]
    first, last = ([marker for marker in some if marker["action"] == 0] for some in (drawn[1], drawn[-1]))
    assert all(marker["header"]["frame_id"] == "map" for marker in first)
    assert [m["text"] for m in first if m["ns"] == "names"] == ["t_1", "t_2", "high", "low", "r_0", "d_0"]
    spheres = [tuple(m["pose"]["position"].values()) for m in first if m["ns"] == "tasks"]
    assert spheres == [(2, 0, 0), (2, 2, 0), (2, 5, 3), (2, 7, 1.5)]
    routes = [[tuple(p.values())[:2] for p in marker["points"]] for marker in first if marker["ns"] == "routes"]
    assert [(2.0, 0.0), (2.0, 2.0)] in [route[1:] for route in routes]
    (begun, *_), ended = ([m["color"]["g"] for m in some if m["ns"] == "tasks"] for some in (first, last))
    assert set(ended) == {ended[0]} != {begun}  # all are done at the end


@pytest.mark.long
def test_a_robot_in_a_namespace_may_say_nothing_but_where_it_is_from_its_start(ros, tmp_path):
    """(4.2)-(4.4) of [tcf-thesis]: team/r_0/odom is tied to the map by the start in the mission alone.

    Steered by the method that is asked for: the thesis' node RVO_planner.
    """
    (tmp_path / "m.yaml").write_text(
        ONE.replace("[0, 0]", "[10, -5], heading_deg: 90, camera: {fov_deg: 60, tilt_deg: 30, mount: [0.1, 0, 0.2]}")
        .replace("[2, 0]", "[12, -5]")
        .replace("[2, 2]", "[12, -3]"),
        "utf-8",
    )
    ros.start(ros.file("robot.py"), "r_0", 10, -5, "namespace=team", "pose", "frame=team/r_0/odom")
    ros.start(ros.file("robot.py"), "r_9", 11, -4)
    listener = ros.listener(
        "/team/r_0/pose=geometry_msgs/PoseStamped",
        "/team/r_0/task_sequence=std_msgs/String",
        "/r_9/cmd_vel=geometry_msgs/Twist",
        "/muster/events=std_msgs/String",
        "/tf_static=tf2_msgs/TFMessage",
    )
    asked = ("--namespace", "team", "--odometry", "start", "--avoidance", "rvo", "--allocator", "greedy")
    tasks, err = done(ros.muster("m.yaml", *QUICK, *asked))
    assert set(tasks) == {"t_1", "t_2"}
    assert "begins at" not in err
    heard = listener.heard()
    said = places(heard, "/team/r_0/pose")
    assert nearest(said, (0, -2, 0)) < 0.15  # t_1, two metres to the right of the start
    assert nearest(said, (2, -2, 0)) < 0.15
    told = [json.loads(data["data"]) for topic, data in heard if topic == "/team/r_0/task_sequence"]
    assert any(set(tasks) == {"t_1", "t_2"} for tasks in told)
    assert not [topic for topic, _ in heard if topic == "/r_9/cmd_vel"]  # outside the namespace: it does not join
    assert "robot_joins" not in [json.loads(data["data"])["kind"] for topic, data in heard if topic == "/muster/events"]
    frames = {
        one["child_frame_id"]: one for topic, data in heard if topic == "/tf_static" for one in data["transforms"]
    }
    start = frames["team/r_0/odom"]
    assert start["header"]["frame_id"] == "map"
    assert start["transform"]["translation"] == {"x": 10.0, "y": -5.0, "z": 0.0}
    camera = frames["muster/r_0/camera"]
    assert camera["header"]["frame_id"] == "muster/r_0"
    assert camera["transform"]["translation"] == {"x": 0.1, "y": 0.0, "z": 0.2}
    turn = [camera["transform"]["rotation"][axis] for axis in "xyzw"]
    ahead = quaternion_rotation(turn)[:, 2]  # where the camera looks, in the body: 30 degrees down
    assert ahead == pytest.approx([math.cos(math.radians(30)), 0.0, -0.5], abs=1e-6)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--avoidance", "rvo", "--drive", "goals"), "avoidance: rvo; expected auto with drive goals: robots find"),
        (("--poses", "/vrpn/r_0/pose"), "expected a topic such as /vrpn_client_node/{robot}/pose"),
    ],
)
def test_options_that_cannot_be_meant_are_one_line(rospy_there, one, monkeypatch, tmp_path, capsys, options, said):
    monkeypatch.chdir(tmp_path)
    assert run(["ros", one, *QUICK, *options]) == 2
    err = capsys.readouterr().err
    assert said in err
    assert err.count("\n") == 1


@pytest.mark.long
def test_robots_that_nobody_commands_are_told_nothing(own_ros, tmp_path):
    """A stranger and a robot of the mission, driven by hand while another of the mission's is waited for in vain.

    For who is driven by goals see test_fleet.
    """
    (tmp_path / "m.yaml").write_text(ONE.replace("robots: [", "robots: [{id: r_1, position: [5, 5]}, "), "utf-8")
    own_ros.start(own_ros.file("robot.py"), "r_1", 5, 5, "frame=lost")
    moved = ("joy", "r_0")
    for k, name in enumerate(moved):
        own_ros.start(own_ros.file("robot.py"), name, 0, k, "by_hand=2.0")
    listener = own_ros.listener(
        *(f"/{name}/cmd_vel=geometry_msgs/Twist" for name in moved),
        *(f"/{name}/WP=geometry_msgs/PoseStamped" for name in moved),
        *(f"/{name}/odom=nav_msgs/Odometry" for name in moved),
        "/tf=tf2_msgs/TFMessage",
    )
    carried = own_ros.muster("m.yaml", "--wait", "2")
    out, err = carried.communicate(timeout=30)
    assert (carried.returncode, out) == (2, "")
    expected = "tf from map to lost, or a pose in map, or --odometry start"
    said = f"robot r_1: /r_1/odom is in frame lost, which tf does not tie to map within 2 s; expected {expected}\n"
    assert own_words(err) == said
    heard = listener.heard()
    met = {one["child_frame_id"] for topic, data in heard if topic == "/tf" for one in data["transforms"]}
    assert {"muster/joy", "muster/r_0"} <= met
    for name in moved:
        assert max(x for x, _, _ in places(heard, f"/{name}/odom")) > 2
    assert [topic for topic, _ in heard if topic.endswith(("cmd_vel", "WP"))] == []
