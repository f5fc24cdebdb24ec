"""Robots of ROS 2 over DDS: robots in other processes, with types of their own, on this computer alone."""

import signal
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from tests.times_and_teams import judge, tasks_of

import muster
from muster.mission.errors import MissingExtraError, NetworkError, ParameterError
from muster.mission.model import Event, Mission, Robot, Task
from muster.motion.port import Waypoint
from muster.running.live import Live, carry_out_live

pytest.importorskip("cyclonedds")

from muster_robots.ros2.dds import DdsMiddleware
from muster_robots.ros2.description import from_foreign, to_foreign
from muster_robots.ros2.fleet import Ros2Fleet
from muster_robots.ros2.message_types import MESSAGES, PoseStamped

pytestmark = pytest.mark.usefixtures("loopback")


@pytest.fixture
def robots(start):
    """Starts robots with types of their own: `robots("r_0", 0, 0, "pose")`."""

    def robot(name, x, y, says):
        return start(Path(__file__).with_name("robot_process.py"), name, x, y, says)

    return robot


def mission(*ids):
    robots = tuple(Robot(id=name, position=(0.0, 3.0 * k), radius_m=0.2) for k, name in enumerate(ids))
    return Mission(robots=robots, tasks=tuple(Task(id=f"t_{k}", position=(2.0, 1.5 * k)) for k in range(3)))


def until(fleet, true, most_s=15.0):
    end = fleet.time_s + most_s
    while not true():
        assert fleet.time_s < end, "this did not come about"
        fleet.advance(fleet.time_s + 0.1)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("says", ["pose", "odom"])
def test_a_robot_follows_way_points(says, robots):
    robots("r_0", 1, 0, says)
    fleet = Ros2Fleet(mission("r_0"), middleware=DdsMiddleware())
    port = fleet.ports["r_0"]
    assert port.telemetry() is None
    until(fleet, lambda: port.telemetry() is not None)
    assert port.telemetry().position == (1.0, 0.0, 0.0)
    assert port.send([Waypoint((2.0, 0.0, 0.0)), Waypoint((2.0, 1.0, 0.0), hold_s=0.3)]) == 1
    until(fleet, lambda: port.telemetry().passed == 1)
    reached = fleet.time_s
    until(fleet, lambda: port.telemetry().passed == 2)
    said = port.telemetry()
    assert fleet.time_s >= reached + 0.3
    assert said.order == 1
    assert said.position[:2] == pytest.approx((2.0, 1.0), abs=0.25)
    assert said.odometry_m == pytest.approx(2.0, abs=0.6)
    fleet.close()


def test_cancelled_it_stays_and_silent_its_time_stands_still(robots):
    process = robots("r_0", 0, 0, "pose")
    fleet = Ros2Fleet(mission("r_0"), middleware=DdsMiddleware())
    port = fleet.ports["r_0"]
    until(fleet, lambda: port.telemetry() is not None)
    port.send([Waypoint((400.0, 0.0, 0.0))])
    until(fleet, lambda: port.telemetry().position[0] > 1.0)
    assert port.cancel() == 2
    fleet.advance(fleet.time_s + 0.5)
    stopped = port.telemetry().position
    fleet.advance(fleet.time_s + 0.3)
    assert port.telemetry().position == stopped
    assert port.telemetry().passed == 0
    process.kill()
    process.wait()
    fleet.advance(fleet.time_s + 0.2)
    last = port.telemetry().time_s
    fleet.advance(fleet.time_s + 0.3)
    assert port.telemetry().time_s == last
    fleet.close()


@pytest.mark.long
def test_a_plan_is_carried_out_by_robots_in_other_processes(robots):
    there = mission("r_0", "r_1")
    robots("r_0", 0, 0, "pose")
    robots("r_1", 0, 3, "odom")
    fleet = Ros2Fleet(there, middleware=DdsMiddleware())
    until(fleet, lambda: all(port.telemetry() is not None for port in fleet.ports.values()))
    report = carry_out_live(there, muster.solve(there, "greedy"), fleet)
    assert set(report.tasks_done) == {"t_0", "t_1", "t_2"}
    fleet.close()


