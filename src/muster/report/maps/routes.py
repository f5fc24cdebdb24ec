"""Draws the routes of a plan on the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.model import Mission, Point, Task
from muster.mission.plan import Plan
from muster.motion.grid import Grid
from muster.report.figures.canvas import (
    add_legend,
    add_title,
    alarm_of,
    facts_of,
    frame_of_map,
    is_spatial,
    limits,
    map_axes,
    named_rows,
    new_axes,
    note_entries,
    settle,
    shortened,
    to_points,
    write,
)
from muster.report.figures.fonts import Names
from muster.report.figures.labels import dot_obstacles, line_obstacles, mark_obstacles, place_labels, text_size
from muster.report.figures.styles import DASHED, LEFT_OUT, QUIET_TEXT, TEXT, robot_style
from muster.report.maps.area_marks import area_corners, draw_areas
from muster.report.maps.floor import draw_map, map_corners, map_image, map_outlines, wall_places
from muster.report.maps.route_ground import (
    draw_prerequisites,
    draw_stems,
    draw_transports,
    drawn_prerequisites,
    drawn_transports,
)
from muster.report.maps.route_strokes import Detail, detail_for, draw_lines, draw_tasks, stroke_of
from muster.report.maps.station_marks import draw_stations, station_names
from muster.report.route_lines import Places, RobotLines, left_out, marks_of, places, robot_lines
from muster.verification import Verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_STARTS = 30
"""Robots up to which starts are named."""
MOST_IDLE = 4
"""Robots without tasks up to which these are named like the others."""
_LONG_SIDE_IN = 6.6


def plot_routes(mission: Mission, plan: Plan, verdict: Verdict, *, ax: Axes | None = None) -> Axes:
    """Draw the routes of a plan.

    Every robot has the colour that its place in the mission gives it, whatever the plan. Tasks bear their place in the
    route and, beside the mark, their id; both are left away where there are too many to be read.

    Parameters
    ----------
    mission, plan, verdict
        the question, the answer, and what the judge says of it.
    ax
        axes to draw on; without them a new figure is made, with 3-D axes for a 3-D mission. On 2-D axes a 3-D mission
        is seen from above.

    Returns
    -------
    The axes, in metres of the map frame, equal in scale.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed, or what reads the image of a map.
    MissionError
        if the map is an image that cannot be read.
    """
    image = map_image(mission)
    spatial = mission.dimensions == 3 if ax is None else is_spatial(ax)
    scene = _scene(mission, verdict, spatial, image)
    if ax is None:
        ax = _own_axes(scene)
    with scene.names.fonts():
        _draw(ax, scene, plan, verdict)
    return ax


def _draw(ax: Any, scene: _Scene, plan: Plan, verdict: Verdict) -> None:
    frame_of_map(ax, *_limits(scene, scene.dimensions))
    entries = _draw_ground(ax, scene)
    for lines in scene.lines:
        draw_lines(ax, lines, scene.detail)
    for lines in scene.lines:
        draw_tasks(ax, lines, scene.detail)
    _draw_left_out(ax, scene)
    entries += draw_stations(ax, scene.places([station.position for station in scene.mission.stations]))
    _draw_starts(ax, scene)
    limited = any(lines.figures.capacity is not None for lines in scene.lines)
    entries = [*_robot_entries(scene, verdict.usage_unit), *_mark_entries(scene), *entries, *note_entries(scene.names)]
    add_legend(ax, entries, "usage / work capacity" if limited else "usage")
    add_title(ax, scene.names.title(scene.mission.name), facts_of(verdict, plan), alarm_of(verdict))
    _name_places(ax, scene)


@dataclass(frozen=True)
class _Scene:
    mission: Mission
    lines: list[RobotLines]
    left_out: list[Task]
    dimensions: int
    detail: Detail
    names: Names
    idle: frozenset[str]
    """Robots that are not named, as many have nothing to do."""
    image: Grid | None
    """The cells of a map that is an image."""
    marks: dict[str, Point]
    """Where each task bears its mark."""

    def places(self, points: Sequence[Point]) -> Places:
        return places(points, self.dimensions)


def _scene(mission: Mission, verdict: Verdict, spatial: bool, image: Grid | None) -> _Scene:
    dimensions = 3 if spatial else 2
    drawn = robot_lines(mission, verdict, dimensions)
    idle = [lines.robot.id for lines in drawn if not lines.tasks]
    return _Scene(
        mission=mission,
        lines=drawn,
        left_out=left_out(mission, verdict),
        dimensions=dimensions,
        detail=detail_for(len(mission.tasks)),
        names=Names(mission),
        idle=frozenset(idle if len(idle) > MOST_IDLE else ()),
        image=image,
        marks=marks_of(mission, drawn),
    )


def _all_points(scene: _Scene) -> list[Point]:
    """List every place that the picture must hold."""
    mission = scene.mission
    points = [robot.position for robot in mission.robots]
    points += [robot.end_position for robot in mission.robots if robot.end_position is not None]
    points += [station.position for station in mission.stations]
    for task in mission.tasks:
        points += [scene.marks[task.id], task.entry or task.position, task.exit or task.position]
    for lines in scene.lines:
        points += [tuple(point) for point in lines.all_work[~np.isnan(lines.all_work).any(axis=1)].tolist()]
    points += area_corners(mission)
    if mission.map is not None:
        points += map_corners(mission.map, scene.image)
    return points


def _limits(scene: _Scene, dimensions: int) -> tuple[Places, Places]:
    """Find lower and upper corner of the picture, metres."""
    return limits(places(_all_points(scene), dimensions), 0.06, on_ground=scene.mission.map is not None)


def _own_axes(scene: _Scene) -> Axes:
    rows = named_rows(len(scene.mission.robots)) + 6
    legend_height = 0.19 * rows + 0.6
    if scene.dimensions == 3:
        return new_axes(8.8, max(6.8, legend_height), spatial=True)
    low, high = _limits(scene, 2)
    return map_axes(low, high, _LONG_SIDE_IN, legend_height)


def _draw_ground(ax: Any, scene: _Scene) -> list[tuple[Any, str]]:
    mission, spatial = scene.mission, scene.dimensions == 3
    if spatial and scene.detail.ids:
        tops = scene.places(list(scene.marks.values()))
        draw_stems(ax, tops, float(ax.get_zlim()[0]))
    place_of = {name: scene.places([at])[0] for name, at in scene.marks.items()}
    gap = scene.detail.mark / 2 + 1
    arrows = [*draw_prerequisites(ax, mission, place_of, gap), *draw_transports(ax, mission, place_of, gap)]
    areas = draw_areas(ax, mission, spatial=spatial)
    walls = draw_map(ax, mission.map, scene.image, spatial=spatial) if mission.map is not None else []
    return [*arrows, *areas, *walls]


def _draw_left_out(ax: Any, scene: _Scene) -> None:
    if scene.left_out:
        where = scene.places([task.position for task in scene.left_out])
        size = max(0.65 * scene.detail.mark, 3.0)
        mark = {"marker": "x", "markersize": size, "markeredgewidth": 1.6, "color": LEFT_OUT}
        ax.plot(*where.T, gid="left-out", linestyle="none", zorder=2.9, **mark)


def _starts(scene: _Scene) -> list[tuple[Point, list[int]]]:
    """Find where robots start, and the indices of those that do."""
    groups: dict[Point, list[int]] = {}
    for index, robot in enumerate(scene.mission.robots):
        groups.setdefault(robot.position, []).append(index)
    return list(groups.items())


def _start_size(scene: _Scene) -> float:
    return 9.0 if len(scene.mission.robots) <= MOST_STARTS else 5.0


def _draw_starts(ax: Any, scene: _Scene) -> None:
    """Draw a triangle in the robot's colour; a dark one where several robots start."""
    for position, group in _starts(scene):
        color = robot_style(group[0]).color if len(group) == 1 else TEXT
        mark = {"marker": "^", "markersize": _start_size(scene), "color": color, "markeredgecolor": "white"}
        mark |= {"gid": f"start-{scene.mission.robots[group[0]].id}", "markeredgewidth": 0.8}
        ax.plot(*scene.places([position]).T, linestyle="none", zorder=2.95, **mark)


