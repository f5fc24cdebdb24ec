"""Random missions of a square are the same by their seed: published figures are of these."""

from random import Random

from muster.generation.uniform import uniform_mission


def test_robots_come_before_tasks_and_x_before_y():
    mission, random = uniform_mission(Random(7), robots=2, tasks=3, side_m=20.0), Random(7)
    places = [(random.uniform(0, 20), random.uniform(0, 20)) for _ in range(5)]
    assert {robot.id: robot.position for robot in mission.robots} == dict(zip(("r_0", "r_1"), places[:2], strict=True))
    assert {task.id: task.position for task in mission.tasks} == dict(zip("012", places[2:], strict=True))
