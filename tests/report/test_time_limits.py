from dataclasses import replace

import numpy as np
import pytest

from muster.report import plot_gantt
from muster.report.figures.styles import ALARM
from muster.verification import verify

# In the plan of conftest ada works at a from 5 to 7 s, at b at 13 s and at c from 32 to 33 s; bob at d from 20 to 32 s.


def changed(mission, **keys):
    """The mission with keys of some tasks changed."""
    tasks = tuple(replace(task, **keys.get(task.id, {})) for task in mission.tasks)
    return replace(mission, tasks=tasks)


def chart(mission, plan):
    return plot_gantt(mission, verify(mission, plan))


def box(artist):
    return [path.get_extents() for path in artist.get_paths()]


def test_windows_are_shaded_in_the_row_of_the_robot(mission, plan, drawn):
    ax = chart(changed(mission, c={"window_s": ((1.0, 2.0), (34.0, 40.0))}, d={"window_s": ((5.0, None),)}), plan)
    (window,) = drawn(ax, "window-c")
    assert [(b.x0, b.x1) for b in box(window)] == [(1, 2), (34, 40)]
    assert [(b.y0 + b.y1) / 2 for b in box(window)] == pytest.approx([0, 0])
    (open_one,) = drawn(ax, "window-d")
    assert (box(open_one)[0].x0, box(open_one)[0].x1) == (5, pytest.approx(ax.get_xlim()[1]))
    assert "time window" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_lateness_is_red_from_the_due_time_to_the_end(mission, plan, drawn):
    from matplotlib.colors import to_hex

    ax = chart(changed(mission, d={"due_s": 25.0}, c={"due_s": 33.5}), plan)
    (late,) = drawn(ax, "late")
    assert late.get_gid() == "late-d"
    assert (box(late)[0].x0, box(late)[0].x1) == (25, 32)
    assert to_hex(late.get_facecolor()[0]).upper() == ALARM
    assert [list(line.get_xdata()) for line in drawn(ax, "due")] == [[33.5, 33.5], [25, 25]]


def test_deadlines_are_strokes(mission, plan, drawn):
    ax = chart(changed(mission, d={"deadline_s": 40.0}), plan)
    (stroke,) = drawn(ax, "deadline")
    np.testing.assert_allclose(stroke.get_xdata(), [40, 40])


def test_bars_of_a_team_are_linked_where_it_begins(mission, plan, drawn):
    both = replace(plan, routes=tuple(replace(r, tasks=(*r.tasks, "e")) for r in plan.routes))
    mission = changed(mission, e={"robots_needed": 2, "actuation_cost": 3})
    ax = chart(mission, both)
    (link,) = drawn(ax, "team-e")
    begins = {visit.starts_s for route in verify(mission, both).routes for visit in route.visits if visit.task == "e"}
    assert set(link.get_xdata()) == begins
    assert list(link.get_ydata()) == [0, 1]


def test_the_axis_is_in_clock_time_where_the_mission_has_a_start(mission, plan):
    ax = chart(replace(mission, starts_at="2027-03-01T08:00:00+01:00"), plan)
    assert ax.xaxis.get_major_formatter()(30, 0) == "08:00:30"
    assert ax.get_xlabel() == "clock time"


def test_without_limits_nothing_is_added(mission, plan, drawn):
    ax = chart(mission, plan)
    assert not any(drawn(ax, name) for name in ("window", "late", "deadline", "due", "team"))
    assert ax.get_xlabel() == "time [s]"
