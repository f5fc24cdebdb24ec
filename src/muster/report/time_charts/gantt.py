"""A Gantt chart of a plan: a row for each robot."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.report.figures.canvas import add_legend, add_title, alarm_of, note_entries
from muster.report.figures.fonts import Names
from muster.report.maps.route_ground import drawn_prerequisites
from muster.report.time_charts.level_lines import planned_level
from muster.report.time_charts.time_chart import Row, Service, Span, TimeChart, Work, duration, lasting, new_chart_axes
from muster.report.time_charts.time_limits import draw_limits
from muster.verification import RouteFigures, Verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_gantt(mission: Mission, verdict: Verdict, *, ax: Axes | None = None) -> Axes:
    """Draw when each robot travels, works and waits.

    A row for each robot, in mission order from the top, in the colours of `plot_routes`. Work is a high bar with the
    task's id, and a stroke where it takes no time; travel a thin bar; waiting a hatched one. Time windows are shaded,
    deadlines and due times are strokes, lateness is red, and the bars of a team are linked. The data is in seconds; the
    labels of a long mission are in minutes or hours, and clock times where the mission says when it starts.
    What a robot does at a station is a bar of its own colour with the station's id in brackets. The level of its
    battery is a line beneath the bars, from empty to full; its reserve is a dashed one.

    Raises
    ------
    MusterError
        if the plan deadlocks: it has no schedule.
    MissingExtraError
        if matplotlib is not installed.
    """
    makespan_s = verdict.makespan_s
    if makespan_s is None:
        raise MusterError("no schedule to draw: in this plan tasks wait for each other for ever; see muster verify")
    if ax is None:
        ax = new_chart_axes(len(mission.robots), levels=mission.has_batteries)
    chart = TimeChart(
        rows=plan_rows(mission, verdict),
        prerequisites=drawn_prerequisites(mission.tasks),
        until_s=max([makespan_s, *(route.back_s or 0.0 for route in verdict.routes)]),
        lines=((makespan_s, "makespan"),),
    )
    names = Names(mission)
    with names.fonts():
        entries = [*chart.draw(ax, names), *draw_limits(ax, mission.tasks, chart.rows, mission.starts_at)]
        facts = [f"makespan {duration(makespan_s)}", f"tasks {verdict.tasks_completed}/{verdict.tasks_total}"]
        add_title(ax, names.title(mission.name), facts, alarm_of(verdict))
        add_legend(ax, [*entries, *note_entries(names)])
        chart.write_names(ax, names)
    return ax


def plan_rows(mission: Mission, verdict: Verdict) -> tuple[Row, ...]:
    """The routes over time, with the levels of batteries."""
    levels = [
        None if robot.battery is None else planned_level(route, robot.battery)
        for robot, route in zip(mission.robots, verdict.routes, strict=True)
    ]
    return tuple(replace(row_of(route), level=level) for route, level in zip(verdict.routes, levels, strict=True))


def row_of(route: RouteFigures) -> Row:
    """A route over time."""
    return Row(
        robot=route.robot,
        work=tuple(Work(visit.task, visit.starts_s, visit.ends_s) for visit in route.visits),
        travel=_travel(route),
        waiting=lasting((stop.arrives_s, stop.starts_s) for stop in route.stops),
        services=tuple(Service(stop.name, stop.starts_s, stop.ends_s) for stop in route.stops if stop.is_station),
    )


def _travel(route: RouteFigures) -> tuple[Span, ...]:
    """When the robot travels, the way to where its route ends included."""
    leaves = [route.leaves_s, *(stop.ends_s for stop in route.stops)]
    arrives = [stop.arrives_s for stop in route.stops]
    if route.back_s is not None:
        arrives.append(route.back_s)
    return lasting(zip(leaves, arrives, strict=False))