def _robot_entries(scene: _Scene, unit: str) -> list[tuple[Any, str]]:
    """Make the legend's line for each robot: stroke and mark, id, usage, capacity."""
    from matplotlib.lines import Line2D

    entries: list[tuple[Any, str]] = []
    named = [lines for lines in scene.lines if lines.robot.id not in scene.idle]
    shown = named_rows(len(named))
    for lines in named[:shown]:
        style = robot_style(lines.index)
        mark = Line2D([], [], color=style.color, marker=style.marker, markersize=5.5, linestyle="none")
        line = Line2D([], [], **stroke_of(style, 1.6))
        entries.append(((line, mark), f"{shortened(scene.names.robot(lines.robot.id))}  {_usage_text(lines, unit)}"))
    if shown < len(named):
        entries.append((Line2D([], [], linestyle="none"), f"... and {len(named) - shown} more"))
    if scene.idle:
        entries.append((Line2D([], [], linestyle="none"), f"{len(scene.idle)} robots without tasks"))
    return entries


def _usage_text(lines: RobotLines, unit: str) -> str:
    usage, capacity = lines.figures.usage, lines.figures.capacity
    if capacity is None:
        return f"{usage:.2f} {unit}"
    limit = f"{capacity:.2f}".rstrip("0").rstrip(".")
    return f"{usage:.2f} / {limit} {unit}"


