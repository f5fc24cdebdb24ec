"""The fleet on rclpy and Nav2, against a small fake of both: there is no ROS 2 here."""

import sys
import threading

import pytest
from tests.muster_robots.ros2 import fake_rclpy

from muster.mission.errors import MissingExtraError, NetworkError, ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Route
from muster.motion.port import Waypoint
from muster.running.live import carry_out_live
from muster_robots.fleet_settings import Ros2Settings
from muster_robots.ros2.description import from_foreign, to_foreign
from muster_robots.ros2.fleet import Ros2Fleet
from muster_robots.ros2.message_types import MESSAGES, Odometry, Path, Point, Pose, PoseStamped, String
from muster_robots.ros2.open_middleware import open_middleware
from muster_robots.ros2.rclpy_middleware import RclpyMiddleware, _class_of


@pytest.fixture
def graph(monkeypatch):
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    return fake_rclpy.install(monkeypatch)


def mission(*ids, tasks=((2.0, 0.0), (2.0, 1.5))):
    robots = tuple(Robot(id=name, position=(0.0, 3.0 * k)) for k, name in enumerate(ids))
    return Mission(robots=robots, tasks=tuple(Task(id=f"t_{k}", position=at) for k, at in enumerate(tasks)))


def navigated(there):
    fleet = Ros2Fleet(there, Ros2Settings(give="nav2"), middleware=RclpyMiddleware())
    until(fleet, lambda: not fleet.robots_not_ready())
    return fleet


def until(fleet, true, most_s=10.0):
    end = fleet.time_s + most_s
    while not true():
        assert fleet.time_s < end, "this did not come about"
        fleet.advance(fleet.time_s + 0.05)


def plan(**routes):
    return Plan(mission=None, routes=tuple(Route(robot, tasks) for robot, tasks in routes.items()))


@pytest.mark.parametrize("name", sorted(MESSAGES))
def test_messages_of_rclpy_are_ours(graph, name):
    assert from_foreign(MESSAGES[name], to_foreign(MESSAGES[name](), _class_of)) == MESSAGES[name]()


def test_messages_in_messages_are_ours(graph):
    path = Path(poses=(PoseStamped(), PoseStamped(pose=Pose(Point(1.0, 2.0, 3.0)))))
    theirs = to_foreign(path, _class_of)
    assert [type(pose) for pose in theirs.poses] == [_class_of(PoseStamped)] * 2
    assert from_foreign(Path, theirs) == path


def test_by_itself_it_is_rclpy_where_that_is_and_in_the_domain_asked_for(graph):
    middleware = open_middleware(domain=7)
    assert isinstance(middleware, RclpyMiddleware)
    assert [context.domain for context in graph.contexts] == [7]
    middleware.close()
    assert not graph.contexts[0].up


def test_topics_are_written_heard_and_found(graph):
    one, other = RclpyMiddleware(1), RclpyMiddleware(1)
    writer, reader = one.writer("/r_0/pose", PoseStamped), other.reader("/r_0/pose", PoseStamped)
    other.reader("/r_1/odom", Odometry)
    assert list(other.topics()) == [("/r_0/pose", "geometry_msgs/PoseStamped")]  # what is only heard is not published
    assert writer.listeners == 1
    writer.write(PoseStamped())
    writer.write(PoseStamped())
    assert reader.take() == []
    other.wait(0.0)
    assert reader.take() == [PoseStamped(), PoseStamped()]
    assert reader.take() == []


def test_nav2_says_when_a_robot_is_there_and_where_it_is(graph):
    nav2 = fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0))
    fleet = navigated(mission("r_0"))
    port = fleet.ports["r_0"]
    assert port.send([Waypoint((3.0, 0.0, 0.0)), Waypoint((3.0, 1.0, 0.0), hold_s=0.2)]) == 1
    until(fleet, lambda: port.telemetry().passed == 2)
    assert port.telemetry().position[:2] == pytest.approx((3.0, 1.0), abs=0.26)
    assert [goal.at for goal in nav2.goals] == [(3.0, 0.0), (3.0, 1.0)]
    assert not port.telemetry().refused


