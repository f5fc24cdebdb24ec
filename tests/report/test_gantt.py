import sys
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from tests import carry_charge

from muster.mission.errors import MissingExtraError, MusterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Route
from muster.report import plot_gantt, plot_routes
from muster.report.figures.canvas import new_axes
from muster.report.figures.styles import SERVICE, robot_style
from muster.report.time_charts import level_lines
from muster.verification import verify


def bars(collections):
    """Start, length, middle and height of every bar of the only collection."""
    (collection,) = collections
    boxes = [path.get_extents() for path in collection.get_paths()]
    return [(box.x0, box.width, (box.y0 + box.y1) / 2, box.height) for box in boxes]


def test_bars_are_the_visits(mission, plan, verdict, drawn):
    ax = plot_gantt(mission, verdict)
    for row, route in enumerate(verdict.routes[:2]):
        found = [(start, length, middle) for start, length, middle, _ in bars(drawn(ax, f"work-{route.robot}"))]
        expected = [(visit.starts_s, visit.ends_s - visit.starts_s, row) for visit in route.visits]
        np.testing.assert_allclose(found, expected)


def test_travel_waiting_and_work_follow_one_another(mission, plan, verdict, drawn):
    ax = plot_gantt(mission, verdict)
    travel = [(start, length) for start, length, _, _ in bars(drawn(ax, "travel-ada"))]
    np.testing.assert_allclose(travel, [(0, 5), (7, 6), (13, 8)])
    np.testing.assert_allclose(bars(drawn(ax, "waiting-ada")), [(21, 11, 0, 0.3)])
    work = [(start, length) for start, length, _, _ in bars(drawn(ax, "work-ada"))]
    np.testing.assert_allclose(work, [(5, 2), (13, 0), (32, 1)])


def test_the_way_back_is_travel_and_who_does_not_wait_has_no_bar_for_it(mission, plan, verdict, drawn):
    ax = plot_gantt(mission, verdict)
    travel = [(start, length) for start, length, _, _ in bars(drawn(ax, "travel-bob"))]
    np.testing.assert_allclose(travel, [(0, 20), (32, 20)])
    assert drawn(ax, "waiting-bob") == []


def test_a_robot_leaves_when_it_is_available(mission, plan, drawn):
    mission = replace(mission, robots=(replace(mission.robots[0], available_from_s=4), *mission.robots[1:]))
    ax = plot_gantt(mission, verify(mission, plan))
    np.testing.assert_allclose(bars(drawn(ax, "travel-ada"))[0][:2], (4, 5))


def test_kinds_differ_in_height_and_hatching(mission, plan, verdict, drawn):
    ax = plot_gantt(mission, verdict)
    heights = {kind: bars(drawn(ax, f"{kind}-ada"))[0][3] for kind in ("travel", "waiting", "work")}
    assert heights["travel"] < heights["waiting"] < heights["work"]
    assert drawn(ax, "waiting-ada")[0].get_hatch()
    assert not drawn(ax, "work-ada")[0].get_hatch()


def test_work_that_takes_no_time_is_a_stroke(mission, plan, verdict, drawn):
    from matplotlib.colors import to_hex

    (work,) = drawn(plot_gantt(mission, verdict), "work-ada")
    assert work.get_paths()[1].get_extents().width == 0
    assert work.get_linewidth()[0] > 0
    assert to_hex(work.get_edgecolor()[0]).upper() == robot_style(0).color


def test_colours_are_those_of_the_routes(mission, plan, verdict, drawn):
    from matplotlib.colors import to_hex

    gantt, routes = plot_gantt(mission, verdict), plot_routes(mission, plan, verdict)
    for name in ("ada", "bob"):
        bar = to_hex(drawn(gantt, f"work-{name}")[0].get_facecolor()[0])
        assert bar == to_hex(drawn(routes, f"travel-{name}")[0].get_color())


