"""The map beneath the routes."""

from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone
from muster.mission.plan import Plan
from muster.motion.grid import Grid
from muster.motion.path import NoPath
from muster.report.maps.floor import draw_map, map_corners, map_outlines, wall_places
from muster.report.maps.path_picture import plot_way
from muster.report.maps.routes import plot_routes
from muster.verification import verify

BLOCKED = np.array([[True, False, False], [False, False, True]])
TURNED = Grid(BLOCKED, 2.0, (10.0, 20.0, np.pi / 2))
CHART = Map(image="floor.png", resolution_m=2)


def test_an_image_lies_where_origin_and_yaw_place_it(drawn):
    from matplotlib.figure import Figure

    ax = Figure().add_subplot()
    ax.set_xlim(0, 30)
    ax.set_ylim(0, 30)
    draw_map(ax, CHART, TURNED, spatial=False)
    (image,) = drawn(ax, "image")
    np.testing.assert_array_equal(image.get_array(), BLOCKED)
    to_data = image.get_transform() - ax.transData
    np.testing.assert_allclose(to_data.transform([(0, 0), (6, 0), (0, 4)]), [(10, 20), (10, 26), (6, 20)], atol=1e-9)
    assert image.origin == "lower"
    np.testing.assert_allclose(image.get_extent(), (0, 6, 0, 4))


def test_the_page_is_grey_where_a_cell_is_blocked():
    """Each cell's middle has its colour on the page."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3, 3), dpi=100)
    ax = figure.add_axes((0, 0, 1, 1))
    ax.set_xlim(5, 11)
    ax.set_ylim(20, 26)
    draw_map(ax, CHART, TURNED, spatial=False)
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    page = np.asarray(canvas.buffer_rgba())[::-1]
    for (row, column), blocked in np.ndenumerate(BLOCKED):
        place = TURNED.to_map(np.array([[column + 0.5, row + 0.5]]))
        x, y = ax.transData.transform(place)[0].astype(int)
        assert (page[y, x, 0] < 250) == blocked


def test_on_3d_axes_walls_are_lines_on_the_ground(drawn):
    from matplotlib.figure import Figure

    ax = Figure().add_subplot(projection="3d")
    draw_map(ax, CHART, Grid(np.array([[False]]), 2.0), spatial=True)
    (lines,) = drawn(ax, "image")
    assert len(lines._segments3d) == 4  # the four sides of the one free cell
    assert np.ptp(np.asarray(lines._segments3d)[..., 2]) == 0


def test_corners_of_a_map():
    zone = Zone(polygon=((1, 1), (2, 1), (2, 2)))
    np.testing.assert_allclose(map_corners(CHART, TURNED), [(10, 20), (10, 26), (6, 26), (6, 20)], atol=1e-9)
    assert map_corners(Map(boundary=((0, 0), (9, 0), (9, 9)), zones=(zone,))) == [
        (0, 0), (9, 0), (9, 9), (1, 1), (2, 1), (2, 2)
    ]  # fmt: skip
    high = Zone(polygon=((1, 1), (2, 1), (2, 2)), floor_m=3, ceiling_m=5)
    assert map_corners(Map(boundary=((0, 0), (9, 0), (9, 9)), zones=(high,)))[3:] == [(1, 1, 5), (2, 1, 5), (2, 2, 5)]


def test_outlines_are_closed():
    zone = Zone(polygon=((1, 1), (2, 1), (2, 2)))
    boundary, outline = map_outlines(Map(boundary=((0, 0), (9, 0), (9, 9)), zones=(zone,)))
    assert boundary.tolist() == [[0, 0], [9, 0], [9, 9], [0, 0]]
    assert outline.tolist() == [[1, 1], [2, 1], [2, 2], [1, 1]]


def test_walls_are_between_free_and_blocked_cells():
    free = Grid(np.array([[False]]), 2.0, (10.0, 20.0, 0.0))
    assert sorted(wall_places(free).tolist()) == [[10, 21], [11, 20], [11, 22], [12, 21]]


def test_a_picture_in_space_stands_on_the_ground_and_holds_its_zones():
    zone = Zone(polygon=((1, 1), (2, 1), (2, 2)), ceiling_m=30)
    chart = Map(boundary=((0, 0), (9, 0), (9, 9)), zones=(zone,))
    mission = Mission(map=chart, robots=(Robot(id="r", position=(5, 1, 2)),), tasks=())
    ax = plot_way(mission, NoPath("disconnected"), (5, 1, 2), (6, 1, 2), facts="")
    low, high = ax.get_zlim()
    assert low == 0
    assert high > 30


def test_names_of_places_do_not_cover_walls(drawn):
    """The name would stand on the right of the mark, where the wall is."""
    wall = Zone(polygon=((5.2, 0), (5.6, 0), (5.6, 9), (5.2, 9)))
    chart = Map(boundary=((0, 0), (9, 0), (9, 9), (0, 9)), zones=(wall,))
    for zones, left in (((), False), ((wall,), True)):
        mission = Mission(
            rules=Rules(travel="euclidean"),
            map=replace(chart, zones=zones),
            robots=(Robot(id="r", position=(1, 1)),),
            tasks=(Task(id="here", position=(5, 5)),),
        )
        plan = Plan(routes=())
        ax = plot_routes(mission, plan, verify(mission, plan))
        ax.figure.draw_without_rendering()
        (name,) = drawn(ax, "name-here")
        assert (name.get_window_extent().x1 < ax.transData.transform((5, 5))[0]) == left


@pytest.mark.parametrize(
    ("floor", "ceiling", "text"),
    [(0, 4, "to 4 m"), (None, 4, "to 4 m"), (2, 4.5, "2-4.5 m"), (3, None, "from 3 m"), (None, None, None)],
)
def test_heights_are_named(drawn, floor, ceiling, text):
    from matplotlib.figure import Figure

    ax = Figure().add_subplot()
    zone = Zone(polygon=((1, 1), (2, 1), (2, 2)), floor_m=floor, ceiling_m=ceiling)
    draw_map(ax, Map(boundary=((0, 0), (9, 0), (9, 9)), zones=(zone,)), spatial=False)
    assert [label.get_text() for label in drawn(ax, "heights")] == ([] if text is None else [text])


@pytest.mark.skipif(find_spec("shapely") is None, reason="needs the extra `map`")
def test_the_shipped_floor_plan_lies_beneath_routes(drawn):
    from dataclasses import replace

    from muster import load
    from muster.mission.plan import Plan
    from muster.report.maps.routes import plot_routes
    from muster.verification import verify

    mission = load("floor")
    mission = replace(mission, rules=replace(mission.rules, travel="euclidean"))
    plan = Plan(routes=())
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert len(drawn(ax, "image")) == 1
    assert ax.get_xlim()[0] < -1
    assert ax.get_xlim()[1] > 41