def test_nav2s_word_is_enough_where_poses_say_otherwise(graph):
    nav2 = fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), speed=5.0)
    fleet = navigated(mission("r_0"))
    nav2.look = lambda: (nav2._said.publish(nav2._pose()), nav2._under_way and nav2._end(nav2._under_way, 4))
    fleet.ports["r_0"].send([Waypoint((3.0, 0.0, 0.0))])
    until(fleet, lambda: fleet.ports["r_0"].telemetry().passed == 1)
    assert fleet.ports["r_0"].telemetry().position[:2] == (0.0, 0.0)


def test_new_orders_cancel_the_goal_before_and_wait_for_its_end(graph):
    nav2 = fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["hang", "hang", "go"])
    fleet = navigated(mission("r_0"))
    port = fleet.ports["r_0"]
    port.send([Waypoint((9.0, 0.0, 0.0))])
    port.send([Waypoint((0.0, 9.0, 0.0))])  # before the first is known to be accepted
    until(fleet, lambda: len(nav2.goals) == 2)
    assert nav2.ended == [5]
    fleet.advance(fleet.time_s + 0.1)
    assert not port.telemetry().refused
    port.cancel()
    port.send([Waypoint((1.0, 0.0, 0.0))])
    until(fleet, lambda: port.telemetry().passed == 1)
    assert nav2.ended == [5, 5, 4]
    assert not port.telemetry().refused


def test_stop_cancels_and_waits_for_it(graph):
    nav2 = fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["hang"], brakes=300)
    fleet = navigated(mission("r_0"))
    fleet.ports["r_0"].send([Waypoint((9.0, 0.0, 0.0))])
    fleet.stop()
    assert nav2.ended == [5]
    fleet.close()


def test_who_does_not_say_that_it_stays_is_named(graph, caplog):
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["hang"], brakes=10**9)
    fleet = navigated(mission("r_0"))
    fleet.ports["r_0"].send([Waypoint((9.0, 0.0, 0.0))])
    fleet.stop()
    said = "robot r_0 was told to stay, and does not say within 2 s that it does"
    assert [record.getMessage() for record in caplog.records] == [said]


def test_a_goal_that_cannot_be_cancelled_is_said_and_the_next_is_cancelled(graph):
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["deaf"])
    other = fake_rclpy.Nav2(graph, "r_1", (0.0, 3.0), script=["hang"])
    fleet = navigated(mission("r_0", "r_1"))
    for port in fleet.ports.values():
        port.send([Waypoint((9.0, 0.0, 0.0))])
    fleet.advance(fleet.time_s + 0.1)
    said = "^robot r_0 was not told to stay: a goal cannot be cancelled: ROS 2: no client$"
    with pytest.raises(NetworkError, match=said):
        fleet.stop()
    assert other.ended == [5]


@pytest.mark.parametrize(
    ("script", "said"),
    [
        (["abort"], "navigate_to_pose: aborted (no way)"),
        (["reject"], "navigate_to_pose: rejected"),
        (["go", "abort", "abort"], "navigate_to_pose: aborted (no way)"),
        (["lose"], "navigate_to_pose: aborted (no answer to the goal)"),
        (["break"], "navigate_to_pose: aborted (no result)"),
    ],
)
def test_what_nav2_gives_up_twice_is_refused(graph, script, said):
    nav2 = fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=script)
    fleet = navigated(mission("r_0"))
    port = fleet.ports["r_0"]
    port.send([Waypoint((1.0, 0.0, 0.0)), Waypoint((2.0, 0.0, 0.0))])
    until(fleet, lambda: port.telemetry().refused)
    assert port.telemetry().refused == said
    assert len(nav2.goals) == len(script) + (len(script) == 1)
    port.send([])
    until(fleet, lambda: not port.telemetry().refused)