def test_every_task_is_named_inside_its_bar_or_beside_it(mission, plan, verdict, drawn):
    ax = plot_gantt(mission, verdict)
    names = drawn(ax, "name")
    assert [name.get_text() for name in names] == ["a", "b", "c", "d"]
    assert [name.get_position() for name in names] == [(6, 0), (13, 0), (32.5, 0), (26, 1)]
    pixels = [name.get_transform().transform(name.get_position()) for name in names]
    middle = ax.transData.transform((0, 0))[1]
    assert pixels[0][1] == pytest.approx(middle)  # two seconds have room for a letter
    assert pixels[1][1] > middle  # no time has none: above the stroke


def test_names_beside_bars_stay_within_the_chart_and_off_each_other():
    tasks = tuple(Task(id=f"east-field-{k}", position=(1.0 + 4 * k, 0.0), duration_s=1.0) for k in range(40))
    mission = Mission(robots=(Robot(id="r", position=(0.0, 0.0)),), tasks=tasks)
    ax = plot_gantt(
        mission, verify(mission, Plan(routes=(Route("r", tuple(task.id for task in tasks)),))), ax=new_axes(5.0, 3.0)
    )
    ax.figure.canvas.draw()
    boxes = [text.get_window_extent() for text in ax.texts if (text.get_gid() or "").startswith("name-")]
    frame = ax.get_window_extent()
    assert len(boxes) > 4
    assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 for box in boxes)
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


def test_tasks_done_at_one_moment_are_named_together(drawn):
    mission = Mission(
        robots=[Robot(id="r", position=(0, 0))], tasks=[Task(id=str(k), position=(min(k, 1), 0)) for k in range(4)]
    )
    plan = Plan(routes=(Route("r", ("1", "2", "3", "0")),))
    ax = plot_gantt(mission, verify(mission, plan))
    assert [name.get_text() for name in drawn(ax, "name")] == ["1, 2, 3", "0"]


def test_rows_are_the_robots_in_mission_order_from_the_top(mission, plan, verdict):
    ax = plot_gantt(mission, verdict)
    assert [label.get_text() for label in ax.get_yticklabels()] == ["ada", "bob", "idle"]
    assert list(ax.get_yticks()) == [0, 1, 2]
    assert ax.yaxis_inverted()


def test_prerequisites_between_robots_are_arrows_in_time(mission, plan, verdict, drawn):
    ax = plot_gantt(mission, verdict)
    (arrow,) = drawn(ax, "prerequisite")  # d before c; a before b is plain from the row
    path = arrow.get_path()
    corners = path.vertices[path.codes != path.CLOSEPOLY]
    np.testing.assert_allclose(corners[0], (32, 0.75))  # the upper edge of d's bar
    assert 0.25 < corners[:, 1].min() < 0.3  # just below the lower edge of c's
    assert np.all(np.abs(corners[:, 0] - 32) < 0.5)


def test_a_prerequisite_that_was_ignored_is_no_arrow(mission, drawn):
    plan = Plan(routes=(Route("ada", ("a", "b", "c")), Route("bob", ("d",))))
    verdict = verify(mission, plan, ("prerequisite",))
    ax = plot_gantt(mission, verdict)
    assert drawn(ax, "prerequisite") == []
    assert drawn(ax, "waiting-ada") == []


def test_the_makespan_is_a_line_where_the_last_task_ends(mission, plan, verdict, drawn):
    ax = plot_gantt(mission, verdict)
    (line,) = drawn(ax, "makespan")
    assert set(line.get_xdata()) == {33}
    assert drawn(ax, "facts")[0].get_text() == "makespan 33.00 s · tasks 4/5"
    assert ax.get_xlim()[1] > 52  # bob is back


@pytest.mark.parametrize(
    ("metres", "unit", "labels"),
    [(30, "s", {"0", "5", "30"}), (1800, "min", {"0", "5", "30"}), (5 * 3600, "h", {"0", "1", "5"})],
)
def test_long_missions_are_told_in_minutes_or_hours(metres, unit, labels, drawn):
    mission = Mission(robots=[Robot(id="r", position=(0, 0))], tasks=[Task(id="t", position=(metres, 0))])
    plan = Plan(routes=(Route("r", ("t",)),))
    ax = plot_gantt(mission, verify(mission, plan))
    ax.figure.draw_without_rendering()
    assert ax.get_xlabel() == f"time [{unit}]"
    assert labels <= {label.get_text() for label in ax.get_xticklabels()}
    np.testing.assert_allclose(bars(drawn(ax, "travel-r"))[0][:2], (0, metres))  # the data stays in seconds


