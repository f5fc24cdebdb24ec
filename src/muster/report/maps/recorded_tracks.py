"""The robots' tracks in a recorded mission, on the map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.model import Mission
from muster.report.figures.canvas import (
    add_legend,
    add_title,
    frame_of_map,
    limits,
    named_rows,
    new_axes,
    note_entries,
    shortened,
    write,
)
from muster.report.figures.fonts import Names
from muster.report.figures.styles import ALARM, LEFT_OUT, QUIET_TEXT, TEXT, robot_style
from muster.report.maps.explored_ground import draw_explored
from muster.report.maps.floor import draw_map, map_corners
from muster.report.maps.station_marks import draw_stations, station_names
from muster.report.record import Recording
from muster.report.route_lines import Places, places
from muster.state.mission_state import CANCELLED, DONE, OPEN

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LONG_SIDE_IN = 6.6
_MOST_NAMED = 80


def plot_flown(recording: Recording) -> Axes:
    """Draw the tracks of all robots, where they begin and end, and what became of the tasks.

    Returns
    -------
    The axes, in metres of the map frame, equal in scale; 3-D for a 3-D mission.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    dimensions = recording.mission.dimensions
    low, high = _limits(recording)
    size = high - low
    wide, tall = (_LONG_SIDE_IN, _LONG_SIDE_IN) if dimensions == 3 else _LONG_SIDE_IN * size / size.max()
    legend_height = 0.19 * (named_rows(len(recording.robots)) + 6) + 0.6
    ax: Any = new_axes(wide + 2.6, max(tall + 1.0, legend_height), spatial=dimensions == 3)
    frame_of_map(ax, low, high)
    names = Names(recording.mission)
    with names.fonts():
        _draw(ax, recording, names)
    return ax  # type: ignore[no-any-return]


def outcome(recording: Recording) -> list[str]:
    """The outcome of a mission in words."""
    states = list(recording.outcome.stages.values())
    facts = [f"tasks {states.count(DONE)}/{len(states)}"]
    report = recording.report or {}
    if report.get("min_distance_m") is not None:
        facts.append(f"least distance {report['min_distance_m']:.2f} m")
    if report.get("contacts"):
        facts.append(f"contacts {report['contacts']}")
    return facts


def _draw(ax: Any, recording: Recording, names: Names) -> None:
    chart, spatial = recording.mission.map, recording.mission.dimensions == 3
    ground = [] if chart is None else draw_map(ax, chart, recording.image, spatial=spatial)
    if recording.outcome.explored is not None:
        ground += draw_explored(ax, recording.outcome.explored)
    stations = _draw_stations(ax, recording.mission, names)
    entries = [
        *_draw_tracks(ax, recording, names),
        *_draw_tasks(ax, recording, names),
        *stations,
        *ground,
        *note_entries(names),
    ]
    add_legend(ax, entries)
    facts = [f"{recording.duration_s:.1f} s", *outcome(recording)]
    add_title(ax, names.title(recording.mission.name), facts, "" if recording.complete else "the record breaks off")


def _draw_stations(ax: Any, mission: Mission, names: Names) -> list[tuple[Any, str]]:
    entries = draw_stations(ax, places([station.position for station in mission.stations], mission.dimensions))
    for position, text, look in station_names(mission, names):
        write(ax, places([position], mission.dimensions)[0], shortened(text), (0, 9), halo=True, **look)
    return entries


def _draw_tracks(ax: Any, recording: Recording, names: Names) -> list[tuple[Any, str]]:
    tracks, dimensions, entries = recording.tracks, recording.mission.dimensions, []
    for k, robot in enumerate(tracks.robots):
        way, style = tracks.positions[:, k, :dimensions], robot_style(k)
        (line,) = ax.plot(*way.T, color=style.color, linewidth=1.4, zorder=3, gid=f"track-{robot}")
        there = way[np.isfinite(way).all(axis=1)]
        for marker, end in (("s", there[:1]), (style.marker, there[-1:])):
            ax.plot(*end.T, linestyle="none", marker=marker, markersize=6, color=style.color, zorder=4)
        if k < named_rows(len(tracks.robots)):
            entries.append((line, shortened(names.robot(robot))))
    return entries


def _draw_tasks(ax: Any, recording: Recording, names: Names) -> list[tuple[Any, str]]:
    mission_state = recording.outcome
    colors = {DONE: TEXT, OPEN: LEFT_OUT}
    entries = {}
    for name, task in mission_state.tasks.items():
        place, state = places([task.position], recording.mission.dimensions), mission_state.stage(name)
        if state == CANCELLED and mission_state.explored is not None:  # frontiers that were seen by others
            continue
        look = {"color": colors.get(state, ALARM), "markerfacecolor": TEXT if state == DONE else "white"}
        (mark,) = ax.plot(*place.T, linestyle="none", marker="o", markersize=4.5, zorder=5, gid=f"task-{name}", **look)
        entries[f"task {state}"] = mark
        if len(mission_state.tasks) <= _MOST_NAMED:
            write(ax, place[0], shortened(names.task(name)), (0, 8), halo=True, color=QUIET_TEXT, fontsize=7, zorder=6)
    return [(mark, label) for label, mark in entries.items()]


def _limits(recording: Recording) -> tuple[Places, Places]:
    """Find the lower and upper corner of the picture, metres: all that is drawn, and a margin."""
    mission, dimensions = recording.mission, recording.mission.dimensions
    flown = recording.tracks.positions[:, :, :dimensions].reshape(-1, dimensions)
    corners = [] if mission.map is None else map_corners(mission.map, recording.image)
    tasks = recording.outcome.tasks.values()
    stops = [*(task.position for task in tasks), *(station.position for station in mission.stations)]
    still = places([*stops, *(robot.position for robot in recording.robots)], dimensions)
    points = np.vstack([flown[np.isfinite(flown).all(axis=1)], still, places(corners, dimensions)])
    return limits(points, 0.06, on_ground=mission.map is not None)