def test_what_is_given_up_once_is_tried_again(graph):
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["abort", "go"])
    fleet = navigated(mission("r_0"))
    fleet.ports["r_0"].send([Waypoint((1.0, 0.0, 0.0))])
    until(fleet, lambda: fleet.ports["r_0"].telemetry().passed == 1)
    assert not fleet.ports["r_0"].telemetry().refused


def test_a_robot_whose_goal_somebody_else_cancels_takes_no_part_and_its_task_is_not_refused(graph):
    nav2 = fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["hang"])
    fleet = navigated(mission("r_0"))
    fleet.ports["r_0"].send([Waypoint((1.0, 0.0, 0.0))])
    fleet.advance(fleet.time_s + 0.1)
    nav2._under_way.cancel_asked = True
    until(fleet, lambda: fleet.ports["r_0"].telemetry().suspended)
    said = fleet.ports["r_0"].telemetry()
    assert said.suspended == "another station: navigate_to_pose: canceled by somebody else"
    assert not said.refused
    assert len(nav2.goals) == 1


def test_where_nav2_ends_the_goal_waits_for_another(graph):
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["hang"])
    fleet = navigated(mission("r_0"))
    fleet.ports["r_0"].send([Waypoint((1.0, 0.0, 0.0))])
    fleet.advance(fleet.time_s + 0.1)
    del graph.servers["/r_0/navigate_to_pose"], graph.robots[0]
    fleet.advance(fleet.time_s + 0.1)
    expected = "an action server of /r_0/navigate_to_pose (nav2_msgs/NavigateToPose)"
    assert fleet.robots_not_ready() == {"r_0": f"nobody receives its orders; expected {expected}"}
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0))
    until(fleet, lambda: fleet.ports["r_0"].telemetry().passed == 1)


def test_a_task_that_a_robot_does_not_get_to_is_done_by_another(graph):
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["abort", "abort", "go"])
    fake_rclpy.Nav2(graph, "r_1", (0.0, 3.0))
    there = mission("r_0", "r_1", tasks=((2.0, 0.0), (2.0, 3.0)))
    fleet = navigated(there)
    happened = []
    report = carry_out_live(there, plan(r_0=("t_0",), r_1=("t_1",)), fleet, on_event=happened.append)
    assert set(report.tasks_done) == {"t_0", "t_1"}
    refused = [dict(one.data) for one in happened if one.kind == "task_refused"]
    assert refused == [{"task": "t_0", "robot": "r_0", "reason": "navigate_to_pose: aborted (no way)"}]
    assert {row.task: row.robot for row in report.tasks} == {"t_0": "r_1", "t_1": "r_1"}


def test_a_task_that_nobody_gets_to_is_lost_with_the_reason(graph):
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0), script=["abort"])
    there = mission("r_0", tasks=((2.0, 0.0),))
    report = carry_out_live(there, plan(r_0=("t_0",)), navigated(there))
    assert "navigate_to_pose: aborted (no way)" in dict(report.tasks_lost)["t_0"]


def test_all_is_called_in_the_thread_that_waits(graph):
    before = threading.active_count()
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0))
    fleet = navigated(mission("r_0"))
    fleet.ports["r_0"].send([Waypoint((1.0, 0.0, 0.0))])
    until(fleet, lambda: fleet.ports["r_0"].telemetry().passed == 1)
    assert threading.active_count() == before


def test_a_robot_that_is_found_joins_with_what_it_says(graph):
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0))
    fleet = Ros2Fleet(mission("r_0"), middleware=RclpyMiddleware())
    fake_rclpy.Nav2(graph, "r_7", (4.0, 5.0))
    words = RclpyMiddleware().writer("/r_7/muster", String)
    joined = []
    while not joined:
        words.write(String('{"speed_mps": 3.0, "id": "other"}'))
        joined += fleet.advance(fleet.time_s + 0.05)
    robot = joined[0].robot_joins
    assert (robot.id, robot.position, robot.speed_mps) == ("r_7", (4.0, 5.0), 3.0)
    assert fleet.ports["r_7"].telemetry() is not None


