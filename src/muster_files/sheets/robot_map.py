"""A small map of one robot's route, for a sheet that has its stops beside it: marks bear their numbers, not names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.model import Mission, Point
from muster.motion.grid import Grid
from muster.report.figures.canvas import frame_of_map, limits, settle, to_points, write
from muster.report.figures.labels import line_obstacles, mark_obstacles, place_labels, text_size
from muster.report.figures.styles import TEXT, robot_style
from muster.report.maps.area_marks import draw_areas
from muster.report.maps.floor import draw_map
from muster.report.maps.route_strokes import Detail, detail_for, draw_lines
from muster.report.maps.station_marks import draw_stations
from muster.report.route_lines import Places, RobotLines, marks_of, places

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FONT = 6.5
_MOST_BESIDE = 6  # numbers beside one mark


def draw_robot_map(ax: Axes, mission: Mission, lines: RobotLines, image: Grid | None = None) -> None:
    """Draw one robot's route on the ground, seen from above.

    Stops bear their numbers in the route, tasks and stations counted together; where a robot stops several times these
    stand beside the mark.

    Parameters
    ----------
    ax
        axes in the plane.
    lines
        the robot's route, in two dimensions.
    image
        the cells of a map that is an image.
    """
    stops = _stops(mission, lines)
    detail = detail_for(len(lines.figures.stops))
    frame_of_map(ax, *limits(_points(lines, stops), 0.1, on_ground=False))
    if mission.map is not None:
        draw_map(ax, mission.map, image, spatial=False)
    draw_areas(ax, mission, spatial=False)
    draw_stations(ax, places([station.position for station in mission.stations], 2))
    draw_lines(ax, lines, detail)
    style = robot_style(lines.index)
    start: dict[str, Any] = {
        "marker": "^",
        "markersize": 9.0,
        "color": style.color,
        "markeredgecolor": "white",
        "zorder": 2.95,
    }
    ax.plot(*lines.robot.position[:2], gid=f"start-{lines.robot.id}", linestyle="none", **start)
    _draw_stops(ax, lines, stops, detail)


def _stops(mission: Mission, lines: RobotLines) -> dict[Point, list[int]]:
    """For each place, in two dimensions, the numbers of the stops there."""
    at = marks_of(mission, [lines]) | {one.id: one.position for one in mission.stations}
    found: dict[Point, list[int]] = {}
    for order, stop in enumerate(lines.figures.stops, 1):
        found.setdefault(tuple(at[stop.name][:2]), []).append(order)
    return found


def _points(lines: RobotLines, stops: dict[Point, list[int]]) -> Places:
    """All that the map has to hold."""
    drawn = [line for line in (lines.travel, lines.all_work, lines.end) if len(line)]
    points = np.vstack([places([lines.robot.position, *stops], 2), *drawn])
    kept: Places = points[~np.isnan(points).any(axis=1)]
    return kept


def _draw_stops(ax: Any, lines: RobotLines, stops: dict[Point, list[int]], detail: Detail) -> None:
    """Draw a mark at each place, with its number inside; several numbers, and none that would be too small, beside."""
    style = robot_style(lines.index)
    if not stops:
        return
    where = places(stops, 2)
    mark = {"marker": style.marker, "markersize": detail.mark, "color": style.color, "markeredgecolor": "white"}
    ax.plot(*where.T, gid=f"stops-{lines.robot.id}", linestyle="none", markeredgewidth=0.8, zorder=3, **mark)
    if not detail.numbers:
        return
    for place, orders in stops.items():
        if len(orders) == 1:
            look: dict[str, Any] = {
                "color": style.ink,
                "fontweight": "bold",
                "zorder": 3.5,
                "fontsize": _font(orders[0], detail.mark),
            }
            write(ax, place, str(orders[0]), gid=f"order-{orders[0]}", **look)
    _write_beside(ax, lines, {place: orders for place, orders in stops.items() if len(orders) > 1}, where, detail)


def _font(order: int, mark: float) -> float:
    return mark * (0.6 if order < 10 else 0.53 if order < 100 else 0.43)


def _write_beside(ax: Any, lines: RobotLines, several: dict[Point, list[int]], where: Places, detail: Detail) -> None:
    """Write the numbers of places with several stops where they cover least."""
    if not several:
        return
    settle(ax)
    texts = [_told(orders) for orders in several.values()]
    anchors = places(several, 2)
    drawn = [line_obstacles(to_points(ax, line)) for line in (lines.travel, lines.all_work, lines.end) if len(line)]
    obstacles = np.vstack([mark_obstacles(to_points(ax, where), detail.mark / 2), *drawn])
    sizes = np.array([text_size(text, _FONT) for text in texts])
    bounds = ax.get_window_extent().get_points() * 72 / ax.figure.dpi
    offsets = place_labels(to_points(ax, anchors), sizes, detail.mark / 2 + 1.5, obstacles, bounds)
    for place, text, offset in zip(anchors, texts, offsets, strict=True):
        look: dict[str, Any] = {"fontsize": _FONT, "color": TEXT, "fontweight": "bold", "zorder": 4}
        write(ax, place, text, offset, halo=True, gid=f"orders-{text}", **look)


def _told(orders: list[int]) -> str:
    return ", ".join(map(str, orders[:_MOST_BESIDE])) + (", ..." if len(orders) > _MOST_BESIDE else "")
