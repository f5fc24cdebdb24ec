"""A Gantt chart of a recorded mission: a row for each robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from muster.report.figures.canvas import add_legend, add_title, note_entries
from muster.report.figures.fonts import Names
from muster.report.maps.recorded_tracks import outcome
from muster.report.maps.route_ground import drawn_prerequisites
from muster.report.record import Recording
from muster.report.time_charts.activity_spans import SERVICE, TRAFFIC, TRAVEL, WAITING, WORK, spans
from muster.report.time_charts.level_lines import recorded_level
from muster.report.time_charts.time_chart import Row, Service, TimeChart, Work, duration, lasting, new_chart_axes
from muster.report.time_charts.time_limits import draw_limits

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_flown_gantt(recording: Recording) -> Axes:
    """Draw when each robot travelled, worked, was served and waited, at tasks, at stations and in traffic.

    There is a row for each robot of the mission, then for those that joined.

    Looks like `plot_gantt`, with what the mission asked of tasks that were added too. The lines are the end of the
    mission, and the makespan of the plan that it began with.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    mission, tasks = recording.mission, recording.tasks
    rows, until_s = recorded_rows(recording), recording.duration_s
    ax = new_chart_axes(len(rows), levels=any(row.level is not None for row in rows))
    planned = [version.plan.makespan_s for version in recording.plans[:1] if version.plan.makespan_s is not None]
    chart = TimeChart(
        rows=rows,
        prerequisites=drawn_prerequisites(tasks),
        until_s=max([until_s, *planned]),
        lines=((until_s, "end"), *((at_s, "planned makespan") for at_s in planned)),
    )
    names = Names(mission)
    with names.fonts():
        entries = [*chart.draw(ax, names), *draw_limits(ax, tasks, rows, mission.starts_at)]
        facts = [duration(until_s), *outcome(recording)]
        add_title(ax, names.title(mission.name), facts, "" if recording.complete else "the record breaks off")
        add_legend(ax, [*entries, *note_entries(names)])
        chart.write_names(ax, names)
    return ax


def recorded_rows(recording: Recording) -> tuple[Row, ...]:
    """What each robot did over time, a row each: the robots of the mission, then those that joined."""
    found = spans(recording.events, recording.duration_s)
    rows = []
    for robot in recording.robots:
        own = [span for span in found if span.robot == robot.id]
        rows.append(
            Row(
                robot=robot.id,
                work=tuple(Work(span.task, span.from_s, span.until_s) for span in own if span.kind == WORK),
                travel=lasting((span.from_s, span.until_s) for span in own if span.kind == TRAVEL),
                waiting=lasting((span.from_s, span.until_s) for span in own if span.kind == WAITING),
                traffic=lasting((span.from_s, span.until_s) for span in own if span.kind == TRAFFIC),
                services=tuple(
                    Service(span.station, span.from_s, span.until_s) for span in own if span.kind == SERVICE
                ),
                level=recorded_level(recording, robot, own),
            )
        )
    return tuple(rows)
