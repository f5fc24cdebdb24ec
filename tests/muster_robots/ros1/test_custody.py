"""Robots on ROS 1 in custody: told again until they do what is wanted, silent and back, taken, put out."""

import threading
from types import SimpleNamespace

import pytest
from tests.muster_robots.ros2.fake_middleware import Navigator

from muster.mission.model import Robot
from muster.motion.frames import pose_transform
from muster.motion.port import Waypoint
from muster_robots.custody_settings import CustodySettings
from muster_robots.navigation import Outcome
from muster_robots.pose_custody import failures
from muster_robots.steering import STILL

FAR, STEP_S = Waypoint((50.0, 0.0, 0.0)), 0.1
GOALS = ("goals", "move_base_simple")
DRIVES = ("cmd_vel", *GOALS, "move_base")


class There:
    """The port of a robot in the test's own time, and what it was told: places of goals, or velocities."""

    def __init__(self, drive, monkeypatch, **settings):
        from muster_robots.ros1 import clock, move_base, orders, port

        self.now, self.x, self.told, self.actions = 0.0, 0.0, [], Navigator()
        self.drive = drive
        stats = SimpleNamespace(get_stats_info=lambda: [(1, "/robot", "o", "TCPROS", "/r", True, "")])
        publisher = SimpleNamespace(publish=self.told.append, get_num_connections=lambda: 1, impl=stats)
        monkeypatch.setattr(orders, "hear", lambda _, __, heard, **___: setattr(self, "goal_said", heard))
        monkeypatch.setattr(orders.rospy, "Publisher", lambda *_, **__: publisher)
        monkeypatch.setattr(orders, "pose_stamped", lambda _, place, __: place[0])
        monkeypatch.setattr(orders, "twist_of", lambda velocity: velocity)
        monkeypatch.setattr(move_base, "MoveBaseNavigator", lambda *_: self.actions)
        monkeypatch.setattr(port, "PoseListener", lambda *_, **__: SimpleNamespace(untied="", hear_fix=None))
        self.port = port.Ros1Port(
            Robot(id="r", position=(0.0, 0.0)),
            "/r",
            drive=drive,
            frame=SimpleNamespace(name="map"),
            flat=True,
            arrival_m=0.1,
            lock=threading.RLock(),
            clock=clock.MissionClock(lambda: self.now),
            on_pass=lambda: None,
            limits=CustodySettings(**settings).custody_limits,
        )
        self.pass_by(3.0, 0.0)

    def pass_by(self, seconds, speed_mps):
        """Let time go by in which the robot drives, stands, or is not heard (None); returns what happened."""
        events = []
        for _ in range(round(seconds / STEP_S)):
            self.now += STEP_S
            if speed_mps is not None:
                self.x += speed_mps * STEP_S
                self.port._hear(None, pose_transform((self.x, 0.0, 0.0, 0.0, 0.0, 0.0)), None)
            within_s = 0.5 if self.drive == "cmd_vel" else 1e9
            self.port.speak(self.port.steered(within_s=within_s, paused=False), STILL)
            events += failures([self.port.custody], self.now, self.now)
        return events

    @property
    def goals(self):
        return self.told + [goal for goal, _ in self.actions.given]

    @property
    def age_s(self):
        return self.now - self.port.telemetry().time_s


@pytest.fixture
def there(rospy_there, monkeypatch):
    return lambda drive, **settings: There(drive, monkeypatch, **settings)


@pytest.mark.parametrize("drive", GOALS)
def test_a_robot_that_has_lost_its_goal_gets_it_again(there, drive):
    robot = there(drive)
    robot.port.send([FAR])
    robot.pass_by(4.0, 1.0)
    assert robot.goals == [50.0]
    robot.pass_by(4.0, 0.0)  # it has started again
    robot.pass_by(4.0, 1.0)
    assert robot.goals == [50.0] * 2


def test_a_robot_whose_navigation_is_at_its_goal_is_left_alone_though_it_stands(there):
    robot = there("move_base")
    robot.port.send([FAR])
    robot.pass_by(30.0, 0.0)
    assert robot.goals == [50.0]


@pytest.mark.parametrize("drive", GOALS)
def test_a_robot_that_is_to_hold_and_drives_is_told_again_where_it_is_then(there, drive):
    robot = there(drive)
    robot.port.send([FAR])
    robot.pass_by(2.0, 1.0)
    robot.port.cancel()
    robot.pass_by(5.0, 1.0)
    assert robot.goals[1:] == pytest.approx([2.0, 4.1, 6.1], abs=0.3)


def test_a_robot_that_takes_velocities_is_told_to_stand_until_it_does_and_then_a_person_may_drive_it(there):
    robot = there("cmd_vel")
    robot.port.send([FAR])
    robot.pass_by(2.0, 1.0)
    robot.port.cancel()
    robot.pass_by(1.5, 1.0)
    told = len(robot.told)
    robot.pass_by(2.0, 1.0)  # it did not hear that
    assert len(robot.told) > told
    robot.pass_by(5.0, 0.0)
    told = len(robot.told)
    robot.pass_by(20.0, 1.0)
    assert len(robot.told) == told
    assert robot.age_s == 0.0


@pytest.mark.parametrize("drive", DRIVES)
def test_a_silent_robot_takes_part_again_when_it_holds(there, drive):
    robot = there(drive)
    robot.port.send([FAR])
    robot.pass_by(2.0, 1.0)
    robot.pass_by(8.0, None)
    robot.port.cancel()  # as the executor does
    told = len(robot.told)
    robot.pass_by(1.0, 1.0)
    assert robot.age_s == pytest.approx(9.0, abs=0.2)
    assert len(robot.told) > told or drive == "move_base"
    robot.pass_by(5.0, 0.0)
    assert robot.age_s < 0.2


