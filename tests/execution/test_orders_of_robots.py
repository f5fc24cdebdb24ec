"""What a robot is ordered to pass, and how much of it leads to where it goes."""

import pytest

from muster.execution.robots.robot_state import Activity, RobotState
from muster.mission.model import Robot
from muster.motion.leg_times import LegTimes
from muster.motion.port import Telemetry, Waypoint
from muster.state.robots import KnownRobot

ROBOT = Robot(id="r", position=(0.0, 0.0))
MARKS = [Waypoint((float(x), 0.0, 0.0), via=True) for x in range(1, 5)]
TASK, HOME = Waypoint((5.0, 0.0, 0.0)), Waypoint((0.0, 1.0, 0.0))


class Port:
    robot = "r"

    def __init__(self):
        self.orders, self.passed = [], 0

    def send(self, waypoints):
        self.orders.append(list(waypoints))
        self.passed = 0
        return len(self.orders)

    def cancel(self):
        return self.send(())

    def telemetry(self):
        return Telemetry(float(len(self.orders)), (0, 0, 0), 0.0, (0, 0, 0), 0.0, len(self.orders), self.passed)


@pytest.fixture
def state():
    """A robot that has driven to a task by way of four marks."""
    state = RobotState(ROBOT, KnownRobot(ROBOT), Port(), None, LegTimes(1.0), in_time=False, last_heard_s=0.0)
    state.send(0.0, Activity.DRIVING, [*MARKS, TASK], to_task=5)
    return state


def heard(state, passed):
    state.port.passed = passed
    state.hear(float(len(state.port.orders)))


def test_on_its_way_home_it_goes_another_way_though_its_last_order_was_longer(state):
    state.send(1.0, Activity.RETURNING, [HOME])
    heard(state, 0)
    state.go_other_ways(2.0, [[MARKS[0], HOME]])
    assert [point.position for point in state.port.orders[-1]] == [MARKS[0].position, HOME.position]
    assert state.to_task == 2


def test_what_is_left_of_an_order_leads_to_its_task_as_before(state):
    heard(state, 3)
    state.send_again(1.0)
    assert (len(state.port.orders[-1]), state.to_task) == (2, 2)
    heard(state, 0)
    state.go_other_ways(2.0, [[*MARKS[:2], TASK]])
    assert (len(state.port.orders[-1]), state.to_task) == (3, 3)
