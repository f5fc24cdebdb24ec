import sys
from dataclasses import replace

import numpy as np
import pytest
from tests import carry_charge

from muster.mission.errors import MissingExtraError
from muster.mission.model import Action, Map, Mission, Robot, Rules, Task, Zone
from muster.mission.plan import Plan, Route
from muster.report import plot_routes
from muster.report.figures.styles import LEFT_OUT, robot_style
from muster.verification import verify


def legend_of(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_robots_line_runs_from_its_start_through_its_tasks(mission, plan, verdict, drawn):
    ax = plot_routes(mission, plan, verdict)
    (line,) = drawn(ax, "travel-ada")
    np.testing.assert_array_equal(line.get_xydata(), [(0, 0), (3, 4), (3, 10), (11, 10)])
    assert line.get_linestyle() == "-"
    assert drawn(ax, "travel-idle") == []


def test_the_way_back_is_dashed_and_only_of_those_who_return(mission, plan, verdict, drawn):
    ax = plot_routes(mission, plan, verdict)
    (line,) = drawn(ax, "end-bob")
    np.testing.assert_array_equal(line.get_xydata(), [(10, 20), (10, 0)])
    assert line.is_dashed()
    assert drawn(ax, "end-ada") == []
    assert "way back" in legend_of(ax)


def test_an_end_position_is_marked(mission, plan, drawn):
    robots = (replace(mission.robots[0], end_position=(0, 9)), *mission.robots[1:])
    mission = replace(mission, robots=robots)
    ax = plot_routes(mission, plan, verify(mission, plan))
    np.testing.assert_array_equal(drawn(ax, "end-ada")[0].get_xydata(), [(11, 10), (0, 9)])
    np.testing.assert_array_equal(drawn(ax, "end-place-ada")[0].get_xydata(), [(0, 9)])
    assert "way to end" in legend_of(ax)


RASTER = Action(name="raster-search", side_m=2, height_m=1, spacing_m=2)


@pytest.mark.parametrize(
    ("change", "work"),
    [
        ({"entry": (2, 4), "exit": (4, 5)}, [(2, 4), (4, 5)]),
        ({"action": RASTER, "actuation_cost": 0}, [(2, 3), (4, 3), (4, 5), (2, 5)]),
    ],
)
def test_lines_go_to_where_the_work_on_a_task_begins_and_from_where_it_ends(mission, plan, drawn, change, work):
    mission = replace(mission, tasks=(replace(mission.tasks[0], **change), *mission.tasks[1:]))
    ax = plot_routes(mission, plan, verify(mission, plan))
    travel = [(0, 0), work[0], (np.nan, np.nan), work[-1], (3, 10), (11, 10)]
    np.testing.assert_array_equal(drawn(ax, "travel-ada")[0].get_xydata(), travel)
    np.testing.assert_array_equal(drawn(ax, "work-ada")[0].get_xydata(), work)
    np.testing.assert_array_equal(drawn(ax, "tasks-ada")[0].get_xydata()[0], (3, 4))
    assert "work" in legend_of(ax)


def test_the_picture_holds_the_way_points_of_actions(mission, plan):
    tasks = (replace(mission.tasks[0], action=Action(name="ground-patrol", side_m=80), actuation_cost=0),)
    mission = replace(mission, tasks=(*tasks, *mission.tasks[1:]))
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert ax.get_xlim()[0] < -37 < 43 < ax.get_xlim()[1]


def test_a_delivery_is_drawn_around_what_is_in_the_way(drawn):
    wall = Zone(polygon=((9, -5), (11, -5), (11, 6), (9, 6)))
    arena = Map(boundary=((-5, -20), (30, -20), (30, 20), (-5, 20)), zones=(wall,))
    task = Task(id="bring", position=(15, 0), action=Action(name="delivery", pickup=(5, 0)))
    mission = Mission(robots=(Robot(id="ada", position=(0, 0)),), tasks=(task,), map=arena)
    plan = Plan(routes=(Route("ada", ("bring",)),))
    ax = plot_routes(mission, plan, verify(mission, plan))
    np.testing.assert_allclose(drawn(ax, "work-ada")[0].get_xydata(), [(5, 0), (9, -5), (11, -5), (15, 0)], atol=1e-6)


def test_tasks_bear_their_place_in_the_route(mission, plan, verdict, drawn):
    ax = plot_routes(mission, plan, verdict)
    numbers = drawn(ax, "order")
    assert [text.get_gid() for text in numbers] == ["order-a", "order-b", "order-c", "order-d"]
    assert [text.get_text() for text in numbers] == ["1", "2", "3", "1"]
    assert [text.get_position() for text in numbers] == [(3, 4), (3, 10), (11, 10), (10, 20)]


def test_every_task_and_start_is_named_beside_its_mark(mission, plan, verdict, drawn):
    ax = plot_routes(mission, plan, verdict)
    assert [text.get_text() for text in drawn(ax, "name")] == ["a", "b", "c", "d", "e"]
    assert [text.get_text() for text in drawn(ax, "start-name")] == ["ada", "bob", "idle"]
    for name, task in zip(drawn(ax, "name"), mission.tasks, strict=True):
        mark = ax.transData.transform(task.position)
        shift = (name.get_transform().transform(task.position) - mark) * 72 / ax.figure.dpi
        assert 5.5 < np.hypot(*shift) < 20  # the mark's radius is 5.5 points


def test_names_do_not_cover_one_another(crowd, drawn):
    mission, plan = crowd(50, 5)
    ax = plot_routes(mission, plan, verify(mission, plan))
    ax.figure.draw_without_rendering()
    boxes = [name.get_window_extent() for name in drawn(ax, "name")]
    assert len(boxes) == 50
    assert not [1 for k, box in enumerate(boxes) for other in boxes[:k] if box.overlaps(other)]


def test_colours_belong_to_robots_not_to_plans(mission, plan, verdict, drawn):
    other = Plan(routes=(Route("bob", ("e",)), Route("idle", ("a",)), Route("ada", ("d",))))
    first = plot_routes(mission, plan, verdict)
    second = plot_routes(mission, other, verify(mission, other))
    for name in ("ada", "bob"):
        (one,), (two,) = drawn(first, f"travel-{name}"), drawn(second, f"travel-{name}")
        assert one.get_color() == two.get_color()
    colors = {drawn(second, f"travel-{name}")[0].get_color() for name in ("ada", "bob", "idle")}
    assert len(colors) == 3
    assert drawn(second, "travel-idle")[0].get_color() == robot_style(2).color


def test_tasks_left_out_are_grey_crosses(mission, plan, verdict, drawn):
    from matplotlib.colors import to_hex

    ax = plot_routes(mission, plan, verdict)
    (crosses,) = drawn(ax, "left-out")
    np.testing.assert_array_equal(crosses.get_xydata(), [(0, 20)])
    assert crosses.get_marker() == "x"
    red, green, blue = (int(LEFT_OUT[k : k + 2], 16) for k in (1, 3, 5))
    assert to_hex(crosses.get_color()).upper() == LEFT_OUT
    assert red == green == blue
    assert "left out (1)" in legend_of(ax)


def test_nothing_left_out_nothing_said_of_it(mission, drawn):
    plan = Plan(routes=(Route("ada", ("a", "b", "e")), Route("bob", ("d", "c"))))
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert drawn(ax, "left-out") == []
    assert not [label for label in legend_of(ax) if "left out" in label]


def test_starts_are_triangles_one_where_several_robots_start(mission, plan, drawn):
    robots = (mission.robots[0], replace(mission.robots[1], position=(0, 0)), mission.robots[2])
    mission = replace(mission, robots=robots)
    ax = plot_routes(mission, plan, verify(mission, plan))
    shared, alone = drawn(ax, "start-ada") + drawn(ax, "start-idle")
    assert len(drawn(ax, "start")) == 4  # two triangles and their names
    assert shared.get_marker() == alone.get_marker() == "^"
    np.testing.assert_array_equal(shared.get_xydata(), [(0, 0)])
    assert alone.get_color() == robot_style(2).color
    assert shared.get_color() not in {robot_style(0).color, robot_style(1).color}
    assert [text.get_text() for text in drawn(ax, "start-name")] == ["ada, bob", "idle"]


def test_the_legend_states_usage_and_capacity(mission, plan, verdict):
    ax = plot_routes(mission, plan, verdict)
    # ada: 5 + 6 + 8 m of way and 2 + 1 of work; bob: 20 m, 12 of work, 20 m back
    assert legend_of(ax)[:4] == ["ada  22.00 / 40 m", "bob  52.00 m", "idle  0.00 m", "left out (1)"]
    assert ax.get_legend().get_title().get_text() == "usage / work capacity"


def test_the_legend_lies_outside_the_axes_and_inside_the_page(mission, plan, verdict):
    ax = plot_routes(mission, plan, verdict)
    ax.figure.draw_without_rendering()
    legend = ax.get_legend().get_window_extent()
    assert legend.x0 >= ax.get_window_extent().x1
    assert legend.x1 <= ax.figure.bbox.x1
    assert legend.y0 >= 0


def test_the_title_states_mission_allocator_objective_and_tasks(mission, plan, verdict, drawn):
    ax = plot_routes(mission, plan, verdict)
    assert ax.get_title(loc="left") == "harbour"
    assert drawn(ax, "facts")[0].get_text() == "greedy · total 74.00 m · tasks 4/5"
    assert drawn(ax, "alarm") == []


def test_a_plan_that_is_not_admissible_says_so(mission, drawn):
    plan = Plan(routes=(Route("ada", ("c",)),))
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert [text.get_text() for text in drawn(ax, "alarm")] == [" · not admissible: 1 violation"]


def test_a_plan_that_deadlocks_is_drawn_without_a_makespan(mission, drawn):
    mission = replace(mission, rules=Rules(objective="makespan"))
    plan = Plan(routes=(Route("ada", ("b", "a")), Route("bob", ("d",))))
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert drawn(ax, "facts")[0].get_text() == "makespan none · tasks 3/5"


def test_scales_are_equal_and_axes_name_their_unit(mission, plan, verdict):
    ax = plot_routes(mission, plan, verdict)
    assert ax.get_aspect() == 1.0
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "y [m]")