@pytest.mark.parametrize("drive", GOALS)
def test_a_gap_that_is_short_changes_nothing(there, drive):
    robot = there(drive)
    robot.port.send([FAR])
    robot.pass_by(2.0, 1.0)
    robot.pass_by(4.0, None)
    robot.x += 4.0
    robot.pass_by(3.0, 1.0)
    assert robot.goals == [50.0]


@pytest.mark.parametrize("drive", DRIVES)
def test_a_robot_that_flaps_is_put_out(there, drive):
    robot, events = there(drive, silences=1, link_lost_s=2.0), []
    for _ in range(3):
        events += robot.pass_by(3.0, None)
        events += robot.pass_by(4.0, 0.0)
    assert [event.robot_fails for event in events] == ["r"]


def test_whose_goal_somebody_else_cancels_takes_no_part_until_it_has_stood(there):
    robot = there("move_base")
    robot.port.send([FAR])
    robot.pass_by(2.0, 1.0)
    robot.actions.given[0][1].outcome = Outcome("canceled")
    robot.pass_by(0.5, 1.0)
    robot.port.cancel()
    said = robot.port.telemetry()
    assert (said.suspended, said.refused) == ("another station: move_base: canceled by somebody else", "")
    robot.pass_by(20.0, 1.0)  # to where somebody else sends it
    assert robot.port.telemetry().suspended
    robot.pass_by(5.0, 0.0)
    assert not robot.port.telemetry().suspended
    assert robot.goals == [50.0]


@pytest.mark.parametrize("outcome", ["aborted", "canceled", None])
def test_one_that_pursues_a_goal_of_somebody_else_is_left_to_it_until_it_has_ended_and_the_robot_has_stood(
    there, outcome
):
    robot = there("move_base")
    robot.port.send([FAR])
    robot.pass_by(2.0, 1.0)
    own = robot.actions.given[0][1]
    robot.actions.foreign = "/rviz-1-12.5"
    own.outcome = own.outcome if outcome is None else Outcome(outcome)
    robot.pass_by(1.0, 1.0)
    said = robot.port.telemetry()
    why = "another station: move_base has goal /rviz-1-12.5, which is not Muster's"
    assert (said.suspended, said.refused) == (why, "")
    assert own.outcome is not None  # cancelled by its own id
    robot.port.cancel()
    robot.pass_by(20.0, 0.0)
    assert robot.port.telemetry().suspended
    robot.actions.foreign = ""
    robot.pass_by(1.0, 1.0)
    assert robot.port.telemetry().suspended
    robot.pass_by(5.0, 0.0)
    assert not robot.port.telemetry().suspended
    assert robot.goals == [50.0]


@pytest.mark.parametrize("drive", GOALS)
def test_a_goal_of_somebody_else_on_its_topic_takes_a_robot_until_it_has_stood(there, drive, caplog):
    robot = there(drive)
    topic = "/r/WP" if drive == "goals" else "/r/move_base_simple/goal"
    robot.port.send([FAR])
    robot.goal_said(SimpleNamespace(_connection_header={"callerid": "/unnamed"}))  # its own
    robot.pass_by(2.0, 1.0)
    assert not robot.port.telemetry().suspended
    robot.goal_said(SimpleNamespace(_connection_header={"callerid": "/rviz"}))
    robot.pass_by(0.5, 1.0)
    assert robot.port.telemetry().suspended == f"another station: a goal on {topic} is not Muster's"
    robot.port.cancel()
    robot.pass_by(10.0, 1.0)
    robot.port.stand()  # as at the end
    assert robot.port.telemetry().suspended
    robot.pass_by(5.0, 0.0)
    assert not robot.port.telemetry().suspended
    assert robot.goals == [50.0]
    assert len([one for one in caplog.records if "is not Muster's" in one.getMessage()]) == 1


def test_goals_of_move_base_are_others_by_their_ids(rospy_there, monkeypatch):
    """By the states that its server sends; goals of an earlier run are Muster's, and those that have ended nobody's."""
    from muster_robots.ros1 import move_base
    from muster_robots.ros1.ros import GoalID, GoalStatus, GoalStatusArray

    link = SimpleNamespace(get_num_connections=lambda: 1)
    monkeypatch.setattr(move_base.rospy, "Publisher", lambda *_, **__: link)
    monkeypatch.setattr(move_base, "hear", lambda *_, **__: link)
    monkeypatch.setattr(move_base.rospy, "get_name", lambda: "/muster")
    now = [10.0]
    navigator = move_base.MoveBaseNavigator("/r/move_base", lambda: now[0], threading.RLock())

    def foreign(*states):
        said = [GoalStatus(goal_id=GoalID(id=name), status=status) for name, status in states]
        navigator._hear_states(GoalStatusArray(status_list=said))
        return navigator.foreign

    assert foreign(("/muster-1-5.0", GoalStatus.ACTIVE)) == ""
    assert foreign(("/rviz-1-7.0", GoalStatus.SUCCEEDED), ("/muster-2-8.0", GoalStatus.ACTIVE)) == ""
    assert foreign(("/muster-2-8.0", GoalStatus.PREEMPTING), ("/rviz-1-7.0", GoalStatus.PENDING)) == "/rviz-1-7.0"
    assert foreign(("/rviz-1-7.0", GoalStatus.ACTIVE)) == "/rviz-1-7.0"
    now[0] += 10.0  # its server has gone
    assert navigator.foreign == ""
    assert foreign() == ""
