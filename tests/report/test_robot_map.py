"""The small map of one robot's route: its stops bear the numbers that they have in the route."""

import numpy as np
import pytest

pytest.importorskip("matplotlib")
pytest.importorskip("shapely")

from muster import Action, Mission, Robot, Task, verify
from muster.mission.reading.plan_reader import plan_of
from muster.mission.stations import Battery, Station
from muster.report.canvas import new_axes
from muster.report.robot_map import draw_robot_map
from muster.report.route_lines import robot_lines

ROUTE = ["a", "dock", "b", "dock", "c"]


@pytest.fixture
def drawn():
    battery = Battery(capacity=100.0)
    robots = (Robot(id="r", position=(0.0, 0.0), battery=battery), Robot(id="far", position=(900.0, 0.0)))
    places = {"a": (10.0, 0.0), "b": (10.0, 10.0), "c": (0.0, 10.0), "left": (500.0, 500.0)}
    tasks = tuple(Task(id=name, position=place) for name, place in places.items())
    station = Station(id="dock", position=(5.0, 5.0), services=("swap",))
    mission = Mission(robots=robots, tasks=tasks, stations=(station,))
    verdict = verify(mission, plan_of({"r": ROUTE}))

    def draw(index):
        ax = new_axes(4.0, 3.0)
        draw_robot_map(ax, mission, robot_lines(mission, verdict, 2)[index])
        return ax

    return draw


def test_stops_bear_their_numbers_stations_counted(drawn):
    ax = drawn(0)
    assert {text.get_text() for text in ax.texts} == {"1", "3", "5", "2, 4"}
    (marks,) = [line for line in ax.lines if line.get_gid() == "stops-r"]
    assert marks.get_xydata().tolist() == [[10, 0], [5, 5], [10, 10], [0, 10]]


def test_the_map_shows_the_robots_own_route_alone(drawn):
    (left, right), (low, high) = drawn(0).get_xlim(), drawn(0).get_ylim()
    assert left < 0 < 10 < right < 50
    assert low < 0 < 10 < high < 50


def test_an_area_is_drawn_with_all_lanes_of_the_robot_and_its_number_among_them():
    corners = ((0.0, 0.0), (300.0, 0.0), (300.0, 100.0), (0.0, 100.0))
    cover = Action(name="coverage", area=corners, width_m=20.0)
    mission = Mission(
        robots=(Robot(id="r", position=(150.0, -20.0)),), tasks=(Task(id="a", position=(150.0, 50.0), action=cover),)
    )
    ax = new_axes(4.0, 3.0)
    (lines,) = robot_lines(mission, verify(mission, plan_of({"r": ["a"]})), 2)
    draw_robot_map(ax, mission, lines)
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    lanes = lines.lanes[~np.isnan(lines.lanes).any(axis=1)]
    assert left < lanes[:, 0].min() < lanes[:, 0].max() < right
    assert low < lanes[:, 1].min() < lanes[:, 1].max() < high
    (marks,) = [line for line in ax.lines if line.get_gid() == "stops-r"]
    assert marks.get_xydata().tolist() == lines.positions.tolist()
    assert any(patch.get_gid() == "area-0" for patch in ax.patches)


def test_a_robot_without_stops_is_at_its_start(drawn):
    ax = drawn(1)
    assert not ax.texts
    (start,) = [line for line in ax.lines if line.get_gid() == "start-far"]
    assert start.get_xydata().tolist() == [[900, 0]]
