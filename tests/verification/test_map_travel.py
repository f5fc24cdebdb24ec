"""Plans over a map, judged: legs, what cannot be reached, and how exact figures have to be."""

import math
from dataclasses import replace

import pytest

from muster.mission.errors import MissionError
from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone
from muster.mission.plan import Plan, Route
from muster.verification import verify
from muster.verification.travel import Travel

ARENA = ((0, 0), (40, 0), (40, 40), (0, 40))
SQUARE = ((15, 15), (25, 15), (25, 25), (15, 25))
AROUND = 10 + 2 * math.hypot(5, 5)


def mission(*tasks, zone=None, robot=None, **rules):
    zone = Zone(polygon=SQUARE, **(zone or {}))
    robot = Robot(**({"id": "r", "position": (10, 20)} | (robot or {})))
    return Mission(map=Map(boundary=ARENA, zones=(zone,)), rules=Rules(**rules), robots=(robot,), tasks=tasks)


def judge(question, *tasks, **figures):
    return verify(question, Plan(routes=(Route("r", tasks),), **figures))


def found(verdict):
    return [(violation.kind, violation.robot, violation.task) for violation in verdict.violations]


def test_a_leg_goes_around():
    verdict = judge(mission(Task(id="a", position=(30, 20))), "a")
    assert verdict.valid
    assert verdict.total_cost == pytest.approx(AROUND, rel=1e-7)


def test_straight_lines_count_where_the_rules_say_so():
    assert judge(mission(Task(id="a", position=(10, 40)), travel="euclidean"), "a").total_cost == 20
    verdict = judge(mission(Task(id="a", position=(30, 20)), travel="euclidean"), "a")
    assert found(verdict) == [("closed-area", "r", "a")]


def test_a_leg_goes_from_exit_to_entry():
    tasks = (
        Task(id="a", position=(1, 1), entry=(10, 30), exit=(20, 30)),
        Task(id="b", position=(39, 39), entry=(20, 10), exit=(30, 10)),
    )
    verdict = judge(mission(*tasks, return_to_start=True), "a", "b")
    expected = 10 + (10 + 2 * math.hypot(5, 5)) + math.hypot(5, 5) + math.hypot(15, 5)
    assert verdict.total_cost == pytest.approx(expected, rel=1e-7)


def test_each_radius_and_kind_has_its_ways():
    question = mission(Task(id="a", position=(30, 20)), zone={"forbidden_to": ("ground",)}, robot={"radius_m": 1.0})
    drone = replace(question.robots[0], id="d", kind="air")
    small = replace(question.robots[0], id="s", radius_m=0.0)
    question = replace(question, robots=(*question.robots, drone, small))
    legs = [judge_length(question, robot) for robot in question.robots]
    assert legs[0] > legs[2] == pytest.approx(AROUND, rel=1e-7)
    assert legs[1] == 20


def judge_length(question, robot):
    from muster.verification.travel import place_of_start, place_of_task

    return Travel(question).metres(robot, place_of_start(robot), place_of_task(question.tasks[0]))


@pytest.mark.parametrize("place", [(20, 20), (41, 1), (14.5, 20)])
def test_a_blocked_task_is_unreachable(place):
    tasks = (Task(id="a", position=place, actuation_cost=2), Task(id="b", position=(10, 21)))
    verdict = judge(mission(*tasks, robot={"radius_m": 1.0}), "a", "b")
    assert found(verdict) == [("closed-area", "r", "a"), ("unreachable", "r", "b")]
    assert verdict.total_cost == 2


def test_a_task_behind_a_wall_is_unreachable():
    wall = Zone(polygon=((19, -1), (21, -1), (21, 41), (19, 41)))
    question = replace(mission(Task(id="a", position=(30, 20))), map=Map(boundary=ARENA, zones=(wall,)))
    assert found(judge(question, "a")) == [("unreachable", "r", "a")]


@pytest.mark.parametrize(("factor", "valid"), [(1 + 0.5e-6, True), (1 + 3e-6, False)])
def test_figures_in_the_plane_are_exact(factor, valid):
    verdict = judge(mission(Task(id="a", position=(30, 20))), "a", total_cost=AROUND * factor)
    assert verdict.valid == valid


@pytest.mark.parametrize(("factor", "valid"), [(1 - 0.5e-6, True), (1 - 3e-6, False)])
def test_capacity_in_the_plane_is_exact(factor, valid):
    question = mission(Task(id="a", position=(30, 20)), robot={"work_capacity": AROUND * factor})
    assert judge(question, "a").valid == valid


def drone(**robot):
    robot = {"position": (10, 20, 1), "kind": "air"} | robot
    return mission(Task(id="a", position=(30, 20, 1)), zone={"ceiling_m": 3}, robot=robot)


OVER = 10 + 2 * math.hypot(5, 2)


@pytest.mark.parametrize("factor", [0.98, 0.993, 1.007, 1.02])
def test_figures_and_capacity_in_the_air_are_within_a_hundredth(factor):
    assert judge(drone(), "a").total_cost == pytest.approx(OVER, rel=3e-3)
    within = abs(factor - 1) < 0.01
    assert judge(drone(), "a", total_cost=OVER * factor).valid == within
    assert judge(drone(), "a", makespan_s=OVER * factor).valid == within
    assert judge(drone(work_capacity=OVER * factor), "a").valid == (factor > 0.99)


def test_the_index_of_equality_in_the_air():
    question = drone()
    idle = replace(question.robots[0], id="s", position=(1, 1, 1))
    question = replace(question, robots=(*question.robots, idle))
    for stated, valid in ((0.5, True), (0.515, True), (0.53, False)):
        assert judge(question, "a", equality_index=stated).valid == valid


def test_a_ground_robot_in_a_mission_with_heights():
    question = mission(Task(id="a", position=(30, 20, 4)), zone={"ceiling_m": 3}, robot={"position": (10, 20, 1)})
    assert judge(question, "a").total_cost == pytest.approx(math.hypot(AROUND, 3), rel=1e-7)


def test_a_map_that_is_wrong():
    crossed = Map(boundary=((0, 0), (9, 9), (9, 0), (0, 9)))
    with pytest.raises(MissionError, match="crosses itself"):
        judge(replace(mission(), map=crossed))