@pytest.mark.long
def test_a_robot_that_is_pushed_goes_on_and_one_that_an_operator_takes_away_stands_until_it_returns(robots):
    there = mission("r_0", "r_1")
    there = replace(there, tasks=tuple(replace(task, duration_s=1.0) for task in there.tasks))
    processes = [robots("r_0", 0, 0, "pose"), robots("r_1", 0, 3, "odom")]
    fleet = Ros2Fleet(there, middleware=DdsMiddleware())
    until(fleet, lambda: all(port.telemetry() is not None for port in fleet.ports.values()))
    run = Live(there, muster.solve(there, "greedy"), fleet)
    pushed = removed = returned = None
    while not run.done:
        run.look()
        run.hear(run.time_s + 0.1)
        run.executor.come_to(run.time_s)
        place = run.executor.crew["r_0"].position
        if pushed is None and place[0] > 0.2:
            processes[0].send_signal(signal.SIGUSR1)
            pushed = run.time_s
        if removed is None and run.time_s > 0.5:
            run.executor.report(Event(at_s=0, robot_removed="r_1"))
            removed = run.time_s
        if removed and not returned and run.time_s > removed + 2.0:
            assert run.executor.crew["r_1"].telemetry.velocity == (0.0, 0.0, 0.0)
            run.executor.report(Event(at_s=0, robot_returns="r_1"))
            returned = run.time_s
        assert run.time_s < 120
    run.stop()
    fleet.close()
    assert min(pushed, returned) > 0
    assert run.result().tasks_lost == ()
    assert not [event for event in run.events if event.kind in ("robot_stuck", "robot_silent")]


@pytest.mark.long
def test_robots_wait_for_a_window_and_begin_together(robots):
    opens_s = 2.0
    there = replace(mission("r_0", "r_1", "r_2"), tasks=tasks_of(opens_s))
    for k, robot in enumerate(there.robots):
        robots(robot.id, 0, 3 * k, "pose")
    fleet = Ros2Fleet(there, middleware=DdsMiddleware())
    until(fleet, lambda: all(port.telemetry() is not None for port in fleet.ports.values()))
    judge(carry_out_live(there, muster.solve(there, iterations=300), fleet).as_dict(), opens_s)
    fleet.close()


@pytest.mark.parametrize("name", sorted(MESSAGES))
def test_types_of_dds_are_written_as_messages_are(name):
    from muster_robots.ros2.dds import _idl
    from muster_robots.ros2.serialization import to_cdr

    sent = MESSAGES[name]()
    package, _, kind = name.partition("/")
    assert to_foreign(sent, _idl).serialize() == to_cdr(sent)
    assert _idl(MESSAGES[name]).__idl_typename__ == f"{package}::msg::dds_::{kind}_"
    assert from_foreign(MESSAGES[name], to_foreign(sent, _idl)) == sent


def test_what_cannot_be_written_is_one_line():
    from cyclonedds.core import DDSException

    def fails(_):
        raise DDSException(DDSException.DDS_RETCODE_TIMEOUT, "Occurred while writing")

    writer = DdsMiddleware().writer("/r_0/goal_pose", PoseStamped)
    writer._writer.write = fails
    with pytest.raises(NetworkError, match=r"^/r_0/goal_pose: DDS: \[DDS_RETCODE_TIMEOUT\] .*writing$"):
        writer.write(PoseStamped())


def test_bad_domains_and_no_extra(monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", "many")
    with pytest.raises(ParameterError, match="ROS_DOMAIN_ID: 'many'; expected a number from 0 to 232"):
        DdsMiddleware()
    with pytest.raises(ParameterError, match="domain: '-1'; expected a number from 0 to 232"):
        DdsMiddleware(-1)
    monkeypatch.setitem(sys.modules, "cyclonedds", None)
    with pytest.raises(MissingExtraError, match=r"muster-robotics\[ros2\]"):
        DdsMiddleware(1)