def _mark_entries(scene: _Scene) -> list[tuple[Any, str]]:
    """Make the legend's lines for the marks that are in the picture."""
    from matplotlib.lines import Line2D

    def entry(label: str, **look: Any) -> tuple[Any, str]:
        return Line2D([], [], **{"color": QUIET_TEXT, "linestyle": "none", **look}), label

    entries = []
    if scene.left_out:
        label = f"left out ({len(scene.left_out)})"
        entries.append(entry(label, marker="x", color=LEFT_OUT, markersize=6, markeredgewidth=1.6))
    entries.append(entry("start", marker="^", markersize=7))
    ends = [lines for lines in scene.lines if len(lines.end)]
    if ends:
        label = "way to end" if any(lines.robot.end_position is not None for lines in ends) else "way back"
        entries.append(entry(label, linestyle=DASHED, linewidth=1.3))
    if any(len(lines.work) for lines in scene.lines):
        entries.append(entry("work", linestyle=(0, (1, 1)), linewidth=1.3))
    if any(len(lines.lanes) for lines in scene.lines):
        entries.append(entry("lanes", linestyle="-", linewidth=0.9))
    return entries


def _name_places(ax: Any, scene: _Scene) -> None:
    """Write ids beside starts and tasks, where they cover least; none where there are too many to be read."""
    names: list[tuple[Point, str, dict[str, Any]]] = []
    if len(scene.mission.robots) <= MOST_STARTS:
        look = {"fontsize": 7.5, "color": TEXT, "fontweight": "bold", "zorder": 4}
        for position, group in _starts(scene):
            if all(scene.mission.robots[index].id in scene.idle for index in group):
                continue
            gid = f"start-name-{scene.mission.robots[group[0]].id}"
            names.append((position, _group_name(scene, group), {**look, "gid": gid}))
    names += station_names(scene.mission, scene.names)
    if scene.detail.ids:
        look = {"fontsize": 6.5, "color": QUIET_TEXT, "zorder": 4}
        names += [
            (scene.marks[task.id], scene.names.task(task.id), {**look, "gid": f"name-{task.id}"})
            for task in scene.mission.tasks
        ]
    if not names:
        return
    settle(ax)
    anchors = scene.places([point for point, _, _ in names])
    sizes = np.array([text_size(shortened(text), look["fontsize"]) for _, text, look in names])
    offsets = place_labels(
        to_points(ax, anchors), sizes, scene.detail.mark / 2 + 1.5, _obstacles(ax, scene), _bounds(ax)
    )
    for place, (_, text, look), offset in zip(anchors, names, offsets, strict=True):
        write(ax, place, shortened(text), offset, halo=True, **look)


def _group_name(scene: _Scene, group: list[int]) -> str:
    ids = [scene.names.robot(scene.mission.robots[index].id) for index in group]
    return ", ".join(ids) if len(ids) <= 3 else f"{len(ids)} robots"


def _obstacles(ax: Any, scene: _Scene) -> Places:
    """Collect what names should not cover: routes, marks of tasks, starts, the outlines of walls and zones."""
    radius = scene.detail.mark / 2
    tasks = to_points(ax, scene.places(list(scene.marks.values())))
    others = [*(robot.position for robot in scene.mission.robots), *(one.position for one in scene.mission.stations)]
    starts = to_points(ax, scene.places(others))
    lines = [line for lines in scene.lines for line in (lines.travel, lines.all_work, lines.end) if len(line)]
    lines += [
        scene.places([scene.marks[before], scene.marks[after]])
        for before, after in (*drawn_prerequisites(scene.mission.tasks), *drawn_transports(scene.mission.tasks))
    ]
    if scene.mission.map is not None:
        lines += [scene.places(outline) for outline in map_outlines(scene.mission.map)]
    walls = scene.places(() if scene.image is None else wall_places(scene.image))
    routes = [line_obstacles(to_points(ax, line)) for line in lines]
    return np.vstack(
        [mark_obstacles(tasks, radius), mark_obstacles(starts, radius), *routes, dot_obstacles(to_points(ax, walls))]
    )


def _bounds(ax: Any) -> Places:
    corners = ax.get_window_extent().get_points()
    bounds: Places = corners * 72 / ax.figure.dpi
    return bounds
