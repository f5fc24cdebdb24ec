"""Robots on ROS 2 in custody: told again until they do what is wanted, silent and back, taken, put out."""

import math
from dataclasses import replace

import pytest
from tests.muster_robots.ros2.bus import STEP_S, Bus
from tests.muster_robots.ros2.fake_middleware import Middleware, Navigator, posed

import muster
from muster.mission.model import Mission, Robot, Task
from muster.motion.port import Waypoint
from muster_robots.fleet_settings import Ros2Settings
from muster_robots.navigation import Outcome
from muster_robots.ros2.fleet import Ros2Fleet
from muster_robots.ros2.simulated_participant import SimulatedRobot
from muster_robots.simulated_program import Wanted

FAR = (50.0, 0.0, 0.0)


class Wire(Middleware):
    """A robot that is heard ten times a second, and drives if `speed_mps` says so; None: it is not heard."""

    def __init__(self):
        super().__init__()
        self.x, self.speed_mps, self.actions = 0.0, 0.0, Navigator()

    def navigator(self, _):
        return self.actions

    def wait(self, seconds):
        super().wait(seconds)
        if self.speed_mps is not None:
            self.x += self.speed_mps * seconds
            self.heard["/r/pose"].append(posed(self.x))


class There:
    def __init__(self, give, **settings):
        self.wire = Wire()
        robots = (Robot(id="r", position=(0.0, 0.0)),)
        how = Ros2Settings(give=give, known_only=True, **settings)
        self.fleet = Ros2Fleet(Mission(robots=robots, tasks=()), how, middleware=self.wire, clock=self.wire)
        self.port = self.fleet.ports["r"]
        self.pass_by(3.0, 0.0)

    def pass_by(self, seconds, speed_mps):
        """Let time go by in which the robot drives, stands, or is not heard; returns what happened."""
        self.wire.speed_mps, events = speed_mps, []
        until_s = self.fleet.time_s + seconds
        while self.fleet.time_s < until_s - 1e-6:
            events += self.fleet.advance(until_s)
        return events

    @property
    def goals(self):
        """Where the robot was told to go, on its topic or by its action."""
        given = [goal.pose.position.x for goal, _ in self.wire.actions.given]
        return [x for x, _ in self.wire.told.get("/r/goal_pose", ())] + given

    @property
    def age_s(self):
        return self.fleet.time_s - self.port.telemetry().time_s


BOTH = pytest.mark.parametrize("give", ["goals", "nav2"])


def test_limits_are_those_of_the_settings():
    there = There("goals", link_lost_s=7.0, absent_s=3.0)
    assert (there.fleet.limits.silent_after_s, there.fleet.limits.absent_for_s) == (7.0, 3.0)


def test_a_robot_that_has_lost_its_goal_gets_it_again():
    there = There("goals")
    there.port.send([Waypoint(FAR)])
    there.pass_by(4.0, 1.0)
    assert there.goals == [50.0]
    there.pass_by(4.0, 0.0)  # it has started again
    assert there.goals == [50.0, 50.0]
    there.pass_by(4.0, 1.0)
    assert there.goals == [50.0, 50.0]


def test_a_robot_whose_navigation_is_at_its_goal_is_left_alone_though_it_stands():
    there = There("nav2")
    there.port.send([Waypoint(FAR)])
    there.pass_by(30.0, 0.0)
    assert there.goals == [50.0]


def test_a_robot_that_is_to_hold_and_drives_is_told_again_where_it_is_then():
    there = There("goals")
    there.port.send([Waypoint(FAR)])
    there.pass_by(2.0, 1.0)
    there.port.cancel()
    there.pass_by(6.0, 1.0)
    assert there.goals[:2] == pytest.approx([50.0, 2.0], abs=0.2)
    assert there.goals[2:] == pytest.approx([4.0, 6.0, 8.0][: len(there.goals) - 2], abs=0.3)
    assert len(there.goals) >= 4


