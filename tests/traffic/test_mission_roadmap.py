"""The roadmap of a mission: which robots share it, and where their places are."""

import pytest

from muster.mission.errors import ParameterError
from muster.mission.lanes import Lane, Lanes
from muster.mission.model import Action, Map, Mission, Robot, Task
from muster.traffic.mission_roadmap import MissionRoadmap

ROVER = Robot(id="rover", position=(1, 1), radius_m=0.3, end_position=(9, 1))
CART = Robot(id="cart", position=(2, 3), radius_m=0.5)
DRONE = Robot(id="drone", position=(5, 5), radius_m=0.9, kind="air")
TASKS = (
    Task(id="a", position=(8, 8)),
    Task(id="b", position=(4, 4), action=Action(name="delivery", pickup=(6, 2))),
)
HALL = Map(boundary=((0, 0), (10, 0), (10, 10), (0, 10)))


def test_robots_that_drive_share_it_a_layer_for_each_size():
    made = MissionRoadmap.of(Mission(robots=(ROVER, CART, DRONE), tasks=TASKS, map=HALL))
    assert [robot.id for robot in made.robots] == ["rover", "cart"]
    assert made.roadmap.radii_m.tolist() == [0.3, 0.5]
    tasks = {(8, 8), (6, 2), (4, 4)}
    assert [set(points) for points in made.point_of] == [{(1, 1), (9, 1), *tasks}, {(2, 3), *tasks}]
    for layer, points in enumerate(made.point_of):
        for place, point in points.items():
            assert tuple(made.roadmap.points[point]) == pytest.approx(place)
            assert made.roadmap.layer[point] == layer
    assert made.points([(8, 8), (1, 1, 0)], ROVER) == [made.point_of[0][8, 8], made.point_of[0][1, 1]]
    assert made.points([(8, 8)], CART) == [made.point_of[1][8, 8]]


def test_without_a_map_it_covers_the_open_area_around_the_places():
    made = MissionRoadmap.of(Mission(robots=(ROVER,), tasks=TASKS))
    assert min(made.point_of[0].values()) >= 0
    assert (made.roadmap.points.min(axis=0) < (1, 1)).all()
    assert (made.roadmap.points.max(axis=0) > (9, 8)).all()


def test_given_lanes_replace_the_map_as_their_source():
    nodes = {"west": (1, 1), "east": (9, 1), "out": (9, 12)}
    lanes = Lanes(
        nodes=nodes,
        edges=(Lane(start="west", end="east", both_ways=True, capacity=1), Lane(start="east", end="out", capacity=1)),
    )
    made = MissionRoadmap.of(Mission(robots=(ROVER,), tasks=(), map=HALL, lanes=lanes))
    assert made.roadmap.edges.tolist() == [[0, 1], [1, 0]]
    assert made.point_of == ({(1, 1): 0, (9, 1): 1},)
    assert [(lane.number, lane.reason) for lane in made.closed[0]] == [(1, "too near to an obstacle for radius 0.3 m")]


def test_robots_without_a_radius_share_any_lane():
    with pytest.raises(ParameterError, match="radius_m: 0 for all robots"):
        MissionRoadmap.of(Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=()))