def test_prerequisites_are_arrows(mission, plan, verdict, drawn):
    ax = plot_routes(mission, plan, verdict)
    assert len(drawn(ax, "prerequisite")) == 2
    assert "prerequisite" in legend_of(ax)


def test_too_many_prerequisites_are_not_drawn(drawn):
    tasks = [Task(id=str(k), position=(k, 0), prerequisites=[str(j) for j in range(k)]) for k in range(12)]
    mission = Mission(robots=[Robot(id="r", position=(0, 1))], tasks=tasks)
    plan = Plan(routes=(Route("r", tuple(task.id for task in tasks)),))
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert drawn(ax, "prerequisite") == []  # there are 66
    assert "prerequisite" not in legend_of(ax)


def test_boundary_and_zones_lie_beneath_the_routes(mission, plan, drawn):
    corners = ((-5, -5), (30, -5), (30, 30), (-5, 30))
    zone = Zone(polygon=((5, 5), (9, 5), (9, 9)), forbidden_to=("air",))
    mission = replace(mission, map=Map(boundary=corners, zones=(zone,)), rules=Rules(travel="euclidean"))
    ax = plot_routes(mission, plan, verify(mission, plan))
    (boundary,), (area,) = drawn(ax, "boundary"), drawn(ax, "zone")
    np.testing.assert_array_equal(boundary.get_xy()[:4], corners)
    assert area.get_hatch()
    assert max(boundary.zorder, area.zorder) < drawn(ax, "travel-ada")[0].zorder
    assert "no entry: air" in legend_of(ax)
    assert ax.get_xlim()[1] > 30


