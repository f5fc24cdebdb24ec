"""Tasks as robots carry them out: where, how long, and what it costs."""

import math

import pytest

from muster import Robot, Task
from muster.execution.robots.task_motion import path_length, place, straight, work_of
from muster.mission.model import Action, Camera
from muster.motion.actions import Impossible, plan
from muster.motion.leg_times import LegTimes
from muster.motion.port import Waypoint


def around(robot, start, goal, *, at_work=False):
    """Every way makes an angle."""
    return [Waypoint((start[0], goal[1], start[2])), Waypoint(goal)]


def work(task, robot, way=straight):
    return work_of(task, robot, plan, way, LegTimes(robot.speed_mps))


def stays(work):
    return [waypoint.hold_s for waypoint in work.waypoints]


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
    found = work(task, robot)
    assert (found.lasts_s, stays(found)) == (lasts, [lasts])
    assert found.entry == found.exit == (5, 5, 0)
    assert found.cost_m == found.stayed_cost_m == task.actuation_cost


def test_a_robot_is_at_the_exit_when_the_work_ends():
    robot = Robot(id="r", position=(0, 0))
    task = Task(id="t", position=(0, 0), duration_s=10, entry=(1, 0), exit=(4, 0))
    found = work(task, robot)
    assert [waypoint.position for waypoint in found.waypoints] == [(1, 0, 0), (4, 0, 0)]
    assert (stays(found), found.lasts_s) == ([7, 0], 10)


def test_a_way_to_the_exit_that_is_longer_than_the_work_is_gone_all_the_same():
    found = work(Task(id="t", position=(0, 0), exit=(4, 0)), Robot(id="r", position=(0, 0)))
    assert stays(found) == [0, 0]
    assert found.lasts_s == 4
    assert found.exit == (4, 0, 0)


def test_way_points_of_an_action_are_gone_to_by_the_ways_and_cost_these():
    patrol = Task(id="t", position=(0, 0), action=Action(name="delivery", pickup=(-3, -4)))
    found = work(patrol, Robot(id="r", position=(0, 0), speed_mps=2), around)
    assert [waypoint.position for waypoint in found.waypoints] == [(-3, -4, 0), (-3, 0, 0), (0, 0, 0)]
    assert (found.cost_m, found.way_m, found.lasts_s) == (7, 7, 3.5)


@pytest.mark.parametrize(("duration", "left"), [(10, 3), (7, 0), (6, 0)])
def test_where_ways_are_longer_less_is_left_of_the_duration(duration, left):
    delivery = Task(id="t", position=(0, 0), duration_s=duration, action=Action(name="delivery", pickup=(-3, -4)))
    found = work(delivery, Robot(id="r", position=(0, 0)), around)
    assert stays(found) == [0, 0, left]
    assert found.lasts_s == max(7, duration)


def test_headings_are_kept():
    drone = Robot(id="d", position=(0, 0), kind="air", camera=Camera(fov_deg=60, tilt_deg=45))
    look = Action(name="stationary-observation", width_m=4, heading_deg=90)
    found = work(Task(id="t", position=(5, 5), duration_s=3, entry=(0, 0), action=look), drone, around)
    assert [waypoint.heading for waypoint in found.waypoints] == [None, None, math.radians(90)]
    assert path_length(place((0, 0)), found.waypoints) == pytest.approx(found.cost_m)


def test_without_a_way_from_one_way_point_to_the_next_it_is_impossible():
    delivery = Task(id="t", position=(0, 0), action=Action(name="delivery", pickup=(3, 0)))
    found = work(delivery, Robot(id="r", position=(0, 0)), lambda robot, start, goal, *, at_work: None)
    assert found == Impossible("unreachable: there is no way from (3, 0, 0) to (0, 0, 0)")


def test_the_straight_way_is_the_goal():
    assert straight(Robot(id="r", position=(0, 0)), (0, 0, 0), (3, 4, 0)) == (Waypoint((3, 4, 0)),)
