"""The robots' tracks in a recorded mission, on the map.

The map that robots have built, over the true one: what they have not seen, and the obstacles that they saw.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from muster.mission.model import Mission
from muster.motion.grid import Grid
from muster.report.figures.canvas import (
    add_legend,
    add_title,
    frame_of_map,
    is_spatial,
    limits,
    named_rows,
    new_axes,
    note_entries,
    shortened,
    write,
)
from muster.report.figures.fonts import Names
from muster.report.figures.styles import ALARM, LEFT_OUT, QUIET_TEXT, TEXT, WALL, robot_style
from muster.report.maps.floor import draw_map, map_corners
from muster.report.maps.station_marks import draw_stations, station_names
from muster.report.record import Recording
from muster.report.route_lines import Places, places
from muster.state.explored_map import OBSTACLE, UNSEEN, ExploredMap
from muster.state.mission_state import CANCELLED, DONE, OPEN

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_HAZE = 0.35
"""Opacity of what was not seen."""


def draw_explored(ax: Any, explored: ExploredMap) -> list[tuple[Any, str]]:
    """Draw the map on axes, in space on the ground at height 0; returns its entries for the legend."""
    from matplotlib.colors import to_rgba
    from matplotlib.patches import Patch

    cells = np.array(explored.rows)
    colors = {UNSEEN: to_rgba(WALL, _HAZE), OBSTACLE: to_rgba(TEXT)}
    if is_spatial(ax):
        _draw_in_space(ax, explored, cells, colors)
    else:
        _draw_in_plane(ax, explored, cells, colors)
    return [
        (Patch(facecolor=colors[UNSEEN]), "not seen"),
        (Patch(facecolor=colors[OBSTACLE]), "obstacle that was seen"),
    ]


def _draw_in_plane(ax: Any, explored: ExploredMap, cells: npt.NDArray[np.int64], colors: dict[int, Any]) -> None:
    from matplotlib.transforms import Affine2D

    picture = np.zeros((*cells.shape, 4))
    for value, color in colors.items():
        picture[cells == value] = color
    x, y, yaw = explored.origin
    rows, columns = cells.shape
    extent = (0.0, columns * explored.cell_m, 0.0, rows * explored.cell_m)
    view = (ax.get_xlim(), ax.get_ylim())
    placed = Affine2D().rotate(yaw).translate(x, y) + ax.transData
    ax.imshow(
        picture, origin="lower", extent=extent, transform=placed, interpolation="nearest", zorder=2, gid="explored"
    )
    ax.set_xlim(view[0])
    ax.set_ylim(view[1])


def _draw_in_space(ax: Any, explored: ExploredMap, cells: npt.NDArray[np.int64], colors: dict[int, Any]) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    frame = Grid(np.zeros(cells.shape, dtype=np.bool_), explored.cell_m, explored.origin)
    for value, color in colors.items():
        faces = _faces(cells == value, frame)
        if len(faces):
            ax.add_collection3d(Poly3DCollection(faces, facecolors=[color], zorder=0.6, gid=f"explored-{value}"))


def _faces(those: npt.NDArray[np.bool_], frame: Grid) -> npt.NDArray[np.float64]:
    """Return rectangles (n, 4, 3) on the ground, metres, one a run of such cells of a row."""
    edges = np.diff(np.pad(those, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    row, first = np.nonzero(edges == 1)
    last = np.nonzero(edges == -1)[1]
    corners = np.stack([(first, row), (last, row), (last, row + 1), (first, row + 1)]).transpose(2, 0, 1)
    flat = frame.to_map(corners.reshape(-1, 2).astype(np.float64)).reshape(-1, 4, 2)
    return np.concatenate([flat, np.zeros((*flat.shape[:2], 1))], axis=2)


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