def test_given_axes_are_drawn_on(mission, plan, verdict):
    from matplotlib.figure import Figure

    ax = Figure().add_subplot()
    assert plot_routes(mission, plan, verdict, ax=ax) is ax
    assert ax.lines


def spatial():
    mission = Mission(
        robots=[Robot(id="uav", position=(0, 0, 0), return_to_start=True)],
        tasks=[
            Task(id="low", position=(4, 0, 3)),
            Task(id="high", position=(4, 0, 9), prerequisites=("low",)),
            Task(id="far", position=(8, 8, 5)),
        ],
    )
    plan = Plan(routes=(Route("uav", ("low", "high")),))
    return mission, plan, verify(mission, plan)


def test_a_3d_mission_is_drawn_in_3d(drawn):
    ax = plot_routes(*spatial())
    (line,) = drawn(ax, "travel-uav")
    np.testing.assert_array_equal(np.transpose(line.get_data_3d()), [(0, 0, 0), (4, 0, 3), (4, 0, 9)])
    np.testing.assert_array_equal(np.transpose(drawn(ax, "end-uav")[0].get_data_3d()), [(4, 0, 9), (0, 0, 0)])
    np.testing.assert_array_equal(np.transpose(drawn(ax, "left-out")[0].get_data_3d()), [(8, 8, 5)])
    assert len(drawn(ax, "prerequisite")) == 1
    assert ax.get_zlabel() == "z [m]"
    spans = np.ptp([ax.get_xlim(), ax.get_ylim(), ax.get_zlim()], axis=1)
    np.testing.assert_allclose(ax.get_box_aspect() / spans, (ax.get_box_aspect() / spans)[0])


