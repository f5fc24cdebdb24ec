"""The work of plain tasks: where, how long, and what it costs."""

import pytest

from muster import Robot, Task
from muster.execution.doing import path_length, plain, plain_work_s, straight
from muster.mission.model import Action


@pytest.mark.parametrize(
    ("task", "lasts"),
    [
        ({"duration_s": 6.0, "actuation_cost": 3.0}, 12.0),
        ({"actuation_cost": 3.0}, 1.5),
        ({"action": Action(name="sensor-activation", duration_s=2.0)}, 4.0),
        ({}, 0.0),
    ],
)
def test_the_time_of_work(task, lasts):
    robot = Robot(id="r", position=(0, 0), speed_mps=2, efficiency=0.5)
    task = Task(id="t", position=(5, 5), **task)
    assert plain_work_s(task, robot) == lasts
    doing = plain(task, robot)
    assert sum(waypoint.hold_s for waypoint in doing.waypoints) == lasts
    assert doing.entry == doing.exit == (5, 5, 0)
    assert doing.cost_m == task.actuation_cost


def test_a_robot_is_at_the_exit_when_the_work_ends():
    robot = Robot(id="r", position=(0, 0))
    task = Task(id="t", position=(0, 0), duration_s=10, entry=(1, 0), exit=(4, 0))
    doing = plain(task, robot)
    assert (doing.entry, doing.exit) == ((1, 0, 0), (4, 0, 0))
    assert [waypoint.position for waypoint in doing.waypoints] == [(1, 0, 0), (4, 0, 0)]
    assert sum(waypoint.hold_s for waypoint in doing.waypoints) + path_length(doing.entry, doing.waypoints) == 10


def test_a_way_to_the_exit_that_is_longer_than_the_work_is_gone_all_the_same():
    doing = plain(Task(id="t", position=(0, 0), exit=(4, 0)), Robot(id="r", position=(0, 0)))
    assert sum(waypoint.hold_s for waypoint in doing.waypoints) == 0
    assert doing.waypoints[-1].position == doing.exit


def test_the_straight_way_is_the_goal():
    assert straight(Robot(id="r", position=(0, 0)), (0, 0, 0), (3, 4, 0)) == ((3, 4, 0),)