def test_a_deadlock_has_no_schedule(mission):
    plan = Plan(routes=(Route("ada", ("b", "a")),))
    with pytest.raises(MusterError, match=r"^no schedule to draw: .*$") as caught:
        plot_gantt(mission, verify(mission, plan))
    assert "\n" not in str(caught.value)


def test_a_large_plan_is_simplified(crowd, drawn):
    mission, plan = crowd(2_000, 200)
    ax = plot_gantt(mission, verify(mission, plan))
    assert len(drawn(ax, "work-r_199")[0].get_paths()) == 10
    assert drawn(ax, "name") == []
    assert len(ax.get_yticks()) < 60


def test_given_axes_are_drawn_on(mission, plan, verdict):
    from matplotlib.figure import Figure

    ax = Figure().add_subplot()
    assert plot_gantt(mission, verdict, ax=ax) is ax
    assert ax.collections


def test_without_tasks_there_is_an_empty_chart(mission, drawn):
    ax = plot_gantt(mission, verify(mission, Plan(routes=())))
    assert not ax.collections
    assert ax.get_xlim()[1] > ax.get_xlim()[0]


def test_without_matplotlib_it_is_said_what_to_install(mission, plan, verdict, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtraError, match=r"muster-robotics\[plot\]"):
        plot_gantt(mission, verdict)


@pytest.fixture
def charging():
    """Two robots that charge at a dock with one slot, one after the other; the second has a reserve."""
    robots = [
        carry_charge.robot(battery=carry_charge.battery(10)),
        carry_charge.robot("s", battery=carry_charge.battery(10, reserve=0.1)),
    ]
    tasks = [carry_charge.task("a", 8), carry_charge.task("b", 7)]
    return carry_charge.mission(robots, tasks, [carry_charge.charger(x=6)])


def test_service_at_a_station_is_a_bar_of_its_own_colour_and_name(charging, drawn):
    from matplotlib.colors import to_hex

    ax = plot_gantt(charging, carry_charge.judged(charging, r="dock a", s="dock b"))
    assert [bar[:3] for bar in bars(drawn(ax, "service-r"))] == [(6, 6, 0)]
    assert [bar[:3] for bar in bars(drawn(ax, "service-s"))] == [(12, 6, 1)]
    assert [bar[:3] for bar in bars(drawn(ax, "waiting-s"))] == [(6, 6, 1)]
    assert [bar[:2] for bar in bars(drawn(ax, "travel-s"))] == [(0, 6), (18, 1)]
    assert to_hex(drawn(ax, "service-r")[0].get_facecolor()[0]).upper() == SERVICE
    assert [name.get_text() for name in drawn(ax, "name")] == ["[dock]", "a", "[dock]", "b"]


def test_the_level_of_a_battery_is_a_line_beneath_the_bars(charging, drawn):
    ax = plot_gantt(charging, carry_charge.judged(charging, r="dock a", s="dock b"))
    (level,) = drawn(ax, "level-1")
    empty, full = (level_lines._height(1, share) for share in (0, 1))
    times, shares = level.get_xdata(), (np.array(level.get_ydata()) - empty) / (full - empty)
    np.testing.assert_allclose(np.interp([0, 6, 12, 18, 19], times, shares), [1, 0.4, 0.4, 1, 0.9])
    assert 1.25 < full < empty < 1.5
    (reserve,) = drawn(ax, "reserve-1")
    np.testing.assert_allclose(reserve.get_ydata(), level_lines._height(1, 0.1))
    assert drawn(ax, "reserve-0") == []


def test_without_batteries_there_is_no_level(mission, verdict, drawn):
    assert drawn(plot_gantt(mission, verdict), "level") == []