def test_a_3d_legend_does_not_cover_the_axes():
    ax = plot_routes(*spatial())
    ax.figure.draw_without_rendering()
    boxes = [axis.get_tightbbox(ax.figure.canvas.get_renderer()) for axis in (ax.xaxis, ax.yaxis, ax.zaxis)]
    assert ax.get_legend().get_window_extent().x0 > max(box.x1 for box in boxes)


def test_on_2d_axes_a_3d_mission_is_seen_from_above(drawn):
    from matplotlib.figure import Figure

    ax = plot_routes(*spatial(), ax=Figure().add_subplot())
    np.testing.assert_array_equal(drawn(ax, "travel-uav")[0].get_xydata(), [(0, 0), (4, 0), (4, 0)])


def test_zones_of_a_3d_mission_are_drawn_at_floor_and_ceiling(drawn):
    mission, plan, _ = spatial()
    zone = Zone(polygon=((1, 1), (2, 1), (2, 2)), floor_m=2, ceiling_m=4)
    chart = Map(boundary=((-1, -1), (9, -1), (9, 9)), zones=(zone,))
    mission = replace(mission, map=chart, rules=Rules(travel="euclidean"))
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert len(drawn(ax, "zone")) == 2


def test_many_robots_differ_in_more_than_colour(crowd, drawn):
    mission, plan = crowd(60, 20)
    ax = plot_routes(mission, plan, verify(mission, plan))
    looks = set()
    for k in range(20):
        (tasks,) = drawn(ax, f"tasks-r_{k}")
        looks.add((tasks.get_color(), tasks.get_marker()))
    assert len(looks) == 20


@pytest.mark.long
def test_a_large_mission_is_simplified(crowd, drawn):
    mission, plan = crowd(2_000, 200)
    ax = plot_routes(mission, plan, verify(mission, plan))
    labels = legend_of(ax)
    assert [len(drawn(ax, f"travel-r_{k}")) for k in range(200)] == [1] * 200
    assert len(drawn(ax, "travel-r_0")[0].get_xydata()) == 11
    assert drawn(ax, "order") == drawn(ax, "name") == drawn(ax, "start-name") == []
    assert labels[19].startswith("r_19  ")
    assert labels[20] == "... and 180 more"