def test_a_goal_whose_cancel_had_no_effect_is_cancelled_again():
    there = There("nav2")
    there.port.send([Waypoint(FAR)])
    there.pass_by(2.0, 1.0)
    asked = []
    there.wire.actions.given[0][1].cancel = lambda: asked.append(there.fleet.time_s)
    there.port.cancel()
    there.pass_by(4.5, 1.0)
    assert len(asked) >= 2


@BOTH
def test_a_silent_robot_takes_part_again_when_it_holds(give):
    there = There(give)
    there.port.send([Waypoint(FAR)])
    there.pass_by(2.0, 1.0)
    there.pass_by(8.0, None)
    there.port.cancel()  # as the executor does
    there.pass_by(1.0, 1.0)
    assert there.age_s == pytest.approx(9.0, abs=0.1)
    there.pass_by(5.0, 0.0)
    assert there.age_s < 0.2


@BOTH
def test_a_robot_that_flaps_is_put_out(give):
    there, events = There(give, silences=1, link_lost_s=2.0), []
    for _ in range(3):
        events += there.pass_by(3.0, None)
        events += there.pass_by(4.0, 0.0)
    assert [event.robot_fails for event in events] == ["r"]
    assert events[0].reason == "silent, or without an answer, more than 1 times in 120 s"


def test_whose_goal_somebody_else_cancels_takes_no_part_until_it_has_stood():
    there = There("nav2")
    there.port.send([Waypoint(FAR)])
    there.pass_by(2.0, 1.0)
    there.wire.actions.given[0][1].outcome = Outcome("canceled")
    there.pass_by(1.0, 1.0)
    there.port.cancel()
    said = there.port.telemetry()
    assert said.suspended == "another station: navigate_to_pose: canceled by somebody else"
    assert said.refused == ""
    there.pass_by(20.0, 1.0)  # to where somebody else sends it
    assert there.port.telemetry().suspended
    there.pass_by(5.0, 0.0)
    assert not there.port.telemetry().suspended
    assert there.goals == [50.0]


@pytest.mark.parametrize("outcome", ["aborted", "canceled", None])
def test_one_that_pursues_a_goal_of_somebody_else_is_left_to_it_until_it_has_ended_and_the_robot_has_stood(outcome):
    """Servers end the goal before as they like, or leave it under way."""
    there = There("nav2")
    there.port.send([Waypoint(FAR)])
    there.pass_by(2.0, 1.0)
    own = there.wire.actions.given[0][1]
    there.wire.actions.foreign = "12ab"
    own.outcome = own.outcome if outcome is None else Outcome(outcome)
    there.pass_by(1.0, 1.0)
    why = "another station: navigate_to_pose has goal 12ab, which is not Muster's"
    assert there.port.telemetry().suspended == why
    assert there.port.telemetry().refused == ""
    assert own.outcome is not None  # cancelled by its own id
    there.port.send([Waypoint((30.0, 0.0, 0.0))])
    there.pass_by(20.0, 0.0)  # it stands, as where others are in its way
    assert there.port.telemetry().suspended
    there.wire.actions.foreign = ""
    there.pass_by(1.0, 1.0)
    assert there.port.telemetry().suspended
    assert there.goals == [50.0]
    there.pass_by(6.0, 0.0)
    assert not there.port.telemetry().suspended
    assert there.goals == [50.0, 30.0]


def test_a_goal_of_somebody_else_on_its_topic_takes_a_robot_until_it_has_stood():
    there = There("goals")
    there.port.send([Waypoint(FAR)])
    there.pass_by(2.0, 1.0)
    assert not there.port.telemetry().suspended
    there.wire.heard["/r/goal_pose"].append(posed(-5.0))
    there.pass_by(1.0, 0.0)  # navigation plans
    assert there.port.telemetry().suspended == "another station: a goal on /r/goal_pose is not Muster's"
    there.port.cancel()
    there.pass_by(10.0, -0.5)
    assert there.port.telemetry().suspended
    there.pass_by(5.0, 0.0)
    assert not there.port.telemetry().suspended
    assert there.goals == [50.0]