def test_one_that_says_what_is_wrong_does_not_join(graph, caplog):
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0))
    fleet = Ros2Fleet(mission("r_0"), middleware=RclpyMiddleware())
    fake_rclpy.Nav2(graph, "r_7", (4.0, 5.0))
    words = RclpyMiddleware().writer("/r_7/muster", String)
    end = fleet.time_s + 10
    while not caplog.records and fleet.time_s < end:
        words.write(String('{"speed_mps": -3.0}'))
        assert fleet.advance(fleet.time_s + 0.05) == []
    assert [record.getMessage() for record in caplog.records] == [
        "r_7 does not join: /r_7/muster: speed_mps: -3.0; expected a finite number, above 0"
    ]
    assert set(fleet.ports) == {"r_0"}


def test_in_a_namespace_it_is_found_and_named_there(graph, caplog):
    fake_rclpy.Nav2(graph, "team/r_0", (0.0, 0.0))
    fleet = Ros2Fleet(mission("r_0"), Ros2Settings(namespace="/team/"), middleware=RclpyMiddleware())
    until(fleet, lambda: not fleet.robots_not_ready())
    fake_rclpy.Nav2(graph, "team/r_7", (4.0, 5.0))
    words = RclpyMiddleware().writer("/team/r_7/muster", String)
    end = fleet.time_s + 10
    while not caplog.records and fleet.time_s < end:
        words.write(String("[]"))
        fleet.advance(fleet.time_s + 0.05)
    assert caplog.records[0].getMessage().startswith("r_7 does not join: /team/r_7/muster: ")


def test_known_only_nobody_joins(graph):
    fleet = Ros2Fleet(mission("r_0"), Ros2Settings(known_only=True), middleware=RclpyMiddleware())
    fake_rclpy.Nav2(graph, "r_7", (4.0, 5.0))
    assert fleet.advance(fleet.time_s + 1.0) == []


def test_what_is_missing_is_one_line(graph, monkeypatch):
    monkeypatch.setitem(sys.modules, "nav2_msgs.action", None)
    with pytest.raises(MissingExtraError, match="install nav2_msgs"):
        Ros2Fleet(mission("r_0"), Ros2Settings(give="nav2"), middleware=RclpyMiddleware())
    assert not graph.contexts[0].up
    monkeypatch.setitem(sys.modules, "rclpy.node", None)
    with pytest.raises(MissingExtraError, match=r"source the setup file .*, or use DDS") as caught:
        RclpyMiddleware()
    assert "\n" not in str(caught.value)
    with pytest.raises(ParameterError, match="domain: '233'; expected a number from 0 to 232"):
        RclpyMiddleware(233)


def test_a_node_that_cannot_be_leaves_nothing_open(graph, monkeypatch):
    def fails(*_, **__):
        raise RuntimeError("no middleware")

    monkeypatch.setattr(fake_rclpy.MODULES["rclpy.node"], "Node", fails)
    with pytest.raises(NetworkError, match="ROS 2 domain 3: no middleware; see RMW_IMPLEMENTATION"):
        RclpyMiddleware(3)
    assert [context.up for context in graph.contexts] == [False]


def test_what_cannot_be_published_is_one_line(graph):
    middleware = RclpyMiddleware(3)
    writer = middleware.writer("/r_0/goal_pose", PoseStamped)

    def fails(_):
        raise RuntimeError("context\nis shut down")

    writer._publisher.publish = fails
    with pytest.raises(NetworkError, match=r"^/r_0/goal_pose: ROS 2: context is shut down$"):
        writer.write(PoseStamped())