def test_between_few_and_many_tasks_numbers_stay_and_ids_go(crowd, drawn):
    mission, plan = crowd(100, 4)
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert len(drawn(ax, "order")) == 100
    assert drawn(ax, "name") == []


def test_ids_are_shown_as_they_are(drawn):
    mission = Mission(
        name="$x$", robots=[Robot(id="_r$1$", position=(0, 0))], tasks=[Task(id="$\\frac$", position=(1, 0))]
    )
    plan = Plan(routes=(Route("_r$1$", ("$\\frac$",)),))
    ax = plot_routes(mission, plan, verify(mission, plan))
    ax.figure.canvas.draw()  # a formula that is none would raise here
    assert legend_of(ax)[0] == "_r$1$  1.00 m"


def test_long_ids_are_cut(drawn):
    mission = Mission(
        robots=[Robot(id="r" * 200, position=(0, 0))], tasks=[Task(id="t" * 200, position=(1, 0))], name="m" * 200
    )
    plan = Plan(routes=(Route("r" * 200, ("t" * 200,)),))
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert legend_of(ax)[0] == f"{'r' * 23}…  1.00 m"
    assert drawn(ax, "name")[0].get_text() == f"{'t' * 23}…"
    assert len(ax.get_title(loc="left")) == 60


def test_a_mission_without_tasks_or_extent(drawn):
    mission = Mission(robots=[Robot(id="r", position=(1, 1))], tasks=[])
    plan = Plan(routes=())
    ax = plot_routes(mission, plan, verify(mission, plan))
    assert ax.get_xlim()[0] < 1 < ax.get_xlim()[1]
    assert len(drawn(ax, "start-r")) == 1


def test_without_matplotlib_it_is_said_what_to_install(mission, plan, verdict, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(
        MissingExtraError, match=r"drawing needs an optional part: pip install 'muster-robotics\[plot\]'"
    ):
        plot_routes(mission, plan, verdict)


@pytest.fixture
def transport():
    """One robot that carries goods past a dock; a second station is used by nobody."""
    robots = [carry_charge.robot(battery=carry_charge.battery(10))]
    tasks = [carry_charge.task("a", 2, load=1), carry_charge.task("b", 9, delivers="a")]
    return carry_charge.mission(robots, tasks, [carry_charge.charger(x=6), carry_charge.depot(x=3)])


def test_routes_pass_through_stations_which_have_a_mark_and_a_name(transport, drawn):
    verdict = carry_charge.judged(transport, r="a dock b")
    ax = plot_routes(transport, carry_charge.plan(r="a dock b"), verdict)
    np.testing.assert_array_equal(drawn(ax, "travel-r")[0].get_xydata(), [(0, 0), (2, 0), (6, 0), (9, 0)])
    np.testing.assert_array_equal(drawn(ax, "stations")[0].get_xydata(), [(6, 0), (3, 0)])
    assert [name.get_text() for name in drawn(ax, "station-name")] == ["[dock]", "[depot]"]
    assert [order.get_text() for order in drawn(ax, "order")] == ["1", "3"]  # as sheets count
    assert {"[station]", "transport"} <= set(legend_of(ax))


def test_what_is_carried_is_an_arrow_from_pick_up_to_delivery(transport, drawn):
    ax = plot_routes(transport, carry_charge.plan(r="a dock b"), carry_charge.judged(transport, r="a dock b"))
    (arrow,) = drawn(ax, "transport")
    assert arrow.get_gid() == "transport-a-b"
    assert arrow.get_linestyle() != "-"


def test_without_stations_there_is_no_mark(mission, plan, verdict, drawn):
    ax = plot_routes(mission, plan, verdict)
    assert drawn(ax, "stations") == drawn(ax, "transport") == []