def test_a_goal_of_somebody_else_is_told_once(caplog):
    there = There("nav2")
    there.wire.actions.foreign = "12ab"
    there.pass_by(20.0, 1.0)
    told = [record.getMessage() for record in caplog.records if "12ab" in record.getMessage()]
    assert len(told) == 1


def test_one_that_moves_by_no_goal_of_musters_is_taken():
    there = There("nav2")
    there.port.send([Waypoint(FAR)])
    there.pass_by(2.0, 1.0)
    there.port.cancel()
    there.pass_by(5.0, 0.0)
    assert not there.port.telemetry().suspended
    there.pass_by(5.0, 1.0)
    assert there.port.telemetry().suspended == "another station: it moves by no goal of Muster's"
    there.pass_by(5.0, 0.0)
    assert not there.port.telemetry().suspended


def test_what_is_sent_to_a_robot_that_is_taken_is_told_when_it_is_given_back():
    there = There("nav2")
    there.port.send([Waypoint(FAR)])
    there.pass_by(1.0, 1.0)
    there.wire.actions.given[0][1].outcome = Outcome("canceled")
    there.pass_by(1.0, 1.0)
    there.port.send([Waypoint((3.0, 0.0, 0.0))])
    assert there.goals == [50.0]
    there.pass_by(6.0, 0.0)
    assert there.goals == [50.0, 3.0]


class Mortal:
    """A simulated robot on a bus that is restarted, and whose radio is off, at given times of the bus."""

    def __init__(self, robot, bus, *, restarts=(), unheard=()):
        self._robot, self._bus, self._unheard = robot, bus, unheard
        self._restarts = list(restarts)
        self._begin()

    def _begin(self):
        body = Wanted(self._robot, "", 1 / STEP_S, {})
        self._participant = self._bus.participant()
        self._body = SimulatedRobot(body, self._participant)

    def step(self, now, by_s):
        if self._restarts and now >= self._restarts[0]:
            self._restarts.pop(0)
            self._participant.close()
            x, y, _, heading = (*self._body._body.pose[0], self._body._body.pose[1])
            self._robot = replace(self._robot, position=(x, y), heading_deg=math.degrees(heading))
            self._begin()
        if not any(begin <= now < end for begin, end in self._unheard):
            self._body.step(now, by_s)
        else:
            self._body._body.step(now, by_s)


def carried_out(**faults):
    """A mission of two robots of which `r_0` has faults: its report, and what happened."""
    robots = tuple(
        Robot(id=f"r_{k}", position=(0.0, 4.0 * k), radius_m=0.2, speed_mps=1.0, kinematics="holonomic")
        for k in range(2)
    )
    tasks = tuple(Task(id=f"t_{k}", position=(8.0 + 4 * (k // 2), 4.0 * (k % 2))) for k in range(4))
    there, bus, events = Mission(robots=robots, tasks=tasks), Bus(), []
    bus.robots += [Mortal(robots[0], bus, **faults), Mortal(robots[1], bus)]
    fleet = Ros2Fleet(there, Ros2Settings(known_only=True), middleware=bus.participant(moves=True), clock=bus.clock)
    while fleet.robots_not_ready():
        fleet.advance(fleet.time_s + 0.1)
    plan = muster.solve(there, "greedy")
    report = muster.carry_out(there, plan, fleet, traffic="free", on_event=events.append)
    fleet.close()
    return report, [(event.kind, event.data.get("robot")) for event in events]


def test_a_mission_goes_on_with_a_robot_that_restarts_and_is_given_its_goal_again():
    report, events = carried_out(restarts=[4.0, 11.0])
    assert sorted(report.tasks_done) == ["t_0", "t_1", "t_2", "t_3"]
    out = {"robot_silent", "robot_stuck", "robot_sent_again", "robot_fails"}
    assert [kind for kind, _ in events if kind in out] == []  # the executor has not noticed


def test_a_mission_goes_on_with_a_robot_that_is_away_for_a_while():
    report, events = carried_out(unheard=[(3.0, 10.0)])
    assert sorted(report.tasks_done) == ["t_0", "t_1", "t_2", "t_3"]
    assert ("robot_silent", "r_0") in events
    assert ("robot_returns", "r_0") in events
